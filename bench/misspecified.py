#!/usr/bin/python3
"""Tests whether `faba identify` gives confident wrong answers when no candidate is the true model.

Each experiment is a rendered drop with a swarm of dipoles of 120 um/s in six field segments, with one property that the candidates basic,
adapted and dipole do not have (see CASES), or with none. Sampled at random are the number of cells, camera noise, size and side of the
drop, and the contrast; the study file states the field strength and the scale. A misspecified experiment passes if the 90 % interval of
the speed of dipole contains 120 um/s (of two populations: their mean, 88 um/s), or the evidence is not "clear", or a warning names the
aspect. A well-specified experiment passes if there is no warning. Writes misspecified.md and misspecified.json to bench/results/.

    bench/misspecified.py [--program build/faba] [--seeds 10] [--first 1] [--well 20] [--cases motile,tumbling] [--simulations 300]
                          [--keep DIR] [--out bench/results]

Experiments are stored in DIR (default build/misspecified), results in misspecified.json of --out. A second call resumes from these
files; delete both when the program has changed. Exit status 1 if a goal is not met.
"""

import argparse
import datetime
import json
import os
import pathlib
import random
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from recovery import FIRST_S, SEGMENT_S, SEGMENTS, UM_PER_PX, call, scene  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent
SPEED = 120.0
SD = 0.2 * SPEED
FIELD_UT = 115

# Of each case: what the cells or the experiment do, keys of the model, further swarms as (fraction, keys of the model, keys of the swarm),
# factor of the field strength in the study, and aspects that name it. `shift` moves the picture, px/s.
CASES = {
    "none": ("well-specified", {}, None, 1, ()),
    "motile": ("half of the cells is not motile", {"motile": 0.5}, None, 1, ("motile_fraction",)),
    "tumbling": ("the cells tumble, 2 per s", {"tumble_rate": "2 1/s"}, None, 1, ("turning",)),
    "reversing": ("the cells reverse their motors, 0.5 per s", {"reversal_rate": "0.5 1/s"}, None, 1, ("turning",)),
    "populations": ("40 % of the cells have a speed of 40 um/s", {}, (0.4, {"speed": "40 um/s", "speed_sd": "8 um/s"}, {}), 1,
                    ("populations", "speed_spread")),
    "polarity": ("25 % of the cells swim in the opposite direction", {}, (0.25, {}, {"polarity": '"north"'}), 1, ("polarity",)),
    "field": ("the study states a third of the field strength", {}, None, 1 / 3, ("field_strength",)),
}


def truth_of(case):
    """True value of the parameter "speed", the mean over all motile cells: its spread is free."""
    if case != "populations":
        return SPEED
    fraction, other, _ = CASES[case][2]
    return (1 - fraction) * SPEED + fraction * float(other["speed"].split()[0])


def draw(case, seed):
    r = random.Random(f"misspecified {case} {seed}")
    return {"case": case, "number": seed, "model": "dipole", "value": SPEED, "cells": r.randint(200, 500),
            "noise": round(r.uniform(0.004, 0.015), 4), "exposure": 0, "radius": r.randint(300, 600), "side": r.choice((0, 90, 180, 270)),
            "inset": r.randint(15, 45), "tilt": round(r.uniform(-10, 10), 1), "contrast": round(r.uniform(-0.6, -0.35), 2)}


def keys(values):
    return "".join(f', {k} = {json.dumps(v)}' for k, v in values.items())


def scene_of(t):
    """The scene of recovery.py without the effect of air, with the property of the case."""
    _, model, second, _, _ = CASES[t["case"]]
    text = scene(t).replace('motility = "thesis"\n', "")
    plain = f'speed = "{SPEED} um/s", speed_sd = "{SD:.3f} um/s"'
    assert plain in text
    text = text.replace(plain, plain + keys(model))
    if second is None:
        return text
    fraction, other, swarm = second
    count = round(fraction * t["cells"])
    text = text.replace(f'count = {t["cells"]}', f'count = {t["cells"] - count}')
    values = {"speed": f"{SPEED} um/s", "speed_sd": f"{SD} um/s", **other}
    start = next(line for line in text.splitlines() if line.startswith("start = "))
    more = "".join(f"{k} = {v}\n" for k, v in swarm.items())
    added = f'[[swarm]]\ncount = {count}\n{more}model = {{ type = "dipole"{keys(values)} }}\n{start}\n'
    return text.replace("[controller]\n", added + "[controller]\n")


def video_of(t):
    """The run directory; with a wrong field strength the bare video, because a run directory has the true one."""
    if CASES[t["case"]][3] == 1:
        return ["[[video]]", 'file = "film"']
    lines = ["[[video]]", 'file = "film/video.avi"', f"um_per_px = {UM_PER_PX}"]
    for k in range(SEGMENTS):
        start = FIRST_S + k * SEGMENT_S
        lines += ["[[video.segment]]", f'from = "{start} s"', f'to = "{start + SEGMENT_S} s"',
                  f"direction = {(t['side'] + t['tilt'] + 180 * (k % 2)) % 360:g}"]
    return lines


def study_of(t, o):
    field = FIELD_UT * CASES[t["case"]][3]
    lines = [f"seed = {t['number']}", f"simulations = {o.simulations}", 'boundary = "drop"', f'field_strength = "{field:.4g} uT"',
             *video_of(t)]
    for m, free in (("basic", '"swarm[0].model.max_speed" = [1, 20]'), ("adapted", '"swarm[0].model.max_speed" = [1, 20]'),
                    ("dipole", '"swarm[0].model.speed" = ["20 um/s", "300 um/s"]')):
        if m in o.models:
            lines += ["[[model]]", f'name = "{m}"', f'type = "{m}"', f"free = {{ {free} }}"]
    return "\n".join(lines) + "\n"


def experiment(t, o):
    """Renders and identifies one experiment; returns a dictionary for the table."""
    folder = o.keep / f"{t['case']}-{t['number']:02d}"
    folder.mkdir(parents=True, exist_ok=True)
    answer = folder / "out/identify.json"
    if not answer.exists():
        (folder / "scene.toml").write_text(scene_of(t))
        (folder / "study.toml").write_text(study_of(t, o))
        if not (folder / "film/manifest.json").exists():
            code, _, error = call(o.program, "run", "scene.toml", "--seed", str(7000 + t["number"]), "--quiet", "--force", "--out", "film",
                                  cwd=folder)
            if code:
                sys.exit(f"{folder.name}: {error}")
        code, _, error = call(o.program, "identify", "study.toml", "--quiet", "--threads", str(o.threads), "--out", "out", cwd=folder)
        if code:
            return {**t, "failed": error.strip().splitlines()[-1]}
    found = json.loads(answer.read_text())
    fit = next(m for m in found["models"] if m["name"] == "dipole")
    best = next(m for m in found["models"] if m["name"] == found["best"])
    if "failed" in fit:
        return {**t, "failed": fit["failed"]}
    p = fit["parameters"]["swarm[0].model.speed"]
    low, high = (1e6 * x for x in p["ci90"])
    aspects = sorted({w["aspect"] for w in found["warnings"]})
    inside, right = low <= truth_of(t["case"]) <= high, bool(set(aspects) & set(CASES[t["case"]][4]))
    passed = not aspects if t["case"] == "none" else inside or found["evidence"] != "clear" or right
    return {**t, "found": 1e6 * p["median"], "low": low, "high": high, "best": found["best"], "evidence": found["evidence"],
            "fit_p": best["fit_p"], "aspects": aspects, "inside": inside, "named": right, "passed": passed}


def row(x):
    start = f"| {x['case']} | {x['number']} | {x['cells']} "
    if "failed" in x:
        return start + f"| {x['failed']} | | | | | |"
    return start + (f"| {x['found']:.0f} | {x['low']:.0f} to {x['high']:.0f}{'' if x['inside'] else ' outside'} | {x['best']} "
                    f"| {x['evidence']} | {x['fit_p']:.2g} | {', '.join(x['aspects']) or '-'} | {'yes' if x['passed'] else 'NO'} |")


def summary(case, rows):
    good = [x for x in rows if "failed" not in x]
    passed = sum(x["passed"] for x in good)
    goal = (19 if case == "none" else 9) / (20 if case == "none" else 10)
    met = passed >= goal * len(rows)
    return met, (f"| {CASES[case][0]} | {len(rows)} | {sum(x['inside'] for x in good)} | {sum(x['evidence'] != 'clear' for x in good)} "
                 f"| {sum(x['named'] for x in good)} | {sum(bool(x['aspects']) for x in good)} | {passed}{'' if met else ' NOT MET'} |")


def write(rows, o):
    cases = [c for c in CASES if any(x["case"] == c for x in rows)]
    results = [summary(c, [x for x in rows if x["case"] == c]) for c in cases]
    lines = ["# Identification of experiments that no candidate describes", "",
             f"{datetime.date.today()}, {o.simulations} simulations per model, candidates {', '.join(o.models)}. Generated by "
             "`bench/misspecified.py`. The true cells are dipoles of 120 um/s.", "",
             "Passed: the 90 % interval of the speed contains the true value (of two populations: the mean of all cells, 88 um/s), or the evidence is not \"clear\", or a warning names the "
             "aspect (goal: 9 of 10 experiments); well-specified: no warning (goal: 19 of 20).", "",
             "| case | experiments | interval contains the truth | evidence not clear | aspect named | with warnings | passed |",
             "|---|---|---|---|---|---|---|"] + [line for _, line in results]
    lines += ["", "| case | seed | cells | speed, um/s | 90 % interval | best model | evidence | fit p | warnings | passed |",
              "|---|---|---|---|---|---|---|---|---|---|"] + [row(x) for x in rows]
    o.out.mkdir(parents=True, exist_ok=True)
    (o.out / "misspecified.md").write_text("\n".join(lines) + "\n")
    file = o.out / "misspecified.json"
    file.with_suffix(".tmp").write_text(json.dumps({"experiments": rows, "simulations": o.simulations, "models": o.models}, indent=1) + "\n")
    file.with_suffix(".tmp").rename(file)
    return all(met for met, _ in results)


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("--program", type=pathlib.Path, default=HERE.parent / "build/faba", help="the program, default build/faba")
    a.add_argument("--seeds", type=int, default=10, help="experiments of each case, default 10")
    a.add_argument("--first", type=int, default=1, help="first seed, default 1")
    a.add_argument("--well", type=int, default=20, help="well-specified experiments, default 20")
    a.add_argument("--cases", default=",".join(CASES), help="cases, default all")
    a.add_argument("--models", default="basic,adapted,dipole", help="candidates, default basic,adapted,dipole")
    a.add_argument("--simulations", type=int, default=300, help="number of simulations per model, default 300")
    a.add_argument("--threads", type=int, default=os.cpu_count(), help="threads, default all")
    a.add_argument("--keep", type=pathlib.Path, default=HERE.parent / "build/misspecified", help="folder of the experiments")
    a.add_argument("--out", type=pathlib.Path, default=HERE / "results", help="folder of the results, default bench/results")
    o = a.parse_args()
    o.program, o.keep, o.models = o.program.resolve(), o.keep.resolve(), o.models.split(",")
    done = {}
    if (o.out / "misspecified.json").exists():
        before = json.loads((o.out / "misspecified.json").read_text())
        if (before["simulations"], before["models"]) == (o.simulations, o.models):
            done = {(x["case"], x["number"]): x for x in before["experiments"]}
    met = True
    # Seed by seed, so that an interrupted run has experiments of all cases.
    for seed in range(o.first, o.first + max(o.seeds, o.well)):
        for case in o.cases.split(","):
            if seed >= o.first + (o.well if case == "none" else o.seeds) or (case, seed) in done:
                continue
            x = done[case, seed] = experiment(draw(case, seed), o)
            print(row(x), flush=True)
            met = write(sorted(done.values(), key=lambda y: (list(CASES).index(y["case"]), y["number"])), o)
    sys.exit(0 if met else 1)


if __name__ == "__main__":
    main()
