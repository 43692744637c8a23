#!/usr/bin/python3
"""Trains a policy that holds a swarm at a setpoint: PPO (Schulman et al. 2017, arXiv 1707.06347) on many worlds of faba/Hold-v0.

    examples/train_hold.py [--frames 1500000] [--seed 1] [--out examples]

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

WORLDS, FRAMES = 64, 300  # a batch is an episode of 5 s in each world
EPOCHS, PARTS = 8, 8  # of the optimisation with a batch
DISCOUNT, TRACE, CLIP = 0.97, 0.95, 0.2  # gamma, lambda of the advantage, limit of the ratio of probabilities
RATE, NOISE, SCALE = 1e-3, 0.4, 0.1  # first learning rate, first standard deviation of the actions, scale of the rewards
WIDTH = 32  # of the hidden layers
PIXEL = 1 / 240  # of the rewards and observations, whose unit is half the height of the view


def moment(generator):
    """From 0.15 to 1.3 times that of IT-1. A smaller moment has the effect of weaker coils: the cells turn more slowly."""
    return 1e-15 * math.exp(generator.uniform(math.log(0.15), math.log(1.3)))


def make_worlds():
    from faba.environments import HoldVectorEnv

    randomise = {**HoldVectorEnv.task.random, "swarm[0].model.moment": moment, "camera.delay_frames": lambda g: int(g.integers(4))}
    # The policy sees the mean of the cells only: fewer of them are faster.
    return gymnasium.make_vec("faba/Hold-v0", num_envs=WORLDS, randomise=randomise, duration=FRAMES / 60, set={"swarm[0].count": 60})


def network(outputs, last):
    layers = [torch.nn.Linear(Memory.INPUTS, WIDTH), torch.nn.Tanh(), torch.nn.Linear(WIDTH, WIDTH), torch.nn.Tanh(), torch.nn.Linear(WIDTH, outputs)]
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


def play(agent, worlds, seed=None):
    """An episode in each world: inputs, actions, logarithms of their probabilities, advantages, returns; and the mean distances, px."""
    names = ("inputs", "actions", "log_p", "rewards", "values")
    rows = {name: [] for name in names}
    memory = Memory(WORLDS)
    observations, _ = worlds.reset(seed=seed)
    with torch.no_grad():
        inputs = torch.from_numpy(memory.see(observations, True))
        for _ in range(FRAMES):
            distribution = agent.actions(inputs)
            actions = distribution.sample()
            memory.act(actions.numpy())
            observations, rewards, *_ = worlds.step(actions.numpy())
            for name, one in zip(names, (inputs, actions, distribution.log_prob(actions).sum(1), torch.from_numpy(rewards).float(),
                                         agent.value(inputs)[:, 0])):
                rows[name].append(one)
            inputs = torch.from_numpy(memory.see(observations))
        r = {name: torch.stack(row) for name, row in rows.items()}
        # The environment gives minus the distance. With its square root, small distances matter as well.
        advantages = estimate(-SCALE * (-r["rewards"]).sqrt(), r["values"], agent.value(inputs)[:, 0])
    batch = [r["inputs"], r["actions"], r["log_p"], advantages, advantages + r["values"]]
    return [one.flatten(0, 1) for one in batch], [float(-one.mean()) / PIXEL for one in (r["rewards"], r["rewards"][2 * FRAMES // 3 :])]


def estimate(rewards, values, last):
    """Generalised advantage estimation; an episode is truncated, so the value `last` of its last state counts."""
    advantages, trace, after = torch.zeros_like(values), torch.zeros(WORLDS), last
    for t in reversed(range(FRAMES)):
        trace = rewards[t] + DISCOUNT * after - values[t] + DISCOUNT * TRACE * trace
        advantages[t], after = trace, values[t]
    return advantages


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("--frames", type=int, default=1_500_000, help="simulated frames of all worlds together, default 1500000")
    a.add_argument("--seed", type=int, default=1, help="of the worlds and of the weights, default 1")
    a.add_argument("--out", type=pathlib.Path, default=pathlib.Path(__file__).parent, help="folder of the results, default examples")
    o = a.parse_args()
    torch.manual_seed(o.seed)
    torch.set_num_threads(1)  # the networks are small
    agent, worlds, started = Agent(), make_worlds(), time.perf_counter()
    updates = max(1, o.frames // (WORLDS * FRAMES))
    with open(o.out / "hold_learning.csv", "w", newline="", buffering=1) as file:
        curve = csv.writer(file)
        curve.writerow(["frames", "time_s", "mean_distance_px", "last_third_px", "action_sd"])
        for update in range(1, updates + 1):
            agent.optimiser.param_groups[0]["lr"] = RATE * (1 - (update - 1) / updates)
            batch, (distance, steady) = play(agent, worlds, o.seed if update == 1 else None)
            agent.learn(*batch)
            elapsed, sd = time.perf_counter() - started, float(agent.log_sd.exp().mean())
            curve.writerow([update * WORLDS * FRAMES, f"{elapsed:.1f}", f"{distance:.2f}", f"{steady:.2f}", f"{sd:.3f}"])
            print(f"{update} of {updates} updates, {elapsed:.0f} s, mean distance {distance:.1f} px, in the last third {steady:.1f} px", file=sys.stderr, flush=True)
            agent.save(o.out / "hold_policy.npz")
    print(f"{updates * WORLDS * FRAMES} frames in {time.perf_counter() - started:.0f} s, processor time {time.process_time():.0f} s")


if __name__ == "__main__":
    main()
