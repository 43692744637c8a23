export const en = {
  'runs.title': 'Recorded runs',
  'runs.none': 'No recorded runs. Press Record during a run.',
  'runs.report': 'Report',
  'runs.replay': 'Replay',
  'runs.video': 'Video',
  'runs.again': 'Use this scenario',
  'runs.pin': 'Compare',
  'runs.broken': 'incomplete',
} as const;

export const pt: Record<keyof typeof en, string> = {
  'runs.title': 'Gravações',
  'runs.none': 'Nenhuma gravação. Clique em Gravar durante uma execução.',
  'runs.report': 'Relatório',
  'runs.replay': 'Reproduzir',
  'runs.video': 'Vídeo',
  'runs.again': 'Usar este cenário',
  'runs.pin': 'Comparar',
  'runs.broken': 'incompleta',
};
