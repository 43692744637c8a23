#!/usr/bin/python3
"""Trains a policy that holds a swarm at a setpoint: PPO (Schulman et al. 2017, arXiv 1707.06347) on many worlds of faba/Hold-v0.

    examples/train_hold.py [--steps 3000000] [--seed 1] [--out examples]

Needs PyTorch (Debian: python3-torch) and Gymnasium (pip install gymnasium). Writes hold_policy.npz, the weights that hold_policy.py
reads, and hold_learning.csv, the learning curve.
"""

import argparse
import csv
import math
import pathlib
import sys
import time

import gymnasium
import numpy as np
import torch
from hold_policy import Memory

import faba  # noqa: F401, registers the environments

WORLDS, STEPS = 64, 64  # in a batch: worlds, and frames of each
EPOCHS, PARTS = 6, 4  # of the optimisation with a batch
DISCOUNT, TRACE, CLIP = 0.99, 0.95, 0.2  # gamma, lambda of the advantage, limit of the ratio of probabilities
RATE, NOISE = 1e-3, 0.5  # first learning rate, first standard deviation of the actions
PIXEL = 1 / 240  # of the reward and of the observations, whose unit is half the height of the view


def moment(generator):
    """From a fifth of that of IT-1: the same as weaker coils, in which cells turn more slowly."""
    return 1e-15 * math.exp(generator.uniform(math.log(0.15), math.log(1.3)))


def make_worlds():
    from faba.environments import HoldVectorEnv

    randomise = {**HoldVectorEnv.task.random, "swarm[0].model.moment": moment, "camera.delay_frames": lambda g: int(g.integers(4))}
    # The policy sees the mean of the cells only: fewer of them are faster.
    return gymnasium.make_vec("faba/Hold-v0", num_envs=WORLDS, randomise=randomise, duration="6 s", set={"swarm[0].count": 100})


def network(outputs, last):
    layers = [torch.nn.Linear(Memory.INPUTS, 64), torch.nn.Tanh(), torch.nn.Linear(64, 64), torch.nn.Tanh(), torch.nn.Linear(64, outputs)]
    with torch.no_grad():
        layers[-1].weight.mul_(0.1)
    return torch.nn.Sequential(*layers, *last)


class Agent:
    def __init__(self):
        self.mean, self.value = network(2, [torch.nn.Tanh()]), network(1, [])
        self.log_sd = torch.nn.Parameter(torch.full((2,), math.log(NOISE)))
        self.parameters = [*self.mean.parameters(), *self.value.parameters(), self.log_sd]
        self.optimiser = torch.optim.Adam(self.parameters, lr=RATE, eps=1e-5)

    def actions(self, inputs):
        return torch.distributions.Normal(self.mean(inputs), self.log_sd.exp())

    def learn(self, inputs, actions, log_p, advantages, returns):
        for _ in range(EPOCHS):
            for rows in torch.randperm(len(inputs)).chunk(PARTS):
                a = advantages[rows]
                a = (a - a.mean()) / (a.std() + 1e-8)
                ratio = (self.actions(inputs[rows]).log_prob(actions[rows]).sum(1) - log_p[rows]).exp()
                gain = torch.min(ratio * a, ratio.clamp(1 - CLIP, 1 + CLIP) * a).mean()
                miss = (self.value(inputs[rows])[:, 0] - returns[rows]).pow(2).mean()
                self.optimiser.zero_grad()
                (0.5 * miss - gain).backward()
                torch.nn.utils.clip_grad_norm_(self.parameters, 0.5)
                self.optimiser.step()

    def save(self, path):
        linear = [layer for layer in self.mean if isinstance(layer, torch.nn.Linear)]
        weights = {f"weight{i}": layer.weight.detach().numpy() for i, layer in enumerate(linear)}
        np.savez(path, **weights, **{f"bias{i}": layer.bias.detach().numpy() for i, layer in enumerate(linear)})


class Worlds:
    """The worlds, what the policy remembers of them, and the batches that they give."""

    def __init__(self, seed):
        self.envs = make_worlds()
        observations, _ = self.envs.reset(seed=seed)
        self.memory = Memory(WORLDS)
        self.inputs = torch.from_numpy(self.memory.see(observations, True))
        self.ended = np.zeros(WORLDS, dtype=bool)

    def batch(self, agent):
        """Inputs, actions, logarithms of their probabilities, advantages, returns; and the mean reward of a frame."""
        rows = {name: [] for name in ("inputs", "actions", "log_p", "rewards", "values", "ended", "unused")}
        with torch.no_grad():
            for _ in range(STEPS):
                distribution = agent.actions(self.inputs)
                actions = distribution.sample()
                self.memory.act(actions.numpy())
                observations, rewards, _, truncated, _ = self.envs.step(actions.numpy())
                values = agent.value(self.inputs)[:, 0]
                now = (self.inputs, actions, distribution.log_prob(actions).sum(1), torch.from_numpy(rewards).float(), values,
                       torch.from_numpy(truncated), torch.from_numpy(self.ended))
                for row, one in zip(rows.values(), now):
                    row.append(one)
                # The step after the last one of an episode starts the next episode; its action is not used.
                self.inputs = torch.from_numpy(self.memory.see(observations, self.ended))
                self.ended = truncated
            r = {name: torch.stack(row) for name, row in rows.items()}
            advantages = self.advantages(r, agent.value(self.inputs)[:, 0])
        used = ~r["unused"]
        batch = [r["inputs"][used], r["actions"][used], r["log_p"][used], advantages[used], (advantages + r["values"])[used]]
        return batch, float(r["rewards"][used].mean())

    @staticmethod
    def advantages(r, after):
        """Generalised advantage estimation; an episode is only truncated, so its value goes on."""
        advantages, trace = torch.zeros_like(r["values"]), torch.zeros(WORLDS)
        for t in reversed(range(STEPS)):
            error = r["rewards"][t] + DISCOUNT * after - r["values"][t]
            trace = torch.where(r["unused"][t], torch.zeros(()), error + DISCOUNT * TRACE * trace * ~r["ended"][t])
            advantages[t], after = trace, r["values"][t]
        return advantages


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("--steps", type=int, default=3_000_000, help="frames of all worlds together, default 3000000")
    a.add_argument("--seed", type=int, default=1, help="of the worlds and of the weights, default 1")
    a.add_argument("--out", type=pathlib.Path, default=pathlib.Path(__file__).parent, help="folder of the results, default examples")
    o = a.parse_args()
    torch.manual_seed(o.seed)
    agent, worlds, begun = Agent(), Worlds(o.seed), time.perf_counter()
    updates = max(1, o.steps // (WORLDS * STEPS))
    with open(o.out / "hold_learning.csv", "w", newline="") as file:
        curve = csv.writer(file)
        curve.writerow(["frames", "time_s", "mean_distance_px", "action_sd"])
        for update in range(1, updates + 1):
            agent.optimiser.param_groups[0]["lr"] = RATE * (1 - (update - 1) / updates)
            batch, reward = worlds.batch(agent)
            agent.learn(*batch)
            elapsed, sd = time.perf_counter() - begun, float(agent.log_sd.exp().mean())
            curve.writerow([update * WORLDS * STEPS, f"{elapsed:.1f}", f"{-reward / PIXEL:.2f}", f"{sd:.3f}"])
            if sys.stderr.isatty() or update % 50 == 0:
                print(f"{update} of {updates} updates, {elapsed:.0f} s, mean distance {-reward / PIXEL:.1f} px, sd {sd:.3f}", file=sys.stderr, flush=True)
    agent.save(o.out / "hold_policy.npz")


if __name__ == "__main__":
    main()
