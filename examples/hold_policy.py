"""The trained policy of faba/Hold-v0 as a controller, in NumPy: it needs neither PyTorch nor Gymnasium.

    faba.run(scene, controller=hold_policy.HoldPolicy)

examples/train_hold.py trains the policy and writes hold_policy.npz.
"""

import pathlib

import numpy as np

from faba.policy import PolicyController

FILE = pathlib.Path(__file__).with_name("hold_policy.npz")


class Memory:
    """What the policy remembers of many worlds: the last errors and actions.

    The camera delivers positions late and with noise, and a cell needs several frames to turn. The last errors show how
    fast the swarm moves, and the last actions show what it does not show yet.
    """

    ERRORS, ACTIONS = 6, 8
    INPUTS = 2 * (3 + ERRORS - 1 + ACTIONS)

    def __init__(self, worlds):
        self.errors = np.zeros((worlds, self.ERRORS, 2), np.float32)  # setpoint minus centroid; the latest is the first
        self.actions = np.zeros((worlds, self.ACTIONS, 2), np.float32)

    def see(self, observations, first=False):
        """The inputs of the network, array (worlds, INPUTS); `first`: where an episode starts, mask or bool."""
        error = observations[:, 2:4] - observations[:, :2]
        self.errors = np.concatenate([error[:, np.newaxis], self.errors[:, :-1]], axis=1)
        first = np.broadcast_to(first, len(error))
        self.errors[first] = error[first, np.newaxis]
        self.actions[first] = 0.0
        moved = 40.0 * (self.errors[:, 1:] - error[:, np.newaxis])
        parts = [2.0 * error, np.tanh(6.0 * error), np.tanh(40.0 * error), moved.reshape(len(error), -1), self.actions.reshape(len(error), -1)]
        return np.concatenate(parts, axis=1)

    def act(self, actions):
        """Remembers the actions that are executed."""
        self.actions = np.concatenate([np.clip(actions, -1.0, 1.0)[:, np.newaxis], self.actions[:, :-1]], axis=1)


class HoldPolicy(PolicyController):
    """Holds a swarm at a setpoint."""

    def start(self):
        super().start()
        with np.load(FILE, allow_pickle=False) as file:
            self.layers = [(file[f"weight{i}"], file[f"bias{i}"]) for i in range(len(file.files) // 2)]
        self.memory, self.first = Memory(1), True

    def policy(self, observation):
        x = self.memory.see(observation[np.newaxis], self.first)
        self.first = False
        for weight, bias in self.layers:
            x = np.tanh(x @ weight.T + bias)
        self.memory.act(x)
        return x[0]

    def state(self):
        memory = {"errors": self.memory.errors.tolist(), "actions": self.memory.actions.tolist()}
        return {**super().state(), **memory, "first": self.first}

    def restore(self, state):
        super().restore(state)
        self.memory.errors = np.array(state["errors"], np.float32)
        self.memory.actions = np.array(state["actions"], np.float32)
        self.first = state["first"]


class BenchPolicy(HoldPolicy):
    """The same policy for coils that produce 10 field units, 0.23 mT, as those of scenes/bench.toml with 0.4 A."""

    strength = 10.0
