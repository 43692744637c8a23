import { describe, expect, it } from 'vitest';
import { reproduction } from '../src/demo/reproduction';

const scene = { file: 'scenes/steer.toml', scenario: { seed: 1, duration: '12 s', swarm: [{ count: 400 }] } };
const hash = { frame: 720, t: 12, hash: '0123456789abcdef', end: true, changed: false };

describe('the command that reproduces a state hash', () => {
  it('has the scene and the seed of the run', () => {
    expect(reproduction(scene, scene.scenario, 7, hash)).toBe('faba run scenes/steer.toml --seed 7 --json');
  });
  it('has the duration of a run that was paused before its end', () => {
    const paused = { ...hash, end: false, frame: 91, t: 91 / 60 };
    expect(reproduction(scene, scene.scenario, 1, paused)).toBe("faba run scenes/steer.toml --seed 1 --duration '1.51666667 s' --json");
  });
  it('has the values that differ from the scene', () => {
    const more = { ...scene.scenario, swarm: [{ count: 1000 }] };
    expect(reproduction(scene, more, 1, hash)).toBe("faba run scenes/steer.toml --seed 1 --set 'swarm[0].count=1000' --json");
  });
  it('ignores the events of the file, which the scenario of a run does not have', () => {
    const events = { ...scene, scenario: { ...scene.scenario, event: [{ frame: 10, controller: 'manual' }] } };
    expect(reproduction(events, scene.scenario, 1, hash)).toBe('faba run scenes/steer.toml --seed 1 --json');
  });
  it('does not exist if a file is needed', () => {
    expect(reproduction(scene, { ...scene.scenario, swarm: [{ count: 400 }, { count: 1 }] }, 1, hash)).toBeNull();
    const events = { ...scene, scenario: { ...scene.scenario, event: [{ frame: 10, controller: 'manual' }] } };
    expect(reproduction(events, { ...scene.scenario, duration: '3 s' }, 1, hash)).toBeNull();
  });
});
