"""simulate(), compare_controllers() and studies on a Dask client."""

import importlib.util
import os
import pathlib
import subprocess
import tempfile
import textwrap
import threading
import unittest

import numpy as np
from common import PROGRAM, SMALL, faba as program, main
from proportional import Proportional

import faba

SPEED = "swarm[0].model.speed"


class Simulate(unittest.TestCase):
    def test_values_are_those_of_single_runs(self):
        speeds, seeds = [100e-6, 180e-6], [3, 4, 5]
        values = faba.simulate(SMALL, {SPEED: speeds}, seeds, "steady_rms_px")
        self.assertEqual(values.shape, (2, 3))
        with tempfile.TemporaryDirectory() as folder:
            scene = pathlib.Path(folder) / "small.toml"
            scene.write_text(SMALL)
            for i, speed in enumerate(speeds):
                for k, seed in enumerate(seeds):
                    run = program("run", scene, "--seed", seed, "--set", f"{SPEED}={speed}", "--out", pathlib.Path(folder) / "r",
                                  "--force", "--set", "record.video=false", "--set", "record.tracks=false")
                    self.assertAlmostEqual(values[i, k], run["steady_rms_px"], delta=1e-8 * run["steady_rms_px"])  # digits of series.csv

    def test_threads_do_not_change_the_values(self):
        one, two = (faba.simulate(SMALL, {SPEED: np.linspace(1e-4, 2e-4, 6)}, [1, 2], ["steady_rms_px", "iae_px_s"], threads=n)
                    for n in (1, 2))
        self.assertEqual(one.shape, (6, 2, 2))
        np.testing.assert_array_equal(one, two)

    def test_a_function_of_the_finished_simulation(self):
        hashes = faba.simulate(SMALL, {}, [1, 2], lambda s: s.state_hash)
        self.assertEqual(hashes.shape, (1, 2))
        self.assertEqual(hashes[0, 1], faba.Simulation(SMALL, seed=2).run().state_hash)

    def test_units_and_single_values(self):
        a = faba.simulate(SMALL, {SPEED: ["100 um/s", "180 um/s"], "swarm[0].count": 40}, 1, "iae_px_s")
        b = faba.simulate(SMALL, {SPEED: [100e-6, 180e-6], "swarm[0].count": [40, 40]}, [1], "iae_px_s")
        np.testing.assert_allclose(a, b, rtol=1e-12)

    def test_controllers_in_python(self):
        mine = faba.simulate(SMALL, {}, [1, 2, 3], "iae_px_s", controller=type("P", (Proportional,), {
            "__init__": lambda self: Proportional.__init__(self, actuation="duty", max_output=40, hold_frames=1)}))
        np.testing.assert_array_equal(mine, faba.simulate(SMALL, {}, [1, 2, 3], "iae_px_s"))
        with self.assertRaises(faba.Error) as caught:
            faba.simulate(SMALL, {}, [1], "iae_px_s", controller=Proportional())
        self.assertIn("give the class", caught.exception.what)

    def test_exceptions_in_the_function_end_the_batch(self):
        calls = []

        def fails(s):
            calls.append(threading.get_ident())
            raise LookupError("in the statistic")

        with self.assertRaises(LookupError):
            faba.simulate(SMALL, {}, list(range(200)), fails)
        self.assertLess(len(calls), 20)

    def test_refused(self):
        for parameters, seeds, statistic in [({SPEED: [1e-4, 2e-4], "swarm[0].count": [1, 2, 3]}, 1, "iae_px_s"), ({}, -1, "iae_px_s"),
                                             ({}, 1.5, "iae_px_s"), ({}, [1], "iae"), ({}, [1], 7), ({"swarm[0].model.spede": 1}, 1, "iae_px_s"),
                                             ({SPEED: object()}, 1, "iae_px_s"), ({SPEED: [float("nan")]}, 1, "iae_px_s")]:
            with self.subTest(parameters=parameters, seeds=seeds, statistic=statistic), self.assertRaises(faba.Error):
                faba.simulate(SMALL, parameters, seeds, statistic)


class Compare(unittest.TestCase):
    def test_a_class_among_the_controllers_of_a_study(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            (folder / "small.toml").write_text(SMALL)
            study = folder / "study.toml"
            study.write_text('scene = "small.toml"\nseeds = 3\n[[controller]]\nname = "built-in"\ntype = "proportional"\n'
                             'max_output = 5\nhold_frames = 2\n')
            result = faba.compare_controllers(study, {"mine": Proportional}, page=folder / "page.html")
            rows = {c["controller"]: c for c in result["combinations"]}
            self.assertEqual(rows["mine"]["metrics"], rows["built-in"]["metrics"])
            self.assertIn("mine", (folder / "page.html").read_text())


@unittest.skipIf(importlib.util.find_spec("distributed") is None, "python3-distributed is not installed: make test-engines")
class Client(unittest.TestCase):
    def test_a_study_on_a_client_has_the_bytes_of_one_process(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            (folder / "small.toml").write_text(SMALL)
            (folder / "study.toml").write_text('scene = "small.toml"\nseeds = 10\n[[controller]]\ntype = "fuzzy"\n')
            subprocess.run([PROGRAM, "compare-controllers", folder / "study.toml", "--out", folder / "one", "--quiet"], check=True)
            code = textwrap.dedent(f"""
                import distributed, faba
                if __name__ == "__main__":
                    cluster = distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None, processes=False)
                    with distributed.Client(cluster) as client:
                        print(faba.study.run({str(folder / "study.toml")!r}, client=client, out={str(folder / "many")!r}))
            """)
            (folder / "client.py").write_text(code)
            done = subprocess.run(["/usr/bin/python3", folder / "client.py"], capture_output=True, text=True, env=os.environ, check=False)
            self.assertEqual(done.returncode, 0, done.stderr)
            for name in ("controllers.json", "controllers.csv", "best.toml", "report.html"):
                self.assertEqual((folder / "one" / name).read_bytes(), (folder / "many" / name).read_bytes(), name)
            self.assertFalse((folder / "many/incomplete").exists())


if __name__ == "__main__":
    main()
