"""The contract of the adapter examples/swarmrl_engine.py, with a force model that records what it gets."""

import dataclasses
import sys
import types
import unittest
from typing import Any

import numpy as np
from common import ROOT, SMALL, main

sys.path.append(str(ROOT / "examples"))
from swarmrl_engine import SwarmEngine  # noqa: E402

import faba  # noqa: E402


@dataclasses.dataclass
class Action:
    force: float = 0.0
    torque: Any = None
    new_direction: Any = None


class Recording:
    """A force model: records the colloids and returns what `decide` makes of the first."""

    kill_switch = False

    def __init__(self, decide):
        self.decide, self.seen = decide, []

    def calc_action(self, colloids):
        self.seen.append(colloids)
        return [self.decide(colloids[0])]


def up(_):
    return Action(force=1.0, new_direction=np.array([0.0, 2.0, 0.0]))


class Engine(unittest.TestCase):
    def test_colloids(self):
        engine = SwarmEngine(SMALL, particle_type=3)
        (swarm,) = engine.colloids
        self.assertEqual((swarm.id, swarm.type), (0, 3))
        for vector in (swarm.pos, swarm.director, swarm.velocity):
            self.assertEqual(vector.shape, (3,))
        # The swarm of SMALL starts at (250, 240) px in a view of 640 x 480 px, in a disc with a radius of 25 px: the standard error of
        # the mean of 60 cells is 1.6 px per axis; tolerance: 4 of them.
        um_per_px = 1e6 * engine.context.m_per_px
        np.testing.assert_allclose(swarm.pos / um_per_px, [-70, 0, 0], atol=6.5)
        np.testing.assert_array_equal(swarm.director, [1, 0, 0])

    def test_an_action_is_asked_for_in_every_slice_and_kept_for_its_frames(self):
        engine, model = SwarmEngine(SMALL, frames_per_slice=4), Recording(up)
        engine.integrate(3, model)
        self.assertEqual(len(model.seen), 3)
        self.assertTrue(all(len(colloids) == 1 for colloids in model.seen))
        self.assertEqual(engine.simulation.frame, 1 + 3 * 4)

    def test_the_swarm_moves_along_the_direction(self):
        engine, model = SwarmEngine(SMALL), Recording(up)
        engine.integrate(4, model)
        first, last = model.seen[0][0], engine.colloids[0]
        moved = last.pos - first.pos
        # 0.8 s at 186 um/s less a turn of 50 ms; half of it is certain.
        self.assertGreater(moved[1], 0.5 * 0.8 * 186)
        self.assertLess(abs(moved[0]), 0.2 * moved[1])
        np.testing.assert_array_equal(last.director, [0, 1, 0])
        np.testing.assert_allclose(last.velocity[1], 186, rtol=0.25)

    def test_force_is_the_field_in_units_of_strength(self):
        for force, factor in ((0.25, 0.25), (1.0, 1.0), (7.0, 1.0), (-1.0, 0.0)):
            engine = SwarmEngine(SMALL, strength=20.0)
            at = engine.tick.estimate.centroid
            engine.integrate(1, Recording(lambda _, f=force: Action(force=f, new_direction=[1.0, 0.0, 5.0])))
            wanted = engine.context.currents_for_direction((20.0 * factor, 0.0), at=at)
            np.testing.assert_allclose(engine.tick.command, wanted, rtol=0.02, atol=1e-12)

    def test_limits_act(self):
        engine = SwarmEngine(SMALL, strength=1000.0)
        engine.integrate(1, Recording(up))
        np.testing.assert_allclose(np.abs(engine.tick.command).max(), engine.context.max_currents.max())

    def test_without_a_direction_the_director_is_kept(self):
        engine = SwarmEngine(SMALL)
        engine.integrate(1, Recording(up))
        engine.integrate(1, Recording(lambda _: Action(force=1.0)))
        np.testing.assert_array_equal(engine.colloids[0].director, [0, 1, 0])

    def test_a_feedback_law_holds_the_swarm(self):
        goal = np.array([60 * 0.9164, 0.0, 0.0])  # (380, 240) px

        def towards(swarm):
            return Action(force=1.0, new_direction=goal - swarm.pos)

        engine = SwarmEngine(SMALL, frames_per_slice=2, duration="3 s")
        engine.integrate(1000, Recording(towards))
        self.assertTrue(engine.simulation.finished)
        self.assertLess(np.linalg.norm(engine.colloids[0].pos - goal), 30.0)  # um; 119 um at the start

    def test_the_kill_switch_ends_the_integration(self):
        model = Recording(up)
        engine = SwarmEngine(SMALL)

        def last(swarm):
            model.kill_switch = True
            return up(swarm)

        model.decide = last
        engine.integrate(5, model)
        self.assertEqual(len(model.seen), 1)

    def test_the_same_seed_gives_the_same_bits(self):
        hashes = set()
        for _ in range(2):
            engine = SwarmEngine(SMALL, seed=9)
            engine.integrate(3, Recording(up))
            hashes.add(engine.simulation.state_hash)
        self.assertEqual(len(hashes), 1)
        other = faba.Simulation(SMALL, seed=9)
        other.run(19)
        self.assertNotIn(other.state_hash, hashes)

    def test_the_class_of_the_colloids_is_that_of_the_caller(self):
        mine = lambda pos, director, id, velocity, type: types.SimpleNamespace(pos=pos, mine=True)  # noqa: A002, E731
        self.assertTrue(SwarmEngine(SMALL, colloid=mine).colloids[0].mine)

    def test_finalize(self):
        engine = SwarmEngine(SMALL)
        engine.finalize()
        engine.finalize()
        with self.assertRaises(RuntimeError):
            engine.integrate(1, Recording(up))

    def test_refused(self):
        for action in (Action(torque=[0, 0, 1]), Action(force=float("nan")), Action(new_direction=[1.0, 0.0]),
                       Action(new_direction=[0.0, 0.0, 1.0]), Action(new_direction=[np.inf, 0.0, 0.0])):
            with self.subTest(action), self.assertRaises(ValueError):
                SwarmEngine(SMALL).integrate(1, Recording(lambda _, a=action: a))
        none = types.SimpleNamespace(calc_action=lambda colloids: [])
        with self.assertRaises(ValueError):
            SwarmEngine(SMALL).integrate(1, none)
        with self.assertRaises(ValueError):
            SwarmEngine(SMALL, frames_per_slice=0)


if __name__ == "__main__":
    main()
