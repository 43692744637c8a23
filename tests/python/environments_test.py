"""The environments with the real Gymnasium, which is not in Debian: skipped without a copy of it."""

import importlib.util
import sys
import unittest
import warnings

import numpy as np
from common import ROOT, SHARED, main

import faba

COPY = SHARED / "clients/gymnasium"
if importlib.util.find_spec("gymnasium") is None and COPY.is_dir():
    sys.path.append(str(COPY))
MISSING = ""
try:
    import gymnasium
    from gymnasium.utils.env_checker import check_env
except ImportError as e:
    MISSING = f"Gymnasium cannot be imported ({e}): install it with pip"

IDS = ("faba/Hold-v0", "faba/Route-v0", "faba/Gather-v0")
SHORT = {"duration": "0.5 s", "set": {"swarm[0].count": 50}}


@unittest.skipIf(MISSING, MISSING)
class Environments(unittest.TestCase):
    def test_check_env(self):
        for name in IDS:
            with self.subTest(name), warnings.catch_warnings():
                warnings.simplefilter("error")
                check_env(gymnasium.make(name, render_mode="rgb_array", **SHORT).unwrapped)

    def test_the_same_seed_gives_the_same_trajectory(self):
        for name in IDS:
            first, second = (self.trajectory(gymnasium.make(name, **SHORT), 7) for _ in range(2))
            np.testing.assert_array_equal(first, second)
            self.assertFalse(np.array_equal(first, self.trajectory(gymnasium.make(name, **SHORT), 8)))

    def trajectory(self, env, seed):
        observation, info = env.reset(seed=seed)
        env.action_space.seed(seed)
        rows = [observation]
        for _ in range(20):
            observation, reward, *_ = env.step(env.action_space.sample())
            rows.append(np.append(observation, reward)[: len(observation)])
        return np.array(rows)

    def test_native_sync_and_async_vectors_have_the_same_trajectories(self):
        for name in IDS:
            results = {}
            for mode in ("vector_entry_point", "sync", "async"):
                envs = gymnasium.make_vec(name, num_envs=3, vectorization_mode=mode, **SHORT)
                observations, _ = envs.reset(seed=11)
                rows = [observations.copy()]
                actions = np.random.default_rng(1).uniform(-1, 1, (45, *envs.action_space.shape)).astype(np.float32)
                for action in actions:  # longer than an episode of 30 frames
                    observations, rewards, terminated, truncated, _ = envs.step(action)
                    rows.append(np.column_stack([observations, rewards, terminated, truncated]).astype(np.float32))
                envs.close()
                results[mode] = rows
            for mode in ("sync", "async"):
                for a, b in zip(results["vector_entry_point"], results[mode]):
                    np.testing.assert_array_equal(a, b)
            self.assertTrue(any(rows[:, -1].any() for rows in results["sync"][1:]), "an episode ended")

    def test_the_number_of_threads_does_not_change_a_trajectory(self):
        rows = []
        for threads in (1, 2):
            envs = gymnasium.make_vec("faba/Hold-v0", num_envs=4, threads=threads, **SHORT)
            envs.reset(seed=3)
            rows.append(np.array([envs.step(np.full((4, 2), 0.5, np.float32))[0] for _ in range(20)]))
        np.testing.assert_array_equal(*rows)

    def test_observation_has_delay_and_noise_and_info_has_the_truth(self):
        env = gymnasium.make("faba/Hold-v0", noise_px=0.0, delay_frames=3, **SHORT)
        env.reset(seed=1)
        true, seen = [], []
        for _ in range(12):
            observation, _, _, _, info = env.step(np.array([1.0, 0.0], np.float32))
            true.append(info["true_centroid"])
            seen.append(observation[:2] * env.unwrapped._task.worlds.half_height)
        np.testing.assert_allclose(seen[8], true[5], rtol=1e-5)
        self.assertGreater(np.linalg.norm(seen[8] - true[8]), 1e-6)
        noisy = gymnasium.make("faba/Hold-v0", noise_px=2.0, delay_frames=0, **SHORT)
        noisy.reset(seed=1)
        errors = []
        for _ in range(25):
            observation, _, _, _, info = noisy.step(np.zeros(2, np.float32))
            errors.append(observation[:2] * 240 - info["true_centroid"] / noisy.unwrapped._task.worlds.half_height * 240)
        # The standard deviation of 50 values with deviation 2: within 4 standard errors of 0.2.
        self.assertAlmostEqual(np.std(errors), 2.0, delta=0.8)

    def test_randomised_values(self):
        env = gymnasium.make("faba/Hold-v0", randomise={"swarm[0].model.speed": (1e-4, 2e-4)}, **SHORT)
        values = [env.reset(seed=i)[1]["randomised"]["swarm[0].model.speed"] for i in range(5)]
        self.assertEqual(len(set(values)), 5)
        self.assertTrue(all(1e-4 <= v <= 2e-4 for v in values))

    def test_a_route_ends_when_its_last_setpoint_is_reached(self):
        scene = {"reference.setpoints_px": [[320.0, 240.0]], "reference.tolerance_px": 500.0, "reference.hold_frames": 2, "swarm[0].count": 20}
        env = gymnasium.make("faba/Route-v0", set=scene, duration="2 s")
        env.reset(seed=1)
        ended = [env.step(np.zeros(2, np.float32))[2] for _ in range(3)]
        self.assertTrue(any(ended))

    def test_a_policy_as_controller_acts_as_in_the_environment(self):
        from faba.environments import PolicyController

        class Policy(PolicyController):
            def policy(self, observation):
                return 5.0 * (observation[2:4] - observation[:2])

        options = {"noise_px": 0.0, "randomise": {}, "duration": "1 s", "set": {"swarm[0].count": 50}}
        env = gymnasium.make("faba/Hold-v0", **options)
        observation, info = env.reset(seed=5)
        policy = Policy()
        ended = False
        while not ended:
            observation, _, _, ended, info = env.step(np.clip(policy.policy(observation), -1, 1))
        from faba import environments

        seed = int(gymnasium.utils.seeding.np_random(5)[0].integers(2**31))
        s = faba.Simulation(environments._HOLD, seed=seed, duration="1 s", set=options["set"], controller=Policy)
        s.run()
        x, y = s.state["x"].astype(float), s.state["y"].astype(float)
        np.testing.assert_allclose([x.mean(), y.mean()], info["true_centroid"], rtol=1e-12)

    def test_the_scene_of_the_training_example_is_that_of_hold(self):
        from faba import environments

        wanted = faba.Simulation(environments._HOLD).scenario
        found = faba.Simulation(ROOT / "examples/hold.toml").scenario
        for part in ("duration", "camera", "arena", "field", "limits", "estimator"):
            self.assertEqual(found.get(part), wanted.get(part), part)
        self.assertEqual(found["swarm"][0]["model"], wanted["swarm"][0]["model"])

    def test_wrong_actions(self):
        env = gymnasium.make("faba/Hold-v0", **SHORT).unwrapped
        env.reset(seed=1)
        for bad in ([0.0], [0.0, 0.0, 0.0], [np.nan, 0.0]):
            with self.assertRaises(faba.Error):
                env.step(np.array(bad))


class WithoutGymnasium(unittest.TestCase):
    def test_faba_does_not_import_gymnasium(self):
        import subprocess

        code = "import sys, faba; sys.exit('gymnasium' in sys.modules)"
        self.assertEqual(subprocess.run([sys.executable, "-c", code], check=False).returncode, 0)


if __name__ == "__main__":
    main()
