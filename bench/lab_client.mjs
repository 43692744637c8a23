// A client of the live lab without a browser: a socket that reads all messages, or stops reading.

import { spawn } from 'node:child_process';
import { createHash, randomBytes } from 'node:crypto';
import { createConnection } from 'node:net';

/** Starts `faba lab` in `folder`; returns the process, its address, port and token. */
export async function serve(program, folder, ...words) {
  const lab = spawn(program, ['lab', '--no-browser', '--json', ...words], { cwd: folder, stdio: ['ignore', 'pipe', 'inherit'] });
  const address = await new Promise((give, fail) => {
    let text = '';
    lab.stdout.on('data', (d) => {
      text += d;
      if (text.includes('\n')) give(JSON.parse(text.split('\n')[0]).address);
    });
    lab.on('exit', (code) => fail(new Error(`faba lab ended with ${code}`)));
  });
  const url = new URL(address);
  return { lab, address, port: Number(url.port), token: url.searchParams.get('token') };
}

export class Client {
  news = {}; // latest message of each kind
  frames = 0;
  bytes = 0;
  #waiting = new Map();
  #next = 1;
  #buffer = Buffer.alloc(0);

  static async open({ port, token }) {
    const c = new Client();
    c.socket = createConnection(port, '127.0.0.1');
    await new Promise((r) => c.socket.on('connect', r));
    const key = randomBytes(16).toString('base64');
    c.socket.write(
      `GET /ws HTTP/1.1\r\nHost: 127.0.0.1:${port}\r\nOrigin: http://127.0.0.1:${port}\r\nCookie: faba-${port}=${token}\r\n` +
        `Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: ${key}\r\nSec-WebSocket-Protocol: faba.1\r\n\r\n`,
    );
    await new Promise((open, fail) => {
      c.socket.on('data', (d) => {
        c.#buffer = Buffer.concat([c.#buffer, d]);
        if (!c.isOpen) {
          const end = c.#buffer.indexOf('\r\n\r\n');
          if (end < 0) return;
          const head = String(c.#buffer.subarray(0, end));
          const accept = createHash('sha1').update(`${key}258EAFA5-E914-47DA-95CA-C5AB0DC85B11`).digest('base64');
          if (!head.startsWith('HTTP/1.1 101') || !head.includes(accept)) return fail(new Error(head));
          c.#buffer = c.#buffer.subarray(end + 4);
          c.isOpen = true;
          open();
        }
        c.#take();
      });
    });
    return c;
  }
  #take() {
    for (;;) {
      const b = this.#buffer;
      if (b.length < 2) return;
      let length = b[1] & 127, at = 2;
      if (length === 126) (length = b.length < 4 ? Infinity : b.readUInt16BE(2)), (at = 4);
      else if (length === 127) (length = b.length < 10 ? Infinity : Number(b.readBigUInt64BE(2))), (at = 10);
      if (b.length < at + length) return;
      const payload = b.subarray(at, at + length), kind = b[0] & 15;
      this.#buffer = b.subarray(at + length);
      if (kind === 2) (++this.frames, (this.bytes = length));
      if (kind === 9) this.#send(10, payload);
      if (kind !== 1) continue;
      const j = JSON.parse(payload);
      if (j.id) {
        this.#waiting.get(j.id)?.(j);
        this.#waiting.delete(j.id);
      } else this.news[j.say] = j;
    }
  }
  #send(kind, payload) {
    const mask = randomBytes(4), n = payload.length, head = n < 126 ? Buffer.from([0x80 | kind, 0x80 | n]) : Buffer.from([0x80 | kind, 0x80 | 126, n >> 8, n & 255]);
    this.socket.write(Buffer.concat([head, mask, payload.map((v, i) => v ^ mask[i & 3])]));
  }
  ask(what, values = {}) {
    const id = this.#next++;
    this.#send(1, Buffer.from(JSON.stringify({ id, do: what, ...values })));
    return new Promise((r) => this.#waiting.set(id, r));
  }
  /** Stops reading; the connection stays open. */
  stall() {
    this.socket.pause();
  }
  close() {
    this.socket.destroy();
  }
}

export const wait = (ms) => new Promise((r) => setTimeout(r, ms));
