"""Controllers in Python on a simulated bench, behind the guard. The log of `faba rig simulate` has the true currents."""

import pathlib
import signal
import subprocess
import sys
import tempfile
import textwrap
import time
import unittest

import numpy as np
from common import PROGRAM, main

import faba

SCENE = """
duration = "20 s"
seed = 1
camera = { rate = "30 Hz", sensor = "frames" }
limits = { max_current = "0.4 A" }
arena = { type = "box", size_px = [160, 120] }
[[swarm]]
count = 30
model = { type = "dipole", preset = "IT-1" }
[rig]
camera = { type = "simulated", at = "AT" }
driver = { type = "simulated", at = "AT" }
camera_timeout = "5 s"
guard = { heartbeat_deadline = "0.4 s", command_deadline = "0.4 s" }
"""
# s, from the event to the last current: the deadlines above, which are long because other tests run meanwhile, and as
# much again. tests/e2e/bench_safety_test.cpp measures the guard with its own deadlines.
BOUND = 0.8


class Steady(faba.Controller):
    """The same current in all coils. Derived classes do something wrong after 0.7 s."""

    def start(self):
        self.wrong_at = None

    def wrong(self):
        return None

    def update(self, estimate, target, dt):
        if estimate.t > 0.7 and type(self) is not Steady:
            if self.wrong_at is None:
                self.wrong_at = time.monotonic()
            wrong = self.wrong()
            if wrong is not None:
                return wrong
        return [0.2] * self.context.coils

    def state(self):
        return {}

    def restore(self, state):
        pass


class Late(Exception):
    """The guard ended the run, because this computer is not a real-time system."""


def until_in_time(test):
    """Repeats a test for which the computer was late; skips it after four attempts."""

    def repeated(self):
        for _ in range(4):
            try:
                return test(self)
            except Late as e:
                late = str(e)
                self.doCleanups()
                self.setUp()
        self.skipTest(f"the computer was late four times: {late}")

    return repeated


class OnBench(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.path = pathlib.Path(self.folder.name)
        self.out = self.path / "run"
        self.addCleanup(self.folder.cleanup)
        self.scene = self.path / "scene.toml"
        self.scene.write_text(SCENE.replace("AT", str(self.path / "bench")))
        self.bench = subprocess.Popen([PROGRAM, "rig", "simulate", str(self.scene), "--at", str(self.path / "bench"), "--log",
                                       str(self.path / "coils.csv"), "--quiet"])
        self.addCleanup(self.bench.wait)
        self.addCleanup(self.bench.terminate)
        while not (self.path / "bench").exists():
            time.sleep(0.01)

    def run_it(self, controller, duration="1.5 s", **more):
        try:
            return faba.bench(self.scene, arm=True, controller=controller, out=self.out, duration=duration, **more)
        except faba.Error as e:
            if e.code == 4 and controller.wrong_at is None:
                raise Late(e.what) from e
            raise

    def log(self):
        """Times, s, and the largest current of the coils, A, for each row of the log."""
        lines = (self.path / "coils.csv").read_text().splitlines()
        columns = lines[0].count(",") + 1
        rows = np.array([[float(v) for v in line.split(",")] for line in lines[1:] if line.count(",") + 1 == columns])
        coils = (columns - 3) // 2
        return rows[:, 0], np.abs(rows[:, 3 + coils:]).max(axis=1)

    def assert_off(self, since):
        """No current later than BOUND after `since`, and some before."""
        time.sleep(BOUND + 0.2)
        t, current = self.log()
        self.assertTrue(np.any(current[t < since] > 0.1), "there was current before")
        flowing = t[(current > 5e-3) & (t > since)]  # 5 mA: 1 % of full scale
        self.assertLess(flowing.max(initial=since) - since, BOUND)

    @until_in_time
    def test_a_run_is_recorded_and_replayed(self):
        run = self.run_it(Steady(), set={"record.lossless": True})
        self.assertTrue(run.complete)
        self.assertGreater(len(run.series), 20)
        self.assert_off(time.monotonic())
        self.assertTrue(faba.replay(self.out, controller=Steady())["same"])

    def test_the_coils_stay_disarmed_without_permission(self):
        with self.assertRaises(faba.Error) as caught:
            faba.bench(self.scene, controller=Steady(), out=self.out)
        self.assertIn("arm=True", caught.exception.what)
        self.assertFalse(self.out.exists())

    @until_in_time
    def test_an_exception_switches_off(self):
        class Fails(Steady):
            def wrong(self):
                raise ZeroDivisionError("on the bench")

        controller = Fails()
        with self.assertRaises(ZeroDivisionError):
            self.run_it(controller)
        self.assertTrue((self.out / "incomplete").exists())
        self.assert_off(controller.wrong_at)

    @until_in_time
    def test_nan_switches_off(self):
        class Nan(Steady):
            def wrong(self):
                return [float("nan")] * self.context.coils

        controller = Nan()
        with self.assertRaises(faba.Error):
            self.run_it(controller)
        self.assertTrue((self.out / "incomplete").exists())
        self.assert_off(controller.wrong_at)

    @until_in_time
    def test_blocking_for_a_second_switches_off_meanwhile(self):
        class Blocks(Steady):
            def wrong(self):
                if time.monotonic() - self.wrong_at < 1:
                    time.sleep(1)

        controller = Blocks()
        with self.assertRaises(faba.Error) as caught:
            self.run_it(controller, duration="4 s")
        self.assertEqual(caught.exception.code, 4)
        self.assertIn("a call took 1", caught.exception.what)
        t, current = self.log()  # a row for each change
        self.assertGreater(current[t < controller.wrong_at][-1], 0.1)
        self.assertLess(current[t < controller.wrong_at + 0.9][-1], 5e-3)
        self.assertTrue((self.out / "incomplete").exists())

    def test_kill_9_switches_off(self):
        code = textwrap.dedent(f"""
            import sys; sys.path.insert(0, {str(pathlib.Path(__file__).parent)!r})
            from bench_test import Steady
            import faba
            faba.bench({str(self.scene)!r}, arm=True, controller=Steady(), out={str(self.out)!r})
        """)
        p = subprocess.Popen([sys.executable, "-c", code])
        deadline = time.monotonic() + 20
        while time.monotonic() < deadline:
            time.sleep(0.1)
            if (self.path / "coils.csv").stat().st_size and self.log()[1][-1] > 0.1:
                break
        killed = time.monotonic()
        p.send_signal(signal.SIGKILL)
        p.wait()
        self.assert_off(killed)
        self.assertTrue((self.out / "incomplete").exists())


if __name__ == "__main__":
    main()
