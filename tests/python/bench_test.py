"""Controllers in Python on a simulated bench, behind the guard: the coils are without current whatever happens."""

import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import textwrap
import time
import unittest

from common import SCENES, main

import faba

SETTINGS = {"record.lossless": True}
# s; the guard de-energises after its command deadline, and its log is written at the next report.
BOUND = 0.5


class Steady(faba.Controller):
    def update(self, estimate, target, dt):
        return [0.1] * self.context.coils


def log_of(run):
    """Rows (t, currents) of the log of the guard."""
    rows = (pathlib.Path(run) / "coils.csv").read_text().splitlines()
    return rows[0].split(","), [row.split(",") for row in rows[1:]]


def last_currents(run):
    header, rows = log_of(run)
    columns = [i for i, name in enumerate(header) if name.endswith("_a") and "sensed" not in name]
    return [float(rows[-1][i] or 0) for i in columns]


class OnBench(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.out = pathlib.Path(self.folder.name) / "run"
        self.addCleanup(self.folder.cleanup)

    def run_it(self, controller, duration="2 s"):
        return faba.bench(SCENES / "bench.toml", arm=True, controller=controller, out=self.out, duration=duration, set=SETTINGS)

    def test_a_controller_steers_the_bench_and_is_replayed(self):
        run = self.run_it(Steady())
        self.assertTrue(run.complete)
        self.assertGreater(len(run.series), 50)
        self.assertEqual(set(last_currents(self.out)), {0.0})
        replayed = faba.replay(self.out, controller=Steady())
        self.assertTrue(replayed["same"], replayed)

    def test_the_coils_stay_disarmed_without_permission(self):
        with self.assertRaises(faba.Error) as caught:
            faba.bench(SCENES / "bench.toml", controller=Steady(), out=self.out)
        self.assertIn("arm=True", caught.exception.what)
        self.assertFalse(self.out.exists())

    def test_an_exception_switches_off(self):
        class Fails(Steady):
            def update(self, estimate, target, dt):
                if estimate.t > 1:
                    raise ZeroDivisionError("on the bench")
                return super().update(estimate, target, dt)

        with self.assertRaises(ZeroDivisionError):
            self.run_it(Fails())
        self.assertTrue((self.out / "incomplete").exists())
        self.assertEqual(set(last_currents(self.out)), {0.0})

    def test_nan_switches_off(self):
        class Nan(Steady):
            def update(self, estimate, target, dt):
                return [float("nan")] * self.context.coils if estimate.t > 1 else super().update(estimate, target, dt)

        with self.assertRaises(faba.Error):
            self.run_it(Nan())
        self.assertTrue((self.out / "incomplete").exists())
        self.assertEqual(set(last_currents(self.out)), {0.0})

    def test_blocking_for_a_second_switches_off_meanwhile(self):
        class Blocks(Steady):
            def update(self, estimate, target, dt):
                if estimate.t > 1 and not self.blocked:
                    self.blocked = True
                    time.sleep(1)
                return super().update(estimate, target, dt)

            def start(self):
                self.blocked = False

        try:
            run = self.run_it(Blocks(), duration="3 s")
            self.assertGreater(run.manifest["command_timeouts"], 0)
        except faba.Error as e:  # a guard that trips ends the run
            self.assertEqual(e.code, 4)
        self.assertEqual(set(last_currents(self.out)), {0.0})

    def test_kill_9_switches_off(self):
        code = textwrap.dedent(f"""
            import sys; sys.path.insert(0, {str(pathlib.Path(__file__).parent)!r})
            from bench_test import Steady
            import faba
            faba.bench({str(SCENES / "bench.toml")!r}, arm=True, controller=Steady(), out={str(self.out)!r}, duration="60 s",
                       progress=lambda done, total: print(done, flush=True))
        """)
        p = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
        while float(p.stdout.readline()) < 1000:
            pass
        p.send_signal(signal.SIGKILL)
        p.wait()
        deadline = time.monotonic() + 10
        while time.monotonic() < deadline and set(last_currents(self.out)) != {0.0}:
            time.sleep(0.05)
        self.assertEqual(set(last_currents(self.out)), {0.0})
        self.assertTrue((self.out / "incomplete").exists())


if __name__ == "__main__":
    main()
