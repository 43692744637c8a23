// The engine in WebAssembly, built from src/demo of the repository.
declare module 'faba-engine' {
  interface Engine {
    ccall(name: 'faba_open', returns: null, types: [], values: []): void;
    ccall(name: 'faba_receive', returns: null, types: ['string'], values: [string]): void;
    ccall(name: 'faba_advance', returns: 'number', types: ['number'], values: [number]): number;
    ccall(name: 'faba_answer', returns: 'string', types: ['string', 'string'], values: [string, string]): string;
  }
  interface Page {
    wasmBinary: ArrayBuffer;
    onText(text: string): void;
    onFrame(bytes: ArrayBuffer): void;
  }
  export default function makeEngine(page: Page): Promise<Engine>;
}
/** The WebAssembly, compressed with gzip, in base64. */
declare module 'faba-engine.wasm' {
  const text: string;
  export default text;
}
