// The worker that simulates: it passes messages between the page and the engine and calls the engine when frames are due.

import makeEngine from 'faba-engine';
import compressed from 'faba-engine.wasm';
import type { FromPage, ToPage } from './messages';

const kBudget = 0.012; // s; the page waits this long for an answer while frames are late
const kIdle = 1000; // ms

const send = (message: ToPage, moved: Transferable[] = []) => (self as unknown as Worker).postMessage(message, moved);
const fail = (e: unknown) => send({ failed: e instanceof Error ? e.message : String(e) });

async function open() {
  const bytes = Uint8Array.from(atob(compressed), (c) => c.charCodeAt(0));
  const wasmBinary = await new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'))).arrayBuffer();
  return makeEngine({ wasmBinary, onText: (text) => send({ text }), onFrame: (frame) => send({ frame }, [frame]) });
}

open().then((engine) => {
  let timer = 0;
  function advance() {
    clearTimeout(timer);
    try {
      const wait = engine.ccall('faba_advance', 'number', ['number'], [kBudget]) * 1000;
      timer = self.setTimeout(advance, Math.min(wait, kIdle));
    } catch (e) {
      fail(e);
    }
  }
  self.onmessage = ({ data }: MessageEvent<FromPage>) => {
    try {
      if ('text' in data) engine.ccall('faba_receive', null, ['string'], [data.text]);
      else send({ id: data.id, answer: engine.ccall('faba_answer', 'string', ['string', 'string'], [data.path, data.body]) });
    } catch (e) {
      return fail(e);
    }
    advance();
  };
  engine.ccall('faba_open', null, [], []);
  send({ ready: true });
}, fail);
