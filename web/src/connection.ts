// WebSocket to the lab: requests with answers, news, frames; reconnects automatically.

import type { Word } from './i18n';

export type News = { say: string } & Record<string, any>;
export interface Answer {
  ok: boolean;
  where?: string;
  what?: string;
  /** Text of the page in place of `what`. */
  word?: Word;
  [key: string]: any;
}
export interface Listener {
  news(n: News): void;
  frame(b: ArrayBuffer): void;
  /** `refused`: the server does not accept the token of this page. */
  state(s: { connected: boolean; refused: boolean }): void;
}

/** The way from the page to the program. */
export interface Link {
  /** Sends a request and returns its answer; never rejects. */
  ask(what: string, values?: Record<string, unknown>): Promise<Answer>;
  /** Reconnects at once. */
  again(): void;
  /** Round-trip time of the newest answer, ms. */
  readonly roundTrip: number;
  /** The program records runs and executes jobs. */
  readonly records: boolean;
}

const kFirstWait = 250, kLongestWait = 4000; // ms
const kPatience = 15000; // ms, timeout of an answer
const kQuiet = 3000, kSilent = 8000; // ms without a message: send a ping; reconnect

export class Connection implements Link {
  readonly records = true;
  private socket: WebSocket | null = null;
  private next = 1;
  private waiting = new Map<number, (a: Answer) => void>();
  private wait = kFirstWait;
  private timer = 0;
  private refused = false;
  /** Round-trip time of the newest answer, ms. */
  roundTrip = 0;
  private heard = 0;

  constructor(private listener: Listener) {
    this.open();
    addEventListener('online', () => this.again());
    window.setInterval(() => this.listen(), 1000);
  }

  private open() {
    const socket = new WebSocket(`ws://${location.host}/ws`, 'faba.1');
    socket.binaryType = 'arraybuffer';
    this.socket = socket;
    socket.onopen = () => {
      this.wait = kFirstWait;
      this.refused = false;
      this.heard = performance.now();
      this.listener.state({ connected: true, refused: false });
    };
    socket.onmessage = (m) => {
      this.heard = performance.now();
      if (typeof m.data !== 'string') return this.listener.frame(m.data);
      const j = JSON.parse(m.data);
      if (typeof j.id === 'number') {
        this.waiting.get(j.id)?.(j);
        this.waiting.delete(j.id);
      } else {
        this.listener.news(j);
      }
    };
    socket.onclose = () => this.lost(socket);
  }

  private lost(socket: WebSocket) {
    if (this.socket !== socket) return;
    this.socket = null;
    for (const give of this.waiting.values()) give({ ok: false, where: '', what: 'connection' });
    this.waiting.clear();
    void this.reportLost();
    this.timer = window.setTimeout(() => this.open(), this.wait);
    this.wait = Math.min(this.wait * 2, kLongestWait);
  }

  // Heartbeat: a program that hangs does not close the connection.
  private listen() {
    const socket = this.socket;
    if (!socket || socket.readyState !== WebSocket.OPEN) return;
    const silent = performance.now() - this.heard;
    if (silent > kSilent) {
      socket.close();
      this.lost(socket);
    } else if (silent > kQuiet) {
      void this.ask('ping');
    }
  }

  // A refused WebSocket has no status code; a normal request does.
  private async reportLost() {
    this.listener.state({ connected: false, refused: this.refused });
    this.refused = await fetch('/api/about').then((r) => r.status === 401, () => false);
    if (this.socket?.readyState !== WebSocket.OPEN) this.listener.state({ connected: false, refused: this.refused });
  }

  /** Reconnects at once. */
  again() {
    if (this.socket) return;
    clearTimeout(this.timer);
    this.open();
  }

  /** Sends a request and returns the answer of the lab; never rejects. */
  ask(what: string, values: Record<string, unknown> = {}): Promise<Answer> {
    const socket = this.socket;
    if (!socket || socket.readyState !== WebSocket.OPEN)
      return Promise.resolve({ ok: false, where: '', what: 'connection' });
    const id = this.next++, asked = performance.now();
    return new Promise((resolve) => {
      const late = window.setTimeout(() => {
        this.waiting.delete(id);
        resolve({ ok: false, where: '', what: `timeout: no answer within ${kPatience / 1000} s`, word: 'timeout' });
      }, kPatience);
      this.waiting.set(id, (a) => {
        clearTimeout(late);
        this.roundTrip = performance.now() - asked;
        resolve(a);
      });
      socket.send(JSON.stringify({ id, do: what, ...values }));
    });
  }
}

export async function get<T = any>(path: string): Promise<T> {
  return answer(await request(path));
}
export async function post<T = any>(path: string, body: unknown): Promise<T> {
  return answer(
    await request(path, { method: 'POST', headers: { 'Content-Type': 'application/json' }, body: JSON.stringify(body) }),
  );
}
export async function upload<T = any>(path: string, file: Blob): Promise<T> {
  return answer(await request(path, { method: 'POST', headers: { 'Content-Type': 'application/octet-stream' }, body: file }));
}
export async function remove<T = any>(path: string): Promise<T> {
  return answer(await request(path, { method: 'DELETE', headers: { 'Content-Type': 'application/json' } }));
}

/** An error of a request: its place, such as a key of the scenario, and the message of the program or a text of the page. */
export class RequestError extends Error {
  constructor(
    readonly where: string,
    readonly what: string,
    readonly word?: Word,
  ) {
    super(where ? `${where}: ${what}` : what);
  }
}

/** Answers the requests below; the demonstration has no server and replaces it. */
export const server = { fetch: (path: string, init?: RequestInit): Promise<Response> => fetch(path, init) };

/** fetch() rejects only when there is no answer at all; its own message does not tell the user what to do. */
function request(path: string, init?: RequestInit) {
  return server.fetch(path, init).catch(() => {
    throw new RequestError('', 'The server does not answer.', 'no_answer');
  });
}

async function answer(r: Response) {
  const text = await r.text();
  let j: any = null;
  try {
    j = JSON.parse(text);
  } catch {
    // plain text
  }
  if (!r.ok) throw new RequestError(j?.what ? (j.where ?? '') : '', j?.what ?? (text.trim() || r.statusText));
  return j;
}
