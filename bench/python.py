#!/usr/bin/python3
"""Measures the Python package against the loop in C++ and the studies of the program, in turn: turn(), a controller in Python, simulate(),
and 64 worlds of Hold-v0. Checks that the results are equal. Writes bench/results/python.md.

    bench/python.py [--rounds 5] [--gymnasium FOLDER] [--out bench/results]

Needs build/python (make python) and the target bench_python. --gymnasium: a folder with Gymnasium, default ../shared/clients/gymnasium;
without Gymnasium the environments are not measured, which the table states.
"""

import argparse
import datetime
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent
sys.path[:0] = [str(ROOT / "build/python"), str(ROOT / "tests/python")]

import numpy as np  # noqa: E402
from proportional import Proportional  # noqa: E402

import faba  # noqa: E402

LOOP = """
title = "500 cells"
seed = 1
duration = "100 s"
camera = { rate = "60 Hz" }
arena = { type = "drop", radius_px = 220 }
controller = { type = "proportional" }
reference = { type = "hold", setpoint_px = [400, 240] }
[[swarm]]
count = 500
model = { type = "dipole", preset = "IT-1" }
start = { type = "disc", centre_px = [200, 240], radius_px = 30 }
"""
FRAMES, WORLDS = 600, 64


def best_of(rounds, *measured):
    """The shortest time of each function, measured in turn."""
    best = [float("inf")] * len(measured)
    for _ in range(rounds):
        for i, one in enumerate(measured):
            best[i] = min(best[i], one())
    return best


class Bench:
    def __init__(self, o, folder):
        self.o, self.folder, self.rows, self.wrong = o, folder, [], []

    def row(self, what, value, goal, unit=""):
        met = "" if goal is None else "met" if (value >= goal[1] if goal[0] == ">=" else value <= goal[1]) else "**not met**"
        self.rows.append(f"| {what} | {value:.3g}{unit} | {'' if goal is None else f'{goal[0]} {goal[1]:g}{unit}'} | {met} |")

    def check(self, what, equal):
        if not equal:
            self.wrong.append(what)

    def native(self, scene, frames, processor=False, copies=1):
        """Time of a frame of the loop in C++, the mean of `copies` processes at the same time."""
        path = self.folder / "scene.toml"
        path.write_text(scene)
        command = [ROOT / "build/bench/bench_python", path, str(frames), "1"]
        running = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for _ in range(copies)]
        out = [one.communicate()[0].split() for one in running]
        self.hash = out[0][2]
        return sum(float(o[0 if processor else 1]) for o in out) / copies

    def turned(self, controller=None):
        s = faba.Simulation(LOOP, controller=controller)
        s.turn()
        started = time.process_time()
        for _ in range(FRAMES):
            s.turn()
        elapsed = (time.process_time() - started) / FRAMES
        self.check("state hash of turn()", s.state_hash == self.hash)
        return elapsed

    def loop(self):
        native, turned, mine = best_of(self.o.rounds, lambda: self.native(LOOP, FRAMES, True), self.turned, lambda: self.turned(Proportional()))
        self.row("500 cells, processor time of a frame of the loop in C++, us", 1e6 * native, None)
        self.row("turn() over the loop in C++", turned / native, ("<=", 1.05))
        self.row("a controller in Python, per cycle, us (the law `proportional`)", 1e6 * (mine - turned), ("<=", 60))

    def batch(self):
        scene = self.folder / "batch.toml"
        scene.write_text(LOOP.replace('"100 s"', '"1.5 s"'))
        study = self.folder / "study.toml"
        study.write_text('scene = "batch.toml"\nseeds = 2000\n[[controller]]\ntype = "proportional"\n')
        values = {}

        def by_program():
            started = time.perf_counter()
            subprocess.run([ROOT / "build/faba", "compare-controllers", study, "--out", self.folder / "study", "--quiet", "--force"], check=True)
            elapsed = time.perf_counter() - started
            result = json.loads((self.folder / "study/controllers.json").read_text())
            values["program"] = result["combinations"][0]["metrics"]["steady_rms_px"]["mean"]
            subprocess.run(["rm", "-r", self.folder / "study"], check=True)
            return elapsed

        def by_package():
            started, cpu = time.perf_counter(), time.process_time()
            result = faba.simulate(scene, {"swarm[0].model.speed": np.full(2000, 186e-6)}, 1, "steady_rms_px")
            elapsed = time.perf_counter() - started
            values["cores"] = (time.process_time() - cpu) / elapsed
            self.check("shape of simulate()", result.shape == (2000, 1))
            seeds = faba.simulate(scene, {}, list(range(1, 101)), "steady_rms_px")
            values["package"] = float(seeds.mean())
            return elapsed

        program, package = best_of(max(2, self.o.rounds // 2), by_program, by_package)
        self.check("mean of simulate() and of the study", abs(values["package"] / values["program"] - 1) < 0.2)
        self.row("2000 sets of 500 cells, 90 frames: simulate() over the study of the program", package / program, ("<=", 1.1))
        self.row("cores in use", values["cores"], None)

    def worlds(self):
        sys.path.append(str(self.o.gymnasium))
        try:
            import gymnasium
        except ImportError as e:
            self.rows.append(f"| environments | not measured: {e} | | |")
            return
        from faba import environments

        scene = json.loads(json.dumps(environments._HOLD))
        # The same currents as those of the actions below, so that the cells are in equal places.
        scene.update(duration=100.0, seed=1, controller={"type": "manual", "current": [0.0, 0.0]})
        del scene["reference"]
        native_scene = toml_of(scene)
        threads = os.cpu_count()
        frames = 300
        envs = gymnasium.make_vec("faba/Hold-v0", num_envs=WORLDS, duration="100 s", randomise={})
        single = [gymnasium.make("faba/Hold-v0", duration="100 s", disable_env_checker=True) for _ in range(WORLDS)]
        action = np.zeros((WORLDS, 2), np.float32)

        def native_vector():
            envs.reset(seed=1)
            started = time.perf_counter()
            for _ in range(frames):
                envs.step(action)
            return (time.perf_counter() - started) / frames / WORLDS

        def python_loop():
            for env in single:
                env.reset(seed=1)
            started = time.perf_counter()
            for _ in range(30):
                for env in single:
                    env.step(action[0])
            return (time.perf_counter() - started) / 30 / WORLDS

        one, each, vector, loop = best_of(
            self.o.rounds,
            lambda: self.native(native_scene, frames),
            lambda: self.native(native_scene, frames, copies=threads),
            native_vector,
            python_loop,
        )
        self.row("300 cells, frames per second of the loop in C++, one core, the others idle", 1 / one, None)
        self.row(f"the same loop on each of {threads} cores, per core", 1 / each, None)
        self.row(f"{WORLDS} worlds in one VectorEnv, frames per second", 1 / vector, None)
        self.row(f"VectorEnv over {threads} cores times the loop per core", each / (vector * threads), (">=", 0.9))
        self.row(f"VectorEnv over {threads} cores times the loop with idle cores", one / (vector * threads), None)
        self.row(f"Python loop over {WORLDS} environments, frames per second", 1 / loop, None)


def toml_of(scene):
    """The scene as TOML: dotted tables of plain values."""

    def value(v):
        if isinstance(v, dict):
            return "{ " + ", ".join(f"{k} = {value(x)}" for k, x in v.items()) + " }"
        if isinstance(v, list):
            return "[" + ", ".join(value(x) for x in v) + "]"
        return json.dumps(v)

    return "".join(f"{k} = {value(v)}\n" for k, v in scene.items())


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("--rounds", type=int, default=5, help="rounds of each measurement, default 5")
    a.add_argument("--gymnasium", type=pathlib.Path, default=ROOT.parent / "shared/clients/gymnasium", help="a folder with Gymnasium")
    a.add_argument("--out", type=pathlib.Path, default=HERE / "results", help="folder of the results, default bench/results")
    o = a.parse_args()
    o.out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(o, pathlib.Path(folder))
        bench.loop()
        bench.batch()
        bench.worlds()
    text = f"""# The Python package against C++

{datetime.date.today()}, {os.cpu_count()} cores, shortest of {o.rounds} rounds in turn. Generated by `bench/python.py`.

| | | goal | |
|---|---|---|---|
""" + "\n".join(bench.rows) + "\n"
    (o.out / "python.md").write_text(text)
    print(text)
    for what in bench.wrong:
        print(f"python.py: WRONG: {what}", file=sys.stderr)
    sys.exit(1 if bench.wrong else 0)


if __name__ == "__main__":
    main()
