"""The stored policy examples/hold_policy.npz, without PyTorch and Gymnasium: in simulations, against fuzzy, and on the simulated bench."""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np
from common import ROOT, main

import faba

sys.path.append(str(ROOT / "examples"))
import evaluate_hold  # noqa: E402
from hold_policy import FILE, HoldPolicy, Memory  # noqa: E402

SEEDS = range(2000, 2006)  # neither of the training nor of the tables of the guide


class Policy(unittest.TestCase):
    def test_it_needs_neither_pytorch_nor_gymnasium(self):
        code = "import sys, hold_policy; sys.exit(any(name in sys.modules for name in ('torch', 'gymnasium')))"
        self.assertEqual(subprocess.run([sys.executable, "-c", code], cwd=ROOT / "examples", check=False).returncode, 0)
        self.assertLess(FILE.stat().st_size, 50_000)

    def test_it_beats_fuzzy(self):
        policy, fuzzy = (evaluate_hold.measure(evaluate_hold.CONTROLLERS[name], SEEDS) for name in ("policy", "fuzzy"))
        self.assertTrue(np.isfinite(policy[:, 2]).all(), "the policy settles")
        for metric in (0, 1):
            mean, half = evaluate_hold.interval(fuzzy[:, metric] - policy[:, metric])
            self.assertGreater(mean - half, 0, list(evaluate_hold.METRICS)[metric])

    def test_a_recorded_run_is_resumed_to_the_same_bits(self):
        class Stop(Exception):
            pass

        def progress(done, total):
            if done > total / 3:
                raise Stop

        options = {"set": {"record.video": False, "record.tracks": False, "swarm[0].count": 60}, "duration": "200 s", "seed": 1}
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            wanted = faba.run(evaluate_hold.SCENE, controller=HoldPolicy, out=folder / "a", **options).state_hash
            with self.assertRaises(Stop):
                faba.run(evaluate_hold.SCENE, controller=HoldPolicy, out=folder / "b", progress=progress, **options)
            self.assertEqual(faba.resume(folder / "b", controller=HoldPolicy).state_hash, wanted)

    def test_in_a_study_of_controllers(self):
        with tempfile.TemporaryDirectory() as folder:
            study = pathlib.Path(folder) / "study.toml"
            study.write_text(f'scene = {json.dumps(str(evaluate_hold.SCENE))}\nseeds = 3\n'
                             '[[controller]]\ntype = "fuzzy"\nmax_output = 40\n')
            result = faba.compare_controllers(study, {"policy": HoldPolicy})
        error = {c["controller"]: c["metrics"]["steady_rms_px"]["mean"] for c in result["combinations"]}
        self.assertLess(error["policy"], error["fuzzy"])

    def test_it_holds_the_swarm_on_the_simulated_bench(self):
        with tempfile.TemporaryDirectory() as folder:
            distance = evaluate_hold.hold_on_bench(1, pathlib.Path(folder) / "run")
        self.assertGreater(distance[0], 200)
        # Bounds of docs/guide/reinforcement-learning.md, px.
        self.assertLess(distance[-1], 10)
        self.assertLess(np.sqrt(np.mean(distance[2 * len(distance) // 3 :] ** 2)), 10)


class Inputs(unittest.TestCase):
    def test_memory(self):
        memory = Memory(2)
        observations = np.zeros((2, 11), np.float32)
        observations[:, 2] = [0.5, -0.5]  # setpoints
        inputs = memory.see(observations, True)
        self.assertEqual(inputs.shape, (2, Memory.INPUTS))
        np.testing.assert_allclose(inputs[:, 0], [2 * 0.5, -2 * 0.5])
        np.testing.assert_array_equal(inputs[:, 6:], 0)  # no motion, no actions
        memory.act(np.array([[3.0, 0.25], [-3.0, 0.25]], np.float32))
        observations[:, 0] = 0.1
        inputs = memory.see(observations, [False, True])
        np.testing.assert_allclose(inputs[0, 6:8], [40 * 0.1, 0], rtol=1e-5)  # the error was larger by 0.1
        np.testing.assert_allclose(inputs[0, 6 + 2 * (Memory.ERRORS - 1):][:2], [1.0, 0.25])
        np.testing.assert_array_equal(inputs[1, 6:], 0)  # a new episode


if __name__ == "__main__":
    main()
