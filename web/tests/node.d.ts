// The parts of Node that tests use; the page has no Node.
declare module 'node:child_process' {
  export function execFileSync(file: string, words: string[], options: { encoding: 'utf8'; maxBuffer: number }): string;
}
declare module 'node:fs' {
  export function existsSync(file: string): boolean;
}
