import { describe, expect, test } from 'vitest';
import { command, differences, event, inline, placeInScenario, quoted } from '../src/scenario';

const base = () => ({
  title: 'A swarm',
  seed: 3,
  arena: { type: 'round', radius_px: 100 },
  swarm: [
    { count: 10, model: { type: 'rod', speed: '0.0002 m/s' } },
    { count: 20, model: { type: 'rod', speed: '0.0001 m/s' } },
  ],
  controller: { type: 'feedback', gain: 1 },
  reference: { type: 'place', setpoint_px: [1, 2] },
});
type Scenario = Record<string, any>;
const changed = (change: (s: Scenario) => void): Scenario => {
  const s: Scenario = base();
  change(s);
  return s;
};

describe('differences', () => {
  test('equal scenarios have none', () => {
    expect(differences(base(), base())).toEqual([]);
  });
  test('leaves are named by their path', () => {
    const to = changed((s) => {
      s.title = 'Another';
      s.arena.radius_px = 90;
      s.swarm[1].model.speed = '0.0003 m/s';
    });
    expect(differences(base(), to)).toEqual([['title', 'Another'], ['arena.radius_px', 90], ['swarm[1].model.speed', '0.0003 m/s']]);
  });
  test('a different part is given completely, because the keys of the first one do not apply to it', () => {
    const controller = { type: 'hand', field: ['0 T', '0 T'] };
    expect(differences(base(), changed((s) => (s.controller = controller)))).toEqual([['controller', controller]]);
  });
  test('a list of numbers is one value, also with another length', () => {
    expect(differences(base(), changed((s) => (s.reference.setpoint_px = [1, 3])))).toEqual([['reference.setpoint_px', [1, 3]]]);
    expect(differences({ a: [1] }, { a: [1, 2] })).toEqual([['a', [1, 2]]]);
  });
  test('a new section', () => {
    expect(differences(base(), changed((s) => (s.flow = { type: 'x' })))).toEqual([['flow', { type: 'x' }]]);
  });
  test('a removed key, or a list of tables with another length, cannot be set', () => {
    expect(differences(base(), changed((s) => delete s.title))).toBeNull();
    expect(differences(base(), changed((s) => delete s.controller.gain))).toBeNull();
    expect(differences(base(), changed((s) => s.swarm.pop()))).toBeNull();
    expect(differences(base(), changed((s) => delete s.swarm[1].count))).toBeNull();
  });
});

describe('TOML on one line', () => {
  test.each([
    [1.5, '1.5'],
    [true, 'true'],
    ['a "b" \\ c\n', '"a \\"b\\" \\\\ c\\n"'],
    [[[1, 2], [3, 4]], '[[1, 2], [3, 4]]'],
    [{ type: 'x', field: ['1 T', '0 T'] }, '{ type = "x", field = ["1 T", "0 T"] }'],
    [[{ at: 1 }, { at: 2 }], '[{ at = 1 }, { at = 2 }]'],
  ])('%j', (value, text) => {
    expect(inline(value)).toBe(text);
  });
});

describe('the command', () => {
  const set = (value: unknown) => command('a.toml', { title: null }, { title: value }, 1)!.replace('faba run a.toml --seed 1 --set ', '');

  test('gives file and seed; the seed of the scenario is not set', () => {
    expect(command('scenes/a.toml', base(), changed((s) => (s.seed = 9)), 4)).toBe('faba run scenes/a.toml --seed 4');
  });
  test('quotes special characters of the shell', () => {
    expect(command("my scene's.toml", {}, {}, 1)).toBe("faba run 'my scene'\\''s.toml' --seed 1");
    expect(command('a$(b).toml', {}, {}, 1)).toBe("faba run 'a$(b).toml' --seed 1");
    expect(command('a.toml', base(), changed((s) => (s.swarm[0].count = 5)), 1)).toBe("faba run a.toml --seed 1 --set 'swarm[0].count=5'");
  });
  test('numbers, lists and quantities', () => {
    expect(set(5)).toBe('title=5');
    expect(set([1, 2])).toBe("'title=[1, 2]'");
    expect(set('0.0003 m/s')).toBe("'title=0.0003 m/s'");
    expect(set('-5e-6 T')).toBe("'title=-5e-6 T'");
  });
  test('a string is set without quotes if it cannot be another TOML value', () => {
    expect(set('abc')).toBe('title=abc');
    expect(set('Truely a swarm')).toBe("'title=Truely a swarm'");
  });
  test.each(['5', '5 # cells', 'true', 'false # not', 'inf', '-nan', '1979-05-27', '07:32:00', '[1]', '{ a = 1 }', '"quoted"', "'quoted'", '', ' a', '+1', '.5'])(
    'the string %j keeps its quotes, since --set would take it for another value',
    (text) => {
      expect(set(text)).toBe(`'title=${JSON.stringify(text).replaceAll("'", `'\\''`)}'`);
    },
  );
  test('returns null if a key was removed', () => {
    expect(command('a.toml', base(), changed((s) => delete s.arena), 1)).toBeNull();
  });
});

describe('events of a running scenario', () => {
  test('none for no change, another seed or the events so far', () => {
    expect(event(base(), base())).toEqual([]);
    expect(event(base(), changed((s) => (s.seed = 4)))).toEqual([]);
    expect(event({ ...base(), event: [] }, { ...base(), event: [{ frame: 3 }] })).toEqual([]);
  });
  test('controller, reference and estimator are exchanged together', () => {
    const to = changed((s) => {
      s.controller.gain = 2;
      s.estimator = { type: 'x' };
    });
    expect(event(base(), to)).toEqual([{ controller: to.controller, estimator: to.estimator }]);
  });
  test('each changed model is a separate event, after the parts', () => {
    const to = changed((s) => {
      s.swarm[0].model.speed = '0.0003 m/s';
      s.swarm[1].model.speed = '0.0004 m/s';
      s.controller.gain = 2;
    });
    expect(event(base(), to)).toEqual([{ controller: to.controller }, { swarm: 0, model: to.swarm[0].model }, { swarm: 1, model: to.swarm[1].model }]);
  });
  test('all other changes need a restart', () => {
    expect(event(base(), changed((s) => (s.title = 'x')))).toBeNull();
    expect(event(base(), changed((s) => (s.swarm[0].count = 11)))).toBeNull();
    expect(event(base(), changed((s) => s.swarm.pop()))).toBeNull();
    expect(event(base(), changed((s) => (s.flow = {})))).toBeNull();
  });
  test('a removed section needs a restart', () => {
    for (const key of ['controller', 'reference', 'swarm', 'arena']) {
      expect(event(base(), changed((s) => delete s[key])), key).toBeNull();
    }
  });
});

describe('words of a command', () => {
  test.each([
    ['./rigs/a.toml', './rigs/a.toml'],
    ['--current=0.5, 0.5', "'--current=0.5, 0.5'"],
    ['swarm[0].count=3', "'swarm[0].count=3'"],
    ["it's", "'it'\\''s'"],
    ['', "''"],
  ])('%s', (word, line) => {
    expect(quoted(word)).toBe(line);
  });
});

describe('the place of an error in an event', () => {
  test('is a place in the scenario', () => {
    expect(placeInScenario({ swarm: 1, model: {} }, 'model.speed')).toBe('swarm[1].model.speed');
    expect(placeInScenario({ model: {} }, 'model')).toBe('swarm[0].model');
    expect(placeInScenario({ controller: {} }, 'controller.gain')).toBe('controller.gain');
  });
});
