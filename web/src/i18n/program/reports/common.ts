/** Portuguese texts that all reports share: provenance, quality, figures, counts and intervals. */
export const common: Record<string, string> = {
  Provenance: 'Proveniência', Program: 'Programa', Input: 'Entrada', Options: 'Opções', defaults: 'padrões', '(others: defaults)': '(outras: padrões)', '{}, SHA-256': '{}, SHA-256', Duration: 'Duração', Seed: 'Semente',
  'Quality of the measurement:': 'Qualidade da medição:', good: 'boa', doubtful: 'duvidosa', poor: 'ruim', Notes: 'Observações', Figures: 'Figuras', Results: 'Resultados', Models: 'Modelos',
  'Figure {#}.': 'Figura {}.', '{}: there are no values, and the figure is omitted.': '{}: não há valores, e a figura é omitida.', 'no data': 'sem dados', '{} ×10{}': '{} ×10{}',
  '{#} of {#}': '{} de {}', '{}: {#} experiment': '{}: {} experimento', '{}: {#} experiments': '{}: {} experimentos', '{#} to {#}': '{} a {}', '{#} % to {#} %': '{} % a {} %', '{#} video': '{} vídeo', '{#} videos': '{} vídeos', '{#} experiment': '{} experimento', '{#} experiments': '{} experimentos',
  '{#} frame': '{} quadro', '{#} frames': '{} quadros', '{#} seed': '{} semente', '{#} seeds': '{} sementes', '{#} track': '{} trajetória', '{#} tracks': '{} trajetórias', '{#} position': '{} posição', '{#} positions': '{} posições',
  '{#} time interval': '{} intervalo de tempo', '{#} time intervals': '{} intervalos de tempo', '{#} per frame': '{} por quadro',
  'time (s)': 'tempo (s)', 'time (frames)': 'tempo (quadros)', 'x (px)': 'x (px)', 'y (px)': 'y (px)', video: 'vídeo', videos: 'vídeos', experiment: 'experimento', experiments: 'experimentos', 'field segments': 'segmentos de campo', 'field segment': 'segmento de campo',
  model: 'modelo', direction: 'direção', mean: 'média', 's.d.': 'd.p.', 's.d. {#}': 'd.p. {}', frames: 'quadros', Frames: 'Quadros', 'Frame at {#} s': 'Quadro em {} s',
  'Frames of the video at about equal time intervals.': 'Quadros do vídeo a intervalos de tempo aproximadamente iguais.',
  right: 'direita', left: 'esquerda', up: 'cima', down: 'baixo', 'up and right': 'cima e direita', 'up and left': 'cima e esquerda', 'down and right': 'baixo e direita', 'down and left': 'baixo e esquerda',
};
