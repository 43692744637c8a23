// The quality of a measurement, and the reasons for it.

export const kQualities = ['good', 'doubtful', 'poor'] as const;
export type Quality = (typeof kQualities)[number];
/** The quality that a job states; null for a job without one. */
export const qualityOf = (word: string | undefined): Quality | null => kQualities.find((q) => q === word) ?? null;

/** A violated assumption of a measurement; results of earlier versions have no title. */
export interface Warning {
  aspect: string;
  title?: string;
  what: string;
  evidence: string;
  advice: string;
}
export const titleOf = (w: Warning) => w.title || w.aspect.replaceAll('_', ' ');
