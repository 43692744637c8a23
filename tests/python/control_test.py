"""Parts in Python: what they may return, errors, checkpoints."""

import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import time
import traceback
import unittest

import numpy as np
from common import PROGRAM, SMALL, main
from proportional import Proportional

import faba


class Towards(faba.Controller):
    """Ten lines: swim towards the setpoint."""

    def update(self, estimate, target, dt):
        x, y = 1e-1 * (target.position - estimate.centroid)
        return faba.Drift(x, y)


class Counting(faba.Controller):
    """Keeps a value, with state() and restore()."""

    def __init__(self):
        self.calls = 0

    def state(self):
        return {"calls": self.calls}

    def restore(self, state):
        self.calls = state["calls"]

    def update(self, estimate, target, dt):
        self.calls += 1
        sign = 1 if self.calls // 7 % 2 else -1
        return self.context.max_currents * sign * 0.1


class Forgetful(Counting):
    state = None

    def __getattribute__(self, name):
        if name == "state":
            raise AttributeError(name)
        return super().__getattribute__(name)


class Mean(faba.Estimator):
    """The estimator `mean` in Python."""

    def update(self, observation, last):
        positions = observation.positions.astype(float)
        return faba.Estimate(observation.t, positions.mean(axis=0), len(positions), cov=np.cov(positions.T))


class Circle(faba.Reference):
    setpoints = [(1e-4, 0.0), (0.0, 1e-4)]
    tolerance_px = 5.0

    def update(self, estimate):
        return (1e-4 * np.cos(estimate.t), 1e-4 * np.sin(estimate.t))


def returning(value):
    class Returns(faba.Controller):
        def update(self, estimate, target, dt):
            return value

    return Returns


class Returned(unittest.TestCase):
    def distance(self, s):
        tick = s.turn()
        return np.linalg.norm(tick.target.position - tick.estimate.centroid)

    def test_a_drift_moves_the_swarm(self):
        s = faba.Simulation(SMALL, controller=Towards(), duration=4)
        first = self.distance(s)
        s.run(100)
        self.assertLess(self.distance(s), 0.6 * first)

    def test_estimator_and_reference(self):
        s = faba.Simulation(SMALL, estimator=Mean(), reference=Circle())
        tick = s.turn()
        x, y = s.state["x"].astype(float), s.state["y"].astype(float)
        np.testing.assert_allclose(tick.estimate.centroid, [x.mean(), y.mean()], rtol=1e-6)
        np.testing.assert_allclose(tick.target.position, [1e-4, 0.0])

    def test_refused_values(self):
        for value, message in [(None, "returned None"), ([1.0], "1 current, but the field has 2 coils"),
                               ([1.0, 2.0, 3.0], "3 currents"), ([np.nan, 0.0], "finite"), (faba.Drift(np.inf, 0), "finite"),
                               ("text", "give numbers"), ({}, "give numbers"), ([[1.0, 2.0]], "dimensions"), (1j, ""), ([10**400, 0], "")]:
            with self.subTest(value=str(value)[:40]):
                s = faba.Simulation(SMALL, controller=returning(value))
                with self.assertRaises((faba.Error, OverflowError)) as caught:
                    s.turn()
                self.assertIn(message, str(caught.exception))

    def test_a_swarm_that_is_not_seen_switches_the_coils_off(self):
        class Blind(faba.Estimator):
            def update(self, observation, last):
                return faba.Estimate(observation.t, (0.0, 0.0), 0)

        tick = faba.Simulation(SMALL, controller=returning([0.1, 0.1]), estimator=Blind()).turn()
        np.testing.assert_array_equal(tick.command, [0, 0])


class Raised(unittest.TestCase):
    def test_the_exception_reaches_the_caller_with_its_traceback(self):
        class Fails(faba.Controller):
            def update(self, estimate, target, dt):
                raise KeyError("the reason")

        s = faba.Simulation(SMALL, controller=Fails())
        names = []
        try:
            s.run()
        except KeyError as e:  # assertRaises removes the traceback
            names = [frame.name for frame in traceback.extract_tb(e.__traceback__)]
        self.assertIn("update", names)
        np.testing.assert_array_equal(s.currents, [0, 0])

    def test_exceptions_in_the_constructor_and_in_start(self):
        class NoStart(faba.Controller):
            def start(self):
                raise ValueError("start")

        class NoInit(faba.Controller):
            def __init__(self):
                raise ValueError("init")

        for part in (NoStart(), NoInit):
            with self.assertRaises(ValueError):
                faba.Simulation(SMALL, controller=part)
        with self.assertRaises(faba.Error) as caught:
            faba.Simulation(SMALL, controller=object())
        self.assertIn("no function update", caught.exception.what)

    def test_a_part_cannot_use_its_own_simulation(self):
        class Inner(faba.Controller):
            def update(self, estimate, target, dt):
                held[0].turn()

        held = [None]
        held[0] = faba.Simulation(SMALL, controller=Inner())
        with self.assertRaises(faba.Error) as caught:
            held[0].turn()
        self.assertIn("control loop", caught.exception.what)
        held.clear()

    def test_control_c_stops_a_long_call(self):
        code = ("import faba, sys\n"
                f"s = faba.Simulation('''{SMALL}''', duration=3000, set={{'swarm[0].count': 20000, 'exclusion.order': 'none'}})\n"
                "print('ready', flush=True)\n"
                "try:\n    s.run()\nexcept KeyboardInterrupt:\n    print('stopped', flush=True)\n")
        p = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
        self.assertEqual(p.stdout.readline(), "ready\n")
        time.sleep(0.5)
        p.send_signal(signal.SIGINT)
        started = time.monotonic()
        out, _ = p.communicate(timeout=30)
        self.assertEqual(out, "stopped\n")
        self.assertLess(time.monotonic() - started, 5)


class Stop(Exception):
    pass


def interrupted_run(out, part):
    """Stops a run in the middle, as Ctrl-C does: with a checkpoint."""

    def progress(done, total):
        if done > total / 3:
            raise Stop

    try:
        faba.run(SMALL, controller=part, out=out, duration="300 s", progress=progress, set={"record.video": False})
    except Stop:
        return
    raise AssertionError("the run was not stopped")


class Recorded(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.path = pathlib.Path(self.folder.name)
        self.addCleanup(self.folder.cleanup)

    def test_run(self):
        run = faba.run(SMALL, controller=Towards(), out=self.path / "a")
        self.assertTrue(run.complete)
        self.assertEqual(run.state_hash, faba.Simulation(SMALL, controller=Towards()).run().state_hash)
        self.assertEqual(len(run.series), 30)
        self.assertIn("settling_time_s", run.metrics)
        self.assertTrue(run.video.exists())
        self.assertIn('"control_test:Towards"' if __name__ != "__main__" else '"__main__:Towards"',
                      (run.path / "scenario.toml").read_text())

    def test_an_exception_leaves_the_run_incomplete(self):
        class Fails(faba.Controller):
            def update(self, estimate, target, dt):
                if estimate.t > 0.5:
                    raise ArithmeticError("late")
                return [0.0, 0.0]

        with self.assertRaises(ArithmeticError) as caught:
            faba.run(SMALL, controller=Fails(), out=self.path / "b")
        self.assertIn(str(self.path / "b"), caught.exception.__notes__[0])
        self.assertTrue((self.path / "b/incomplete").exists())
        self.assertFalse(faba.Run(self.path / "b").complete)

    def test_resume_gives_the_bits_of_an_uninterrupted_run(self):
        wanted = faba.run(SMALL, controller=Counting, out=self.path / "complete", duration="300 s", set={"record.video": False}).state_hash
        interrupted_run(self.path / "cut", Counting())
        self.assertFalse(faba.Run(self.path / "cut").complete)
        self.assertEqual(faba.resume(self.path / "cut", controller=Counting).state_hash, wanted)

    def test_resume_imports_the_class(self):
        interrupted_run(self.path / "cut", Proportional)
        self.assertTrue(faba.resume(self.path / "cut").complete)

    def test_a_part_with_memory_but_without_state_is_refused(self):
        interrupted_run(self.path / "cut", Forgetful)
        with self.assertRaises(faba.Error) as caught:
            faba.resume(self.path / "cut", controller=Forgetful)
        self.assertIn("state() and restore()", caught.exception.what)

    def test_the_program_says_where_the_class_is(self):
        interrupted_run(self.path / "cut", Counting)
        done = subprocess.run([PROGRAM, "resume", str(self.path / "cut")], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 2)
        self.assertIn("faba.resume", done.stderr)


class Fork(unittest.TestCase):
    def test_a_simulation_with_threads_is_refused_after_fork(self):
        s = faba.Simulation(SMALL, threads=2)
        s.turn()
        child = os.fork()
        if child == 0:
            code = 1
            try:
                s.turn()
            except faba.Error as e:
                code = 0 if "forked" in e.what else 2
            finally:
                os._exit(code)
        self.assertEqual(os.waitpid(child, 0)[1], 0)
        self.assertEqual(threading.active_count(), 1)


if __name__ == "__main__":
    main()
