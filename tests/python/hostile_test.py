"""Hostile input: every call ends with a Python exception, and the interpreter continues."""

import gc
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np
from common import ROOT, SCENES, SMALL, main

import faba

# What a call may raise for unsuitable arguments.
EXPECTED = (faba.Error, TypeError, ValueError, OverflowError, RuntimeError)

THINGS = [
    None, True, -1, 0, 10**30, -(10**30), 1.5, math.nan, math.inf, "", "text", "\0", "a\nb = [", b"bytes", [], [[]], [None], {}, {"a": 1},
    {1: {2: {3: []}}}, object(), object, len, ..., 1j, range(3), np.zeros(0), np.zeros((0, 3)), np.zeros((2, 2, 2)), np.array([1, "x"]),
    np.array([object()]), np.float32(1), np.array(5.0), np.zeros(3, dtype="S5"), np.datetime64("2026-01-01"), np.ma.masked,
    np.arange(24.0).reshape(4, 6)[::2, ::-3], np.asfortranarray(np.ones((3, 4))), np.full((3, 3), np.nan),
]


def deep(levels):
    value = []
    for _ in range(levels):
        value = [value]
    return value


class Everything(unittest.TestCase):
    def attempt(self, call, *arguments, **named):
        try:
            call(*arguments, **named)
        except EXPECTED:
            pass

    def test_one_argument(self):
        for thing in [*THINGS, deep(5000)]:
            for call in (faba.Simulation, faba.Field, faba.parts, faba.Run, faba.resume, faba.compare_controllers, faba.Target):
                with self.subTest(call=call, thing=type(thing)):
                    self.attempt(call, thing)

    def test_named_arguments_of_a_simulation(self):
        for thing in [*THINGS, deep(5000)]:
            for name in ("seed", "set", "threads", "duration", "controller", "estimator", "reference"):
                with self.subTest(name=name, thing=type(thing)):
                    self.attempt(faba.Simulation, SMALL, **{name: thing})

    def test_calls_of_a_simulation(self):
        s = faba.Simulation(SMALL)
        for thing in THINGS:
            for call in (s.run, s.restore, lambda t: s.turn(command=t)):
                self.attempt(call, thing)
        self.assertTrue(all(np.isfinite(s.state["x"])))

    def test_numbers_of_currents(self):
        s = faba.Simulation(SMALL)
        for n in (0, 1, 3, 1000):
            with self.assertRaises(faba.Error):
                s.turn(command=[0.1] * n)
        s.turn(command=np.array([1, 2], dtype=np.int8))
        read_only = np.array([0.1, 0.1, 9, 9])[:2]
        read_only.setflags(write=False)
        s.turn(command=read_only)
        s.turn(command=np.arange(8.0)[::4])

    def test_arrays(self):
        f = faba.Field(ROOT / "rigs/thesis-four-coils.toml")
        for thing in THINGS:
            for call in (f.at, f.currents_for, f.null, lambda t: f.at([[0, 0]], t), lambda t: faba.flow(t, t), lambda t: faba.distance(t, t),
                         lambda t: faba.flow(np.zeros((8, 8)), t), lambda t: faba.flow(np.zeros((8, 8)), np.zeros((8, 8)), method=t),
                         lambda t: faba.flow(np.zeros((8, 8)), np.zeros((8, 8)), options=t),
                         lambda t: faba.Estimate(0, t, 1), lambda t: faba.Estimate(0, (0, 0), 1, cov=t), lambda t: faba.Drift(t, t)):
                self.attempt(call, thing)

    def test_worlds(self):
        for thing in THINGS:
            self.attempt(faba.Worlds, SMALL, thing)
            for name in ("threads", "set", "duration", "action", "strength"):
                self.attempt(faba.Worlds, SMALL, 1, **{name: thing})
        w = faba.Worlds(SMALL, 2)
        for call in (w.observations, w.true_centroids, w.finished, lambda: w.inputs, lambda: w.drawing(0), lambda: w.step(np.zeros((2, 2)))):
            with self.assertRaises(faba.Error):
                call()
        w.reset([0, 1], [1, 2], [{}, {}])
        for thing in THINGS:
            for call in (w.step, w.drawing, lambda t: w.reset(t, t, t), lambda t: w.reset([0], [1], [t]), lambda t: w.reset([0], [t], [{}])):
                self.attempt(call, thing)
        self.attempt(w.reset, [5], [1], [{}])
        self.attempt(w.reset, [0, 0], [1, 2], [{}, {}])
        self.assertEqual(w.observations().shape, (2, w.inputs))

    def test_a_failed_reset_leaves_no_half_world(self):
        w = faba.Worlds(SMALL, 2)
        w.reset([0, 1], [1, 2], [{}, {}])
        with self.assertRaises(faba.Error):
            w.reset([1], [1], [{"swarm[0].count": -1}])
        self.attempt(w.step, np.zeros((2, 2)))
        self.attempt(w.observations)
        self.attempt(w.drawing, 1)

    def test_batches(self):
        for thing in THINGS:
            self.attempt(faba.simulate, SMALL, {"swarm[0].count": thing}, 1, "iae_px_s")
            self.attempt(faba.simulate, SMALL, {}, thing, "iae_px_s")
            self.attempt(faba.simulate, SMALL, {}, 1, thing)

    def test_values_of_parts(self):
        for thing in THINGS:
            for kind, base in (("controller", faba.Controller), ("estimator", faba.Estimator), ("reference", faba.Reference)):
                part = type("Part", (base,), {"update": lambda self, *a, value=thing: value})
                self.attempt(lambda: faba.Simulation(SMALL, **{kind: part()}).run(3))

    def test_parts_that_change_under_the_loop(self):
        class Vanishing(faba.Controller):
            def update(self, estimate, target, dt):
                del type(self).update
                gc.collect()
                return [0.0, 0.0]

        self.attempt(lambda: faba.Simulation(SMALL, controller=Vanishing()).run())

    def test_measurements(self):
        for thing in [t for t in THINGS if t is not None][:30]:
            self.attempt(faba.drop, thing)
        for bad in (np.full((4, 4), -1.0), np.full((4, 4), np.nan), np.zeros((4, 4), dtype=complex)):
            with self.assertRaises(faba.Error):
                faba.drop(bad)
        with self.assertRaises(faba.Error) as caught:
            faba.track("missing.avi")
        self.assertEqual(caught.exception.code, 3)
        self.assertEqual(caught.exception.where, "missing.avi")


class Interpreters(unittest.TestCase):
    def test_a_subinterpreter_is_refused(self):
        for first in ("", "import faba\n"):
            code = (f"{first}import _xxsubinterpreters as s\ni = s.create()\n"
                    "try:\n    s.run_string(i, 'import faba')\nexcept s.RunFailedError as e:\n    print(e)\n")
            done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False, timeout=30)
            self.assertIn("subinterpreter", done.stdout + done.stderr)

    def test_exit_with_living_objects(self):
        code = (f"import faba\nclass C(faba.Controller):\n    def update(self, *a): return [0.0, 0.0]\n"
                f"s = faba.Simulation('''{SMALL}''', controller=C(), threads=2)\nt = s.turn()\nx = s.state['x']\n"
                f"w = faba.Worlds('''{SMALL}''', 3)\nw.reset([0, 1, 2], [1, 2, 3], [{{}}] * 3)\n")
        self.assertEqual(subprocess.run([sys.executable, "-c", code], check=False).returncode, 0)

    def test_paths_that_are_directories_and_text_without_a_scenario(self):
        with tempfile.TemporaryDirectory() as folder:
            for scene in (folder, pathlib.Path(folder), "a = 1\n", SCENES / "missing.toml"):
                with self.assertRaises(faba.Error):
                    faba.Simulation(scene)


if __name__ == "__main__":
    main()
