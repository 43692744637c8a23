// Messages between the page and the worker of the demonstration.

/** A message of protocol.md, or a request as to a server. */
export type FromPage = { text: string } | { id: number; path: string; body: string };
export type ToPage = { ready: true } | { text: string } | { frame: ArrayBuffer } | { id: number; answer: string } | { failed: string };
