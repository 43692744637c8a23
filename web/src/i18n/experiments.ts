export const en = {
  'experiments.title': 'Experiments',
  'experiments.help': 'An experiment is a folder with the videos of one sample, what is known about them, and the results.',
  'experiments.new': 'New experiment',
  'experiments.example': 'Ageing drops',
  'experiments.create': 'Create',
  'experiments.none': 'No experiments.',
  'experiments.count': 'drops: {drops}, videos: {videos}',
} as const;

export const pt: Record<keyof typeof en, string> = {
  'experiments.title': 'Experimentos',
  'experiments.help': 'Um experimento é uma pasta com os vídeos de uma amostra, o que se sabe sobre eles e os resultados.',
  'experiments.new': 'Novo experimento',
  'experiments.example': 'Gotas que envelhecem',
  'experiments.create': 'Criar',
  'experiments.none': 'Nenhum experimento.',
  'experiments.count': 'gotas: {drops}, vídeos: {videos}',
};
