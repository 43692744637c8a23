#!/usr/bin/python3
"""Tests whether `faba identify` recovers known models and parameters: renders experiments with random parameters and identifies them
from their videos.

Each experiment is a drop, of which an arc is in view, with a swarm at its edge and six field segments in alternating directions along a
line. Sampled at random are the model (basic, adapted or dipole), its speed or maximum displacement, 150 to 800 cells, camera noise, air
exposure time, size and position of the drop, and the line. The study file gives the scale, the field strength and the air exposure
time; the run directory has the times of the field reversals. Edge, illumination, cells, their number and their initial positions are
measured. Prints a table and a verdict for every goal, and writes them to bench/results/.

    bench/recovery.py [--program build/faba] [--experiments 40] [--simulations 300] [--seed 1] [--keep DIR] [--out bench/results]

Experiments are stored in DIR (default build/recovery), results in recovery.json of --out. A second call resumes from these files, also on
another machine; delete both when the program has changed. Exit status 1 if a goal is not met.
--reduced runs two experiments with the two models of the thesis in a temporary folder, for the test suite.
"""

import argparse
import datetime
import json
import math
import pathlib
import random
import statistics
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
WIDTH, HEIGHT, UM_PER_PX, FIELD = 320, 240, 1.16, 115e-6
SEGMENT_S, FIRST_S, SEGMENTS = 2.0, 1.0, 6
MODELS = ("basic", "adapted", "dipole")
RANGE = {"basic": (1, 20), "adapted": (1, 20), "dipole": (20, 300)}
TRUTH = {"basic": (3, 12), "adapted": (3, 12), "dipole": (60, 250)}


def draw(number, o):
    r = random.Random(f"recovery {o.seed} {number}")
    model = o.models[number % len(o.models)]
    value = r.uniform(*TRUTH[model])
    # The models of the thesis draw integers up to the parameter rounded to an integer.
    return {"number": number, "model": model, "value": round(value, 2) if model == "dipole" else round(value), "cells": r.randint(150, 800),
            "noise": round(r.uniform(0.004, 0.02), 4), "exposure": r.randint(0, 300), "radius": r.randint(300, 700),
            "side": r.choice((0, 90, 180, 270)), "inset": r.randint(15, 45), "tilt": round(r.uniform(-10, 10), 1),
            "contrast": round(r.uniform(-0.6, -0.3), 2)}


def drop_centre(t):
    """Centre of the drop for which its edge is `inset` px from the side of the picture where the swarm starts."""
    along = t["radius"] + t["inset"]
    return {0: (along, HEIGHT / 2), 180: (WIDTH - along, HEIGHT / 2), 90: (WIDTH / 2, along), 270: (WIDTH / 2, HEIGHT - along)}[t["side"]]


def scene(t):
    # Angles in the image frame: cells swim away from the edge at `side` and back. y points up in the world; cells are south-seeking.
    angle = math.radians(t["side"] + t["tilt"])

    def field(sign):
        b = -sign * FIELD * 1e6
        return f'["{b * math.cos(angle):.4f} uT", "{-b * math.sin(angle):.4f} uT"]'

    model = f'{{ type = "{t["model"]}", max_speed = {t["value"]} }}'
    if t["model"] == "dipole":
        model = f'{{ type = "dipole", speed = "{t["value"]} um/s", speed_sd = "{0.2 * t["value"]:.3f} um/s" }}'
    x, y = drop_centre(t)
    lines = [f'duration = "{FIRST_S + SEGMENTS * SEGMENT_S} s"', f'exposure = "{t["exposure"]} s"', 'motility = "thesis"',
             f"[scale]\num_per_px = {UM_PER_PX}", '[camera]\nrate = "15 Hz"',
             f'[microscope]\ncell_diameter = "2.5 um"\nnoise = {t["noise"]}\ncontrast = {t["contrast"]}',
             f'[arena]\ntype = "drop"\nview_px = [{WIDTH}, {HEIGHT}]\nradius_px = {t["radius"]}\ncentre_px = [{x}, {y}]',
             f'[[swarm]]\ncount = {t["cells"]}\nmodel = {model}',
             f'start = {{ type = "edge", direction = "{-(t["side"] + 180)} deg", visible = true }}',
             f'[controller]\ntype = "manual"\nfield = {field(-1)}']
    for k in range(SEGMENTS):
        lines.append(f'[[controller.segment]]\nat = "{FIRST_S + k * SEGMENT_S} s"\nfield = {field(1 if k % 2 == 0 else -1)}')
    return "\n".join(lines + ["[record]\nas_seen = true\nlossless = true\ntracks = false\n"])


def main_parameter(model):
    return "swarm[0].model.speed" if model == "dipole" else "swarm[0].model.max_speed"


def study(t, o):
    # The test suite has no time for more simulations.
    nuisances = ["nuisances = false"] if o.reduced else []
    lines = nuisances + [f"seed = {t['number'] + 1}", f"simulations = {o.simulations}", f"legacy = {str(not o.reduced).lower()}", 'boundary = "drop"', f'field_strength = "{FIELD * 1e6} uT"',
             "[scene]", 'motility = "thesis"', "[[video]]", 'file = "film"', f'exposure = "{t["exposure"]} s"']
    for m in o.models:
        low, high = RANGE[m]
        if m == "dipole":
            free = (f'"{main_parameter(m)}" = ["{low} um/s", "{high} um/s"], '
                    '"swarm[0].model.speed_sd" = ["0 um/s", "120 um/s"]')
        else:
            free = f'"{main_parameter(m)}" = [{low}, {high}]'
        lines += ["[[model]]", f'name = "{m}"', f'type = "{m}"', f'free = {{ {free}, "swarm[0].count" = [50, 1200] }}']
    return "\n".join(lines) + "\n"


def call(program, *words, cwd):
    done = subprocess.run([str(program), *words], cwd=cwd, capture_output=True, text=True)
    return done.returncode, done.stdout, done.stderr


def experiment(t, o):
    """Renders and identifies one experiment; returns a dictionary for the table."""
    folder = o.keep / f"{o.seed}-{t['number']:02d}"
    folder.mkdir(parents=True, exist_ok=True)
    answer = folder / "out/identify.json"
    if not answer.exists():
        (folder / "scene.toml").write_text(scene(t))
        (folder / "study.toml").write_text(study(t, o))
        if not (folder / "film/manifest.json").exists():
            code, _, error = call(o.program, "run", "scene.toml", "--seed", str(1000 * o.seed + t["number"]), "--quiet", "--force",
                                  "--out", "film", cwd=folder)
            if code:
                sys.exit(f"experiment {t['number']}: {error}")
        code, _, error = call(o.program, "identify", "study.toml", "--quiet", "--out", "out", cwd=folder)
        if code:
            return {**t, "failed": error.strip().splitlines()[-1]}
    found = json.loads(answer.read_text())
    fit = next(m for m in found["models"] if m["name"] == t["model"])
    if "failed" in fit:
        return {**t, "failed": fit["failed"]}
    unit = 1e-6 if t["model"] == "dipole" else 1
    p = fit["parameters"][main_parameter(t["model"])]
    low, high = (x / unit for x in p["ci90"])
    count = fit["parameters"]["swarm[0].count"]
    answer = {**t, "found": p["median"] / unit, "low": low, "high": high, "cells_found": count["median"], "cells_ci90": count["ci90"],
              "best": found["best"], "evidence": found["evidence"], "fit_p": fit["fit_p"]}
    if not o.reduced:
        legacy = next(m for m in found["legacy"] if m["name"] == t["model"])
        answer |= {"legacy": legacy["zero"] / unit, "legacy_means_nothing": legacy["invalid_reason"] is not None}
    return answer


def row(x):
    truth = f"| {x['number']} | {x['model']} | {x['value']:g} | {x['cells']} | {x['noise'] * 255:.1f} | {x['exposure']} "
    if "failed" in x:
        return truth + f"| {x['failed']} | | | | | |"
    inside = "" if x["low"] <= x["value"] <= x["high"] else " outside"
    found = truth + (f"| {x['found']:.3g} | {x['low']:.3g} to {x['high']:.3g}{inside} | {100 * (x['found'] / x['value'] - 1):+.1f} % "
                     f"| {x['best']} | {x['evidence']} |")
    if "legacy" not in x:
        return found + " |"
    return found + f" {100 * (x['legacy'] / x['value'] - 1):+.0f} %{' (unreliable)' if x['legacy_means_nothing'] else ''} |"


def reduced(o):
    """Two experiments: each error must be below 20 %, and at least one 90 % interval must contain the true value (probability 99 %)."""
    with tempfile.TemporaryDirectory() as keep:
        o.keep, o.simulations, o.models = pathlib.Path(keep), 120, MODELS[:2]
        rows = [experiment(draw(number, o), o) for number in range(2)]
    for x in rows:
        print(row(x))
    sys.exit(0 if all("found" in x and abs(x["found"] / x["value"] - 1) < 0.2 for x in rows)
             and any(x["low"] <= x["value"] <= x["high"] for x in rows) else 1)


def keep(rows, o):
    o.out.mkdir(parents=True, exist_ok=True)
    file = o.out / "recovery.json"
    file.with_suffix(".tmp").write_text(json.dumps({"experiments": rows, "simulations": o.simulations, "seed": o.seed}, indent=1) + "\n")
    file.with_suffix(".tmp").rename(file)


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("--program", type=pathlib.Path, default=HERE.parent / "build/faba", help="the program, default build/faba")
    a.add_argument("--experiments", type=int, default=40, help="number of experiments, default 40")
    a.add_argument("--simulations", type=int, default=300, help="number of simulations per model, default 300")
    a.add_argument("--seed", type=int, default=1, help="seed of the random parameters, default 1")
    a.add_argument("--keep", type=pathlib.Path, default=HERE.parent / "build/recovery", help="folder of the experiments")
    a.add_argument("--out", type=pathlib.Path, default=HERE / "results", help="folder of the results, default bench/results")
    a.add_argument("--reduced", action="store_true", help="two experiments, for the test suite")
    o = a.parse_args()
    o.program, o.keep, o.models = o.program.resolve(), o.keep.resolve(), MODELS
    if o.reduced:
        reduced(o)

    rows, table = [], []

    def say(line):
        table.append(line)
        print(line, flush=True)

    say("| | model | true value | cells | noise, grey levels | air exposure, s | estimate | 90 % interval | error | best model | evidence | error of the rule of the thesis |")
    say("|---|---|---|---|---|---|---|---|---|---|---|---|")
    done = {}
    if (o.out / "recovery.json").exists():
        before = json.loads((o.out / "recovery.json").read_text())
        if (before["simulations"], before["seed"]) == (o.simulations, o.seed):
            done = {x["number"]: x for x in before["experiments"]}
    for number in range(o.experiments):
        rows.append(done.get(number) or experiment(draw(number, o), o))
        say(row(rows[-1]))
        if number not in done:
            keep(rows, o)
    good = [x for x in rows if "failed" not in x]
    clear = [x for x in good if x["evidence"] == "clear"]
    covered = sum(x["low"] <= x["value"] <= x["high"] for x in good)
    error = statistics.median(abs(x["found"] / x["value"] - 1) for x in good) if good else math.nan
    legacy = statistics.median(abs(x["legacy"] / x["value"] - 1) for x in good) if good else math.nan
    named = sum(x["best"] == x["model"] for x in clear)
    goals = [("identified", len(good), len(rows), len(good) == len(rows)),
             ("90 % intervals that contain the true value (80 to 98 %)", covered, len(good), 0.8 * len(good) <= covered <= 0.98 * len(good)),
             ("median error of the main parameter (below 5 %)", f"{100 * error:.1f} %", "", error < 0.05),
             ("evidence is clear (at least 50 %)", len(clear), len(good), 2 * len(clear) >= len(good)),
             ("best model is the true model if the evidence is clear (at least 90 %)", named, len(clear), named >= 0.9 * len(clear))]
    verdict = [f"- {what}: {n}{f' of {of}' if of != '' else ''}{'' if met else ' NOT MET'}" for what, n, of, met in goals]
    for m in o.models:
        errors = [abs(x["found"] / x["value"] - 1) for x in good if x["model"] == m]
        if errors:
            verdict.append(f"- error for {m}: median {100 * statistics.median(errors):.1f} %, maximum {100 * max(errors):.0f} %")
    verdict.append(f"- median error of the rule of the thesis: {100 * legacy:.0f} %; the program reports its result as unreliable for "
                   f"{sum(x['legacy_means_nothing'] for x in good)} of {len(good)} experiments")
    print("\n" + "\n".join(verdict))
    o.out.mkdir(parents=True, exist_ok=True)
    (o.out / "recovery.md").write_text(
        "# Identification of rendered experiments with known parameters\n\n"
        f"{datetime.date.today()}, {o.simulations} simulations per model, seed {o.seed}. Generated by `bench/recovery.py`.\n\n"
        + "\n".join(verdict) + "\n\n" + "\n".join(table) + "\n")
    sys.exit(0 if all(g[3] for g in goals) else 1)


if __name__ == "__main__":
    main()
