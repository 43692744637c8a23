import { afterEach, beforeEach, describe, expect, test, vi } from 'vitest';
import { Arming } from '../src/bench/arming.svelte';
import { Bench } from '../src/bench/bench.svelte';
import { JogSession, kBeat } from '../src/bench/jog.svelte';
import type { BenchState } from '../src/bench/state';
import { RequestError } from '../src/connection';

const open = (more: Partial<BenchState> = {}): BenchState => ({ open: 'bench', opening: 3, armed: false, activity: null, histogram: [1], controls: [{ name: 'gain', value: 1, automatically: null }], ...more });
const answers = (body: unknown, status = 200) => Promise.resolve(new Response(JSON.stringify(body), { status }));

describe('the state', () => {
  test('of news keeps what only the console shows, for the same opening', () => {
    const bench = new Bench({ page: 1, connected: true });
    bench.take(open());
    bench.take({ open: 'bench', opening: 3, armed: true });
    expect(bench.now).toMatchObject({ armed: true, histogram: [1] });
    bench.take(open({ coils: [{ current_a: 0.1, sensed_a: 0.1, max_a: 0.4 }] }));
    bench.take({ open: 'bench', opening: 3, coils: [] });
    expect(bench.now.coils).toEqual([{ current_a: 0, sensed_a: null, max_a: 0.4 }]);
    bench.take({ open: 'bench', opening: 4, armed: false });
    expect(bench.now.histogram).toBeUndefined();
  });
  test('of an answer that was overtaken by news does not replace it', async () => {
    const bench = new Bench({ page: 1, connected: true });
    bench.take(open());
    let give: (r: Response) => void = () => {};
    vi.stubGlobal('fetch', () => new Promise<Response>((go) => (give = go)));
    const asked = bench.refresh();
    bench.take(open({ armed: true }));
    give(new Response(JSON.stringify(open({ armed: false, histogram: [9] }))));
    await asked;
    expect(bench.now).toMatchObject({ armed: true, histogram: [9] });
  });
  test('is unknown from the loss of the connection to the next answer', async () => {
    const link = { page: 1, connected: true };
    const bench = new Bench(link);
    bench.take(open({ armed: true }));
    expect(bench.known).toBe(true);
    link.connected = false;
    bench.lost();
    vi.stubGlobal('fetch', () => answers(open()));
    await bench.refresh();
    expect(bench.known).toBe(false);
    link.connected = true;
    await bench.refresh();
    expect(bench.known).toBe(true);
    expect(bench.now.armed).toBe(false);
  });
  test('reports a request to switch off without an answer', async () => {
    const bench = new Bench({ page: 1, connected: false });
    vi.stubGlobal('fetch', () => Promise.reject(new TypeError('network')));
    await bench.off();
    expect(bench.offFailed).toBe(true);
    vi.stubGlobal('fetch', () => answers(open()));
    await bench.off();
    expect(bench.offFailed).toBe(false);
  });
});

describe('a permit', () => {
  let time = 0;
  const make = (give: () => Promise<any>) => {
    const bench = { ask: vi.fn(give), page: 7, connected: true, now: open() };
    return { bench, arming: new Arming(bench as any, 'run', () => time) };
  };
  test('is requested for this page and used once', async () => {
    const { bench, arming } = make(async () => ({ permit: 'ab', valid_s: 15 }));
    await arming.request();
    expect(bench.ask).toHaveBeenCalledWith('permit', { page: 7, what: 'run' });
    expect(arming.use()).toBe('ab');
    expect(arming.use()).toBeNull();
  });
  test('expires', async () => {
    const { arming } = make(async () => ({ permit: 'ab', valid_s: 15 }));
    await arming.request();
    time += 14_900;
    arming.tick();
    expect(arming.permit).toBe('ab');
    time += 200;
    expect(arming.use()).toBeNull();
    expect(arming.left).toBe(0);
  });
  test.each([
    ['reconnected', { page: 8 }],
    ['is without a connection', { connected: false }],
    ['sees another opening of the bench', { now: open({ opening: 4 }) }],
  ])('is void when the page %s', async (_, change) => {
    const { bench, arming } = make(async () => ({ permit: 'ab', valid_s: 15 }));
    await arming.request();
    Object.assign(bench, change);
    expect(arming.isStale).toBe(true);
    expect(arming.use()).toBeNull();
  });
  test('that is refused gives the reason', async () => {
    const { arming } = make(async () => Promise.reject(new RequestError('page', 'another page controls the lab')));
    await arming.request();
    expect(arming.permit).toBeNull();
    expect(arming.trouble?.what).toBe('another page controls the lab');
  });
});

describe('jogging', () => {
  beforeEach(() => void vi.useFakeTimers());
  afterEach(() => void vi.useRealTimers());
  const guard = { state: 'armed', heat: 0, reason: '', write_ok: true };
  function make(reply: (body: any) => any = (b) => ({ coils: b.currents_a.map((a: number) => ({ current_a: a, sensed_a: null, max_a: 0.4 })), guard })) {
    const sent: [string, any][] = [];
    const session = new JogSession(async (what: string, body: any) => {
      sent.push([what, body]);
      if (what === 'jog') return { session: 's', max_a: [0.4, 0.2], deadline_s: 0.6 };
      return what === 'jog/set' ? reply(body) : {};
    });
    return { session, sent, sets: () => sent.filter(([w]) => w === 'jog/set').map(([, b]) => b) };
  }
  const wait = (ms: number) => vi.advanceTimersByTimeAsync(ms);

  test('sends heartbeats with increasing numbers, and starts with zero', async () => {
    const { session, sets } = make();
    await session.start(1, 'p');
    await wait(4 * kBeat + 10);
    expect(sets().map((b) => b.number)).toEqual([1, 2, 3, 4, 5]);
    expect(sets().every((b) => b.session === 's' && b.currents_a.every((a: number) => a === 0))).toBe(true);
  });
  test('sends a new current at once, within the limits of the coil', async () => {
    const { session, sets } = make();
    await session.start(1, 'p');
    await wait(10);
    session.set(1, 5);
    await wait(1);
    expect(sets().at(-1).currents_a).toEqual([0, 0.2]);
    session.set(0, NaN);
    session.step(0, -0.1);
    await wait(1);
    expect(sets().at(-1).currents_a).toEqual([-0.1, 0.2]);
    session.zero();
    await wait(1);
    expect(sets().at(-1).currents_a).toEqual([0, 0]);
  });
  test('stops sending when the page is hidden or left, and switches the coils off', async () => {
    const { session, sent } = make();
    await session.start(1, 'p');
    session.set(0, 0.1);
    await wait(10);
    session.cut();
    const before = sent.length;
    expect(sent.at(-1)![0]).toBe('off');
    await wait(10 * kBeat);
    session.set(0, 0.1);
    await wait(kBeat);
    expect(sent.length).toBe(before);
    expect(session.isOn).toBe(false);
    expect(session.wanted).toEqual([0, 0]);
  });
  test('ends with the reason when the server refuses', async () => {
    const { session, sets } = make(() => Promise.reject(new RequestError('session', 'is not the session that jogs')));
    await session.start(1, 'p');
    await wait(5 * kBeat);
    expect(session.state).toBe('ended');
    expect(session.trouble?.what).toBe('is not the session that jogs');
    expect(sets().length).toBe(1);
  });
  test('has no current after a fault until it is reset', async () => {
    let state = 'armed';
    const { session, sent, sets } = make((b) => ({ coils: b.currents_a.map((a: number) => ({ current_a: a, sensed_a: null, max_a: 0.4 })), guard: { ...guard, state } }));
    await session.start(1, 'p');
    session.set(0, 0.1);
    await wait(10);
    state = 'tripped';
    await wait(kBeat);
    expect(session.state).toBe('tripped');
    session.set(0, 0.1);
    await wait(2 * kBeat);
    expect(sets().at(-1).currents_a).toEqual([0, 0]);
    state = 'armed';
    await session.reset(1, 'q');
    expect(sent.find(([w]) => w === 'jog/reset')![1]).toEqual({ session: 's', page: 1, permit: 'q' });
    session.set(0, 0.1);
    await wait(1);
    expect(sets().at(-1).currents_a).toEqual([0.1, 0]);
  });
  test('has one request at a time', async () => {
    let give: (v: any) => void = () => {};
    const { session, sets } = make((b) => (b.number === 1 ? new Promise((go) => (give = go)) : { coils: [], guard }));
    await session.start(1, 'p');
    session.set(0, 0.1);
    session.set(0, 0.2);
    await wait(3 * kBeat);
    expect(sets().length).toBe(1);
    give({ coils: [], guard });
    await wait(1);
    expect(sets().map((b) => b.currents_a[0])).toEqual([0, 0.2]);
  });
});
