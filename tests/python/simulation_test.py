"""Simulation: the bits of the program, views of the state, saved states."""

import gc
import pathlib
import tempfile
import threading
import unittest

import numpy as np
from common import SCENES, SMALL, faba as program, main
from proportional import Proportional

import faba

# Scenes of all models, arenas, sensors and controllers, with a duration that simulates in a second.
TEN = {
    "aging": "2 s", "as-seen": "1 s", "bench": "2 s", "corner": "2 s", "drop": "2 s", "exposure": "2 s", "null-route": "4 s",
    "steer": "3 s", "thesis-adapted": "4 s", "thesis-basic": "4 s",
}


class SameBits(unittest.TestCase):
    def test_ten_scenes_have_the_state_hash_of_the_program(self):
        for name, duration in TEN.items():
            scene = SCENES / f"{name}.toml"
            with tempfile.TemporaryDirectory() as folder:
                wanted = program("run", scene, "--seed", 5, "--duration", duration, "--out", pathlib.Path(folder) / "run",
                                 "--set", "record.video=false", "--set", "record.tracks=false")["state_hash"]
            for threads in (1, 2):
                with self.subTest(scene=name, threads=threads):
                    s = faba.Simulation(scene, seed=5, duration=duration, threads=threads)
                    self.assertEqual(s.run().state_hash, wanted)
            with self.subTest(scene=name, turn=True):
                s = faba.Simulation(scene, seed=5, duration=duration)
                while not s.finished:
                    s.turn()
                self.assertEqual(s.state_hash, wanted)

    def test_a_controller_in_python_repeats_the_built_in_one(self):
        cases = [(SCENES / "steer.toml", dict(actuation="duty", max_output=40, hold_frames=1, lead=0.1)),
                 (SCENES / "thesis-basic.toml", dict(max_output=5.0, integral_gain=0.01)),
                 (SMALL, dict(actuation="duty", max_output=40, hold_frames=1))]
        for scene, parameters in cases:
            table = {"type": "proportional", **{k: v for k, v in parameters.items() if v is not None}}
            built_in = faba.Simulation(scene, seed=2, duration=3, controller=table)
            mine = faba.Simulation(scene, seed=2, duration=3, controller=Proportional(**parameters))
            first = built_in.state["x"].copy()
            self.assertEqual(mine.run().state_hash, built_in.run().state_hash)
            self.assertFalse(np.array_equal(first, built_in.state["x"]))

    def test_given_currents_pass_the_limits(self):
        s = faba.Simulation(SMALL)
        tick = s.turn(command=[1e9, -1e9])
        np.testing.assert_array_equal(tick.command, [1, -1] * s.context.max_currents)
        self.assertTrue(tick.limited)

    def test_the_last_frame_ends_the_scenario(self):
        s = faba.Simulation(SMALL, duration=0.1).run()
        self.assertEqual(s.frame, s.frames)
        with self.assertRaises(faba.Error) as caught:
            s.turn()
        self.assertIn("longer duration", caught.exception.what)


class Views(unittest.TestCase):
    def test_the_state_of_1e5_cells_is_a_view(self):
        s = faba.Simulation(SCENES / "million.toml", set={"swarm[0].count": 100000}, seed=1)
        a, b = s.state["x"], s.state["x"]
        self.assertEqual(a.__array_interface__["data"][0], b.__array_interface__["data"][0])
        self.assertEqual(len(a), 100000)
        before = a.copy()
        s.turn()
        s.turn()
        self.assertFalse(np.array_equal(a, before), "the view shows the present state")
        with self.assertRaises(ValueError):
            a[0] = 0

    def test_views_live_longer_than_the_simulation(self):
        s = faba.Simulation(SMALL)
        tick = s.turn()
        x, positions = s.state["x"], tick.observation.positions
        expected_x, expected = x.copy(), positions.copy()
        del s, tick
        gc.collect()
        rubbish = [np.random.bytes(1000) for _ in range(2000)]
        np.testing.assert_array_equal(x, expected_x)
        np.testing.assert_array_equal(positions, expected)
        self.assertEqual(len(rubbish), 2000)

    def test_views_stay_valid_after_restore_and_exchange_of_the_model(self):
        text = SMALL + '[[event]]\nframe = 3\nmodel = { type = "dipole", speed = "50 um/s" }\n'
        s = faba.Simulation(text)
        saved = s.save()
        x = s.state["x"]
        address = x.__array_interface__["data"][0]
        s.run(10)
        s.restore(saved)
        self.assertEqual(s.state["x"].__array_interface__["data"][0], address)
        np.testing.assert_array_equal(x, s.state["x"])

    def test_pictures(self):
        s = faba.Simulation(SMALL, set={"record.as_seen": True})
        s.turn()
        picture = s.picture()
        self.assertEqual((picture.dtype, picture.ndim), (np.uint8, 2))
        self.assertEqual(s.drawing().shape, (*picture.shape, 3))
        with self.assertRaises(faba.Error):
            t = faba.Simulation(SMALL)
            t.turn()
            t.picture()


class Saved(unittest.TestCase):
    def test_a_restored_simulation_continues_with_the_same_bits(self):
        s = faba.Simulation(SMALL)
        s.run(10)
        saved = s.save()
        wanted = s.run().state_hash
        again = faba.Simulation(SMALL)
        again.restore(saved)
        self.assertEqual(again.frame, 10)
        self.assertEqual(again.run().state_hash, wanted)

    def test_another_state_is_refused(self):
        s, other = faba.Simulation(SMALL), faba.Simulation(SMALL, set={"swarm[0].count": 61})
        for bad in (other.save(), b"", b"x" * 100, s.save()[:-1], s.save() + b"1"):
            with self.assertRaises(faba.Error):
                s.restore(bad)


class Threads(unittest.TestCase):
    def test_two_threads_cannot_use_one_simulation(self):
        s = faba.Simulation(SCENES / "million.toml", set={"swarm[0].count": 200000}, seed=1)
        errors = []

        def use():
            try:
                s.run(20)
            except faba.Error as e:
                errors.append(e)

        threads = [threading.Thread(target=use) for _ in range(4)]
        for t in threads:
            t.start()
        for t in threads:
            t.join()
        self.assertTrue(errors)
        self.assertIn("another thread", errors[0].what)

    def test_simulations_of_several_threads_are_independent(self):
        wanted = faba.Simulation(SMALL).run().state_hash
        hashes = []
        threads = [threading.Thread(target=lambda: hashes.append(faba.Simulation(SMALL).run().state_hash)) for _ in range(4)]
        for t in threads:
            t.start()
        for t in threads:
            t.join()
        self.assertEqual(hashes, [wanted] * 4)


if __name__ == "__main__":
    main()
