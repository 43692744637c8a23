export const en = {
  'jobs': 'Jobs',
  'jobs.none': 'No jobs.',
  'jobs.cancel': 'Cancel',
  'job.waiting': 'queued',
  'job.running': 'running',
  'job.done': 'done',
  'job.failed': 'failed',
  'job.cancelled': 'cancelled',
  'job.left': '{t} left',
  'job.open': 'Open',
  'job.close': 'Close',
} as const;

export const pt: Record<keyof typeof en, string> = {
  'jobs': 'Tarefas',
  'jobs.none': 'Nenhuma tarefa.',
  'jobs.cancel': 'Cancelar',
  'job.waiting': 'na fila',
  'job.running': 'em execução',
  'job.done': 'concluída',
  'job.failed': 'falhou',
  'job.cancelled': 'cancelada',
  'job.left': 'faltam {t}',
  'job.open': 'Abrir',
  'job.close': 'Fechar',
};
