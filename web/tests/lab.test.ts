// State and connection of the page, with a mock WebSocket and server.
import { afterEach, beforeEach, describe, expect, test, vi } from 'vitest';
import { Lab } from '../src/lab.svelte';
import { sampleSchema } from './sample_schema';

class FakeSocket {
  static readonly OPEN = 1;
  static all: FakeSocket[] = [];
  readyState = 0;
  sent: any[] = [];
  onopen = () => {};
  onclose = () => {};
  onmessage = (_: { data: unknown }) => {};
  constructor(readonly url: string, readonly protocol: string) {
    FakeSocket.all.push(this);
  }
  send(text: string) {
    this.sent.push(JSON.parse(text));
  }
  close() {
    this.readyState = 3;
    this.onclose();
  }
  open() {
    this.readyState = FakeSocket.OPEN;
    this.onopen();
  }
  say(message: unknown) {
    this.onmessage({ data: JSON.stringify(message) });
  }
  show(frame: ArrayBuffer) {
    this.onmessage({ data: frame });
  }
}

const newest = () => FakeSocket.all.at(-1)!;
let answers: Record<string, Response>;
beforeEach(() => {
  vi.useFakeTimers();
  FakeSocket.all = [];
  answers = { '/api/schema': Response.json(sampleSchema), '/api/about': Response.json({}) };
  vi.stubGlobal('WebSocket', FakeSocket);
  vi.stubGlobal('location', { host: 'localhost:1' });
  vi.stubGlobal('addEventListener', () => {});
  vi.stubGlobal('window', globalThis);
  vi.stubGlobal('fetch', async (path: string) => answers[path].clone());
});
afterEach(() => vi.useRealTimers());

const run = (number: number, columns: string[]) => ({
  say: 'run', run: number, seed: 1, frame: { width: 64, height: 48, um_per_px: 1, rate: 50 }, outline: {}, box: [0, 0, 64, 48], setpoints: [],
  populations: [{ begin: 0, end: 3, polarity: 'south' }], coils: [], columns, scenario: {}, events: 0,
});
/** A frame without cells, with one row. */
function frame(of: number, number: number, row: number[]): ArrayBuffer {
  const v = new DataView(new ArrayBuffer(48 + 8 * row.length));
  v.setUint32(0, 0x46414241, false);
  v.setUint16(4, 1, true);
  v.setUint32(8, of, true);
  v.setUint32(16, 1, true);
  v.setBigUint64(32, BigInt(number), true);
  row.forEach((x, i) => v.setFloat64(48 + 8 * i, x, true));
  return v.buffer;
}
function connected(): Lab {
  const lab = new Lab();
  newest().open();
  return lab;
}

describe('frames', () => {
  test('of the present run are stored and their rows appended', () => {
    const lab = connected();
    newest().show(frame(1, 0, [0, 5])); // no run is known yet
    newest().say(run(1, ['frame', 'x']));
    newest().show(frame(1, 4, [4, 7]));
    newest().show(frame(1, 5, [5, 8]));
    expect([lab.frame!.frame, lab.series.length, lab.series.newest('x')]).toEqual([5, 2, 8]);
  });
  test('of the previous run, with another number of columns, are ignored', () => {
    const lab = connected();
    newest().say(run(1, ['frame']));
    newest().say(run(2, ['frame', 'x', 'y']));
    expect(() => newest().show(frame(1, 9, [9]))).not.toThrow();
    expect([lab.frame, lab.series.length]).toEqual([null, 0]);
    newest().show(frame(2, 0, [0, 1, 2]));
    expect(lab.series.newest('y')).toBe(2);
  });
});

describe('numbers and plots', () => {
  test('are drawn at most ten times a second, and once after the last frame', () => {
    const lab = connected();
    newest().say(run(1, ['frame']));
    for (let k = 0; k < 60; ++k) {
      newest().show(frame(1, k, [k]));
      vi.advanceTimersByTime(1000 / 60);
    }
    expect(lab.ticks).toBeGreaterThan(5);
    expect(lab.ticks).toBeLessThanOrEqual(11);
    const before = lab.ticks;
    newest().show(frame(1, 60, [60]));
    vi.advanceTimersByTime(200);
    expect(lab.ticks).toBeGreaterThan(before);
  });
});

describe('the history of a run', () => {
  test('comes before its newest rows, and each frame is taken once', () => {
    const lab = connected();
    newest().say(run(3, ['frame', 'x']));
    newest().say({ say: 'history', run: 3, rows: [[0, 5], [2, null], [4, 7]] });
    newest().show(frame(3, 4, [4, 7]));
    newest().show(frame(3, 5, [5, 8]));
    expect([...lab.series.of('frame')]).toEqual([0, 2, 4, 5]);
    expect([...lab.series.of('x')]).toEqual([5, NaN, 7, 8]);
  });
  test('of another run is ignored', () => {
    const lab = connected();
    newest().say(run(3, ['frame', 'x']));
    newest().say({ say: 'history', run: 2, rows: [[0, 5]] });
    expect(lab.series.length).toBe(0);
  });
});

describe('undo', () => {
  /** Sends an event whose answer and consequence come from the server. */
  async function exchange(lab: Lab, event: Record<string, any>) {
    const asked = lab.exchange(event), { id } = newest().sent.at(-1);
    newest().say({ say: 'parts', scenario: { ...lab.scenario, ...event }, setpoints: [], events: 1 });
    newest().say({ id, ok: true });
    await asked;
  }
  const started = (controller: any) => {
    const lab = connected();
    newest().say({ ...run(1, ['frame']), scenario: { controller, reference: { type: 'spot' }, swarm: [{ model: { type: 'a' } }, { model: { type: 'b' } }] } });
    return lab;
  };
  test('sends the parts before the newest change, then before the previous one', async () => {
    const lab = started({ type: 'alpha' });
    expect(lab.changes.possible).toBe(false);
    await exchange(lab, { controller: { type: 'beta' } });
    await exchange(lab, { reference: { type: 'path' } });
    for (const wanted of [{ reference: { type: 'spot' } }, { controller: { type: 'alpha' } }]) {
      const undone = lab.undo(), { id, ...sent } = newest().sent.at(-1);
      expect(sent).toEqual({ do: 'exchange', event: wanted });
      newest().say({ id, ok: true });
      await undone;
    }
    expect(lab.changes.possible).toBe(false);
  });
  test('of the model of a swarm', async () => {
    const lab = started({ type: 'alpha' });
    await exchange(lab, { swarm: 1, model: { type: 'c' } });
    expect(lab.changes.back).toEqual({ swarm: 1, model: { type: 'b' } });
  });
  test('of a drag, which sends many fields, is one step', async () => {
    const lab = started({ type: 'alpha' });
    for (const field of [1, 2, 3]) {
      await exchange(lab, { controller: { type: 'hand', field } });
      vi.advanceTimersByTime(100);
    }
    expect(lab.changes.back).toEqual({ controller: { type: 'alpha' } });
    vi.advanceTimersByTime(2000);
    await exchange(lab, { controller: { type: 'hand', field: 4 } });
    expect(lab.changes.back).toEqual({ controller: { type: 'hand', field: 3 } });
  });
  test('is not possible after a refusal, in a new run, and after another page took control', async () => {
    const lab = started({ type: 'alpha' });
    const asked = lab.exchange({ controller: { type: 'x' } });
    newest().say({ id: newest().sent.at(-1).id, ok: false, where: 'controller', what: 'unknown' });
    await asked;
    expect(lab.changes.possible).toBe(false);
    await exchange(lab, { controller: { type: 'beta' } });
    newest().say({ say: 'pages', pages: 2, steering: 77 });
    expect(lab.changes.possible).toBe(false);
    await exchange(lab, { controller: { type: 'beta' } });
    newest().say(run(2, ['frame']));
    expect(lab.changes.possible).toBe(false);
  });
});

describe('news', () => {
  test('which page steers', () => {
    const lab = connected();
    newest().say({ say: 'hello', page: 4 });
    newest().say({ say: 'pages', pages: 2, steering: 3 });
    expect(lab.steers).toBe(false);
    newest().say({ say: 'pages', pages: 2, steering: 4 });
    expect(lab.steers).toBe(true);
  });
  test('without a connection no page steers', () => {
    const lab = connected();
    newest().say({ say: 'hello', page: 4 });
    newest().say({ say: 'pages', pages: 1, steering: 4 });
    expect(lab.steers).toBe(true);
    newest().close();
    expect([lab.connected, lab.steers]).toEqual([false, false]);
    vi.advanceTimersByTime(1000);
    newest().open();
    expect([lab.connected, lab.steers]).toEqual([true, false]); // until the program has sent the new number of the page
    newest().say({ say: 'hello', page: 5 });
    newest().say({ say: 'pages', pages: 1, steering: 5 });
    expect(lab.steers).toBe(true);
  });
  test('the polarity of most cells', () => {
    const lab = connected();
    newest().say(run(1, []));
    expect(lab.polarity).toBe(-1);
    newest().say({ ...run(2, []), populations: [{ begin: 0, end: 3, polarity: 'south' }, { begin: 3, end: 9, polarity: 'north' }] });
    expect(lab.polarity).toBe(1);
  });
});

describe('the schema', () => {
  test('is fetched when the page is connected', async () => {
    const lab = connected();
    await vi.advanceTimersByTimeAsync(0);
    expect(lab.schema).toEqual(sampleSchema);
    expect(lab.trouble).toBeNull();
  });
  test('an error is shown, and the next connection fetches again', async () => {
    answers['/api/schema'] = new Response('no', { status: 500 });
    const lab = connected();
    await vi.advanceTimersByTimeAsync(0);
    expect([lab.schema, lab.trouble]).toEqual([null, { where: '/api/schema', what: 'no' }]);
    answers['/api/schema'] = Response.json(sampleSchema);
    newest().close();
    await vi.advanceTimersByTimeAsync(250);
    newest().open();
    await vi.advanceTimersByTimeAsync(0);
    expect(lab.schema).toEqual(sampleSchema);
  });
});

describe('requests', () => {
  test('are answered by their id, in any order', async () => {
    const lab = connected();
    const first = lab.link.ask('step', { frames: 1 }), second = lab.link.ask('pause');
    expect(newest().sent).toEqual([{ id: 1, do: 'step', frames: 1 }, { id: 2, do: 'pause' }]);
    newest().say({ id: 2, ok: true });
    newest().say({ id: 1, ok: false, where: 'step', what: 'x' });
    expect([(await first).ok, (await second).ok]).toEqual([false, true]);
  });
  test('a refusal is shown until a request succeeds', async () => {
    const lab = connected();
    const asked = lab.exchange({ controller: 'x' });
    newest().say({ id: 1, ok: false, where: 'controller', what: 'unknown' });
    await asked;
    expect(lab.trouble).toEqual({ where: 'controller', what: 'unknown' });
    const next = lab.ask('pause');
    newest().say({ id: 2, ok: true });
    await next;
    expect(lab.trouble).toBeNull();
  });
  test('without an answer time out after 15 s', async () => {
    const lab = connected(), asked = lab.link.ask('pause');
    newest().say({ say: 'pages', pages: 1, steering: 1 });
    for (let s = 0; s < 15; ++s) {
      newest().say({ say: 'pages', pages: 1, steering: 1 }); // the connection is alive
      await vi.advanceTimersByTimeAsync(1000);
    }
    expect(await asked).toMatchObject({ ok: false, what: 'timeout: no answer within 15 s' });
  });
  test('fail when the connection is lost, and while it is lost', async () => {
    const lab = connected(), asked = lab.link.ask('pause');
    newest().close();
    expect(await asked).toMatchObject({ ok: false, what: 'connection' });
    expect(await lab.link.ask('pause')).toMatchObject({ ok: false, what: 'connection' });
  });
});

describe('the connection', () => {
  test('uses the sub-protocol faba.1', () => {
    connected();
    expect([newest().url, newest().protocol]).toEqual(['ws://localhost:1/ws', 'faba.1']);
  });
  test('is retried after 250 ms, then with doubled delay up to 4 s', async () => {
    connected();
    for (const wait of [250, 500, 1000, 2000, 4000, 4000]) {
      const before = FakeSocket.all.length;
      newest().close();
      await vi.advanceTimersByTimeAsync(wait - 1);
      expect(FakeSocket.all.length, `${wait} ms`).toBe(before);
      await vi.advanceTimersByTimeAsync(1);
      expect(FakeSocket.all.length, `${wait} ms`).toBe(before + 1);
    }
  });
  test('is lost if the server sends nothing for 8 s, not even the answer to a ping', async () => {
    const lab = connected();
    await vi.advanceTimersByTimeAsync(5000);
    expect(newest().sent[0]).toMatchObject({ do: 'ping' });
    expect(lab.connected).toBe(true);
    await vi.advanceTimersByTimeAsync(4500);
    expect(lab.connected).toBe(false);
    expect(FakeSocket.all.length).toBe(2);
  });
  test('a refused token is distinguished from a stopped program', async () => {
    const lab = connected();
    newest().close();
    await vi.advanceTimersByTimeAsync(0);
    expect(lab.refused).toBe(false);
    answers['/api/about'] = new Response('', { status: 401 });
    await vi.advanceTimersByTimeAsync(250);
    newest().close();
    await vi.advanceTimersByTimeAsync(0);
    expect(lab.refused).toBe(true);
  });
});
