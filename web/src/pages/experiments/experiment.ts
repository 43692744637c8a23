// Experiments as the program sends them, and changes to them.

/** An entry of the list. */
export interface ExperimentCard {
  name: string;
  title: string;
  drops: number;
  videos: number;
  error?: string;
}
