#!/usr/bin/python3
"""Compares the policy of hold_policy.npz with built-in controllers, each with the same starts, setpoints, speeds and seeds.

    examples/evaluate_hold.py [--seeds 20] [--first 1000] [--bench] [--fuzzy] [--curve FILE]

Prints tables in Markdown: means over the seeds with 95 % intervals, and paired differences. --bench: the policy also holds a swarm on
the simulated bench of scenes/bench.toml, in real time. --fuzzy: tests other values of max_output of fuzzy.
--curve: draws hold_learning.csv (needs matplotlib). Needs no PyTorch.
"""

import argparse
import csv
import math
import pathlib
import tempfile

import numpy as np
from hold_policy import BenchPolicy, HoldPolicy

import faba

HERE = pathlib.Path(__file__).resolve().parent
SCENE, BENCH = HERE / "hold.toml", HERE.parent / "scenes/bench.toml"
# Deadlines of the guard for a computer that is busy with other work. Nothing real is connected.
PATIENT = {"rig.guard.heartbeat_deadline": 0.4, "rig.guard.command_deadline": 0.4, "rig.camera_timeout": 5}
STRENGTH = 40  # field units of all controllers
AT, NEAR, FAR = [0, 0, 1, 8], [1, 8, 40, 120], [40, 120, 1e9, 1e9]
CONTROLLERS = {
    "policy": HoldPolicy,
    "fuzzy": {"type": "fuzzy", "max_output": STRENGTH},
    "fuzzy, third set": {"type": "fuzzy", "set": [{"name": "at", "trapezoid_px": AT, "output": 0},
                                                  {"name": "near", "trapezoid_px": NEAR, "output": STRENGTH / 2},
                                                  {"name": "far", "trapezoid_px": FAR, "output": STRENGTH}]},
    "proportional": {"type": "proportional", "actuation": "duty", "max_output": STRENGTH, "hold_frames": 1, "lead": "100 ms"},
}
METRICS = {"steady_rms_px": "steady-state error, px", "iae_px_s": "IAE, px s", "settling_time_s": "settling time, s"}
# 97.5 % quantiles of Student's t distribution for up to 30 degrees of freedom; 1.96 beyond.
STUDENT = [12.71, 4.30, 3.18, 2.78, 2.57, 2.45, 2.36, 2.31, 2.26, 2.23, 2.20, 2.18, 2.16, 2.14, 2.13, 2.12, 2.11, 2.10, 2.09, 2.09, 2.08,
           2.07, 2.07, 2.06, 2.06, 2.06, 2.05, 2.05, 2.05, 2.04]


def case(seed):
    """Start and setpoint in the inner part of the drop, and speed, at random, as in the environment."""
    generator = np.random.default_rng(seed)

    def position():
        radius, angle = 150 * math.sqrt(generator.random()), generator.uniform(0, 2 * math.pi)
        return [320 + radius * math.cos(angle), 240 + radius * math.sin(angle)]

    return {"swarm[0].start.centre_px": position(), "reference.setpoint_px": position(), "swarm[0].model.speed": generator.uniform(150e-6, 220e-6)}


def measure(controller, seeds):
    """The metrics of a controller, array (seeds, metrics)."""
    return np.array([faba.simulate(SCENE, {}, [seed], list(METRICS), set=case(seed), controller=controller)[0, 0] for seed in seeds])


def interval(values):
    """Mean and half the width of its 95 % interval, of the values that exist."""
    values = values[np.isfinite(values)]
    if len(values) < 2:
        return math.nan, math.nan
    t = STUDENT[len(values) - 2] if len(values) - 2 < len(STUDENT) else 1.96
    return float(values.mean()), float(t * values.std(ddof=1) / math.sqrt(len(values)))


def text(values):
    mean, half = interval(values)
    return "" if math.isnan(mean) else f"{mean:.2f} ± {half:.2f}"


def compare(seeds):
    """Prints the tables."""
    results = {name: measure(controller, seeds) for name, controller in CONTROLLERS.items()}
    print(f"Means of {len(seeds)} seeds with 95 % intervals:\n")
    print(f"| controller | {' | '.join(METRICS.values())} | settled |")
    print("|---|" + "---|" * (len(METRICS) + 1))
    for name, values in results.items():
        print(f"| {name} | {' | '.join(text(column) for column in values.T)} | {np.isfinite(values[:, -1]).sum()} of {len(seeds)} |")
    print("\nDifferences to the policy for equal seeds; positive: the policy is better:\n")
    print(f"| controller | {' | '.join(METRICS.values())} |")
    print("|---|" + "---|" * len(METRICS))
    for name, values in list(results.items())[1:]:
        print(f"| {name} | {' | '.join(text(column) for column in (values - results['policy']).T)} |")


def tune_fuzzy(seeds):
    print("\nSteady-state error of fuzzy with other values of max_output:\n\n| max_output | steady-state error, px |\n|---|---|")
    for strength in (0.5, 2, 5, 10, 20, STRENGTH):
        print(f"| {strength} | {text(measure({'type': 'fuzzy', 'max_output': strength}, seeds)[:, 0])} |")


def hold_on_bench(seed, out):
    """Estimated distances from the setpoint of a run on the simulated bench, px."""
    return faba.bench(BENCH, arm=True, controller=BenchPolicy, out=out, seed=seed, set=PATIENT).series["distance_px"]


def draw_curve(path):
    import matplotlib

    matplotlib.use("Agg")
    matplotlib.rcParams.update({"svg.hashsalt": "faba", "svg.fonttype": "none"})
    from matplotlib import pyplot

    with open(HERE / "hold_learning.csv") as file:
        rows = list(csv.DictReader(file))
    figure, axes = pyplot.subplots(figsize=(6.4, 3.6), layout="constrained")
    frames = [int(r["frames"]) / 1e6 for r in rows]
    axes.plot(frames, [float(r["mean_distance_px"]) for r in rows], color="#1f5fa8", label="entire episode")
    axes.plot(frames, [float(r["last_third_px"]) for r in rows], color="#b3541e", linestyle="--", label="last third")
    axes.set(xlabel="simulated frames, millions", ylabel="mean distance, px", yscale="log")
    ticks = [2, 5, 10, 20, 50, 100, 200]
    axes.set_yticks(ticks, [str(tick) for tick in ticks])
    axes.minorticks_off()
    axes.legend()
    axes.grid(True, color="#dddddd", linewidth=0.6)
    figure.savefig(path, metadata={"Date": None})


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("--seeds", type=int, default=20, help="number of seeds, default 20")
    a.add_argument("--first", type=int, default=1000, help="first seed, default 1000")
    a.add_argument("--bench", action="store_true", help="also on the simulated bench, 12 s in real time")
    a.add_argument("--fuzzy", action="store_true", help="also other values of max_output of fuzzy")
    a.add_argument("--curve", type=pathlib.Path, help="file for the picture of the learning curve, such as curve.svg")
    o = a.parse_args()
    seeds = range(o.first, o.first + o.seeds)
    compare(seeds)
    if o.fuzzy:
        tune_fuzzy(seeds)
    if o.bench:
        with tempfile.TemporaryDirectory() as folder:
            distance = hold_on_bench(o.first, pathlib.Path(folder) / "run")
        steady = np.sqrt(np.mean(distance[2 * len(distance) // 3 :] ** 2))
        print(f"\nSimulated bench: distance {distance[0]:.0f} px at the start, {distance[-1]:.1f} px at the end, "
              f"{steady:.1f} px rms in the last third.")
    if o.curve:
        draw_curve(o.curve)


if __name__ == "__main__":
    main()
