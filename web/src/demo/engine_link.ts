// The engine in a worker in place of a server: messages as on the WebSocket, and the requests of the page.

import type { Answer, Link, Listener } from '../connection';
import type { FromPage, ToPage } from './messages';
import EngineWorker from './worker?worker&inline';

const kCheck = '/api/check'; // its answer is the same if the scenario is refused

export class EngineLink implements Link {
  readonly records = false;
  roundTrip = 0;
  private worker = new EngineWorker();
  private next = 1;
  private waiting = new Map<number, (a: Answer) => void>();
  private asked = new Map<number, (answer: string) => void>();

  /** `failed` is called if the engine cannot run or has stopped. */
  constructor(
    private listener: Listener,
    private failed: (what: string) => void,
  ) {
    this.worker.onmessage = ({ data }: MessageEvent<ToPage>) => this.take(data);
    this.worker.onerror = (e) => this.lost(e.message);
  }

  private take(m: ToPage) {
    if ('frame' in m) return this.listener.frame(m.frame);
    if ('ready' in m) return this.listener.state({ connected: true, refused: false });
    if ('failed' in m) return this.lost(m.failed);
    if ('answer' in m) {
      this.asked.get(m.id)?.(m.answer);
      this.asked.delete(m.id);
      return;
    }
    const j = JSON.parse(m.text);
    if (typeof j.id !== 'number') return this.listener.news(j);
    this.waiting.get(j.id)?.(j);
    this.waiting.delete(j.id);
  }
  private lost(what: string) {
    this.worker.terminate();
    this.listener.state({ connected: false, refused: false });
    this.failed(what);
  }
  private send(message: FromPage) {
    this.worker.postMessage(message);
  }
  again() {
    location.reload();
  }

  ask(what: string, values: Record<string, unknown> = {}): Promise<Answer> {
    const id = this.next++, asked = performance.now();
    return new Promise((resolve) => {
      this.waiting.set(id, (a) => {
        this.roundTrip = performance.now() - asked;
        resolve(a);
      });
      this.send({ text: JSON.stringify({ id, do: what, ...values }) });
    });
  }
  /** Answers a request as a server does. */
  fetch(path: string, init?: RequestInit): Promise<Response> {
    const id = this.next++;
    return new Promise((resolve) => {
      this.asked.set(id, (answer) => {
        const refused = path !== kCheck && JSON.parse(answer).ok === false;
        resolve(new Response(answer, { status: refused ? 400 : 200 }));
      });
      this.send({ id, path: decodeURIComponent(path), body: typeof init?.body === 'string' ? init.body : '' });
    });
  }
}
