#!/usr/bin/python3
"""Estimates the magnetic moment of cells from U-turns in rendered videos with `faba moment`, and compares it with the moment that was
simulated. Each case is a culture with its own moment, distribution of moments among cells, size, speed and camera rate, recorded by the
simulated microscope at two or three field strengths with several reversals each. The videos are detected and tracked like real ones. The
size that the study file states deviates from the simulated one by the stated uncertainty. Writes bench/results/uturn.md. Takes a quarter of an hour on two cores.

    bench/uturn.py [--program build/faba] [--cases 40] [--first 1000] [--out bench/results]

Exit status 1 unless the 90 % intervals of 80 to 98 % of the cases contain the moment (32 to 39 of 40), and the median error is below 15 %.
"""

import argparse
import json
import math
import pathlib
import random
import statistics
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent
BOLTZMANN, TEMPERATURE, VISCOSITY = 1.380649e-23, 298.15, 0.89e-3
SIZE_SD = 0.05  # of the stated size
LEGS = 2  # reversals per video


def faba(program, *arguments):
    done = subprocess.run([str(program), *map(str, arguments), "--json"], capture_output=True, text=True, cwd=ROOT)
    if done.returncode != 0:
        sys.exit(f"uturn.py: {' '.join(map(str, arguments))}: {done.stderr.strip()}")
    return json.loads(done.stdout)


def draw(seed):
    """The culture and the protocol of one case: field strengths from kappa = 10 to the one at which a cell turns by 0.4 rad per frame."""
    r = random.Random(seed)
    c = {"seed": seed, "moment": math.exp(r.uniform(math.log(3e-16), math.log(2e-15))), "spread": r.choice([0, 0.1, 0.2]),
         "radius": r.uniform(0.6e-6, 0.9e-6), "speed": r.uniform(40e-6, 120e-6), "rate": r.choice([30, 60, 90])}
    c["stated"] = c["radius"] * math.exp(r.gauss(0, SIZE_SD))
    drag = 8 * math.pi * VISCOSITY * c["radius"] ** 3
    weakest = 10 * BOLTZMANN * TEMPERATURE / c["moment"]
    strongest = min(0.4 * c["rate"] * drag / c["moment"], 3 * weakest)
    number = r.choice([2, 3])
    c["fields"] = [weakest * (strongest / weakest) ** (i / (number - 1)) if strongest > 1.2 * weakest else weakest for i in range(number)]
    c["fields"] = sorted(set(c["fields"]))
    c["drag"] = drag
    return c


def record(program, folder, c, field, number):
    """A rendered run: LEGS reversals, each leg long enough for the turn and an aligned part."""
    rate = c["moment"] * field / c["drag"]
    kappa = c["moment"] * field / (BOLTZMANN * TEMPERATURE)
    leg = 3.5 * math.log(4 * kappa) / (2 * rate)  # half of the cells turn within ln(4 kappa) / (2 rate)
    reversals = [leg * (i + 1) for i in range(LEGS)]
    scene = folder / f"scene-{number}.toml"
    text = f"""duration = "{leg * (LEGS + 1)} s"
[camera]
rate = "{c['rate']} Hz"
[arena]
type = "drop"
radius_px = 900
view_px = [480, 360]
centre_px = [240, 180]
[[swarm]]
count = 750
start = {{ type = "uniform" }}
[swarm.model]
type = "dipole"
moment = {c['moment']}
moment_spread = {c['spread']}
radius = {c['radius']}
speed = {c['speed']}
speed_sd = {0.2 * c['speed']}
viscosity = {VISCOSITY}
temperature = {TEMPERATURE}
[microscope]
cell_diameter = {2 * c['radius']}
[record]
as_seen = true
lossless = true
video = false
tracks = false
[controller]
type = "manual"
field = ["{field} T", "0 T"]
"""
    for i, at in enumerate(reversals):
        text += f'[[controller.segment]]\nat = "{at} s"\nfield = ["{field if i % 2 else -field} T", "0 T"]\n'
    scene.write_text(text)
    out = folder / f"run-{number}"
    faba(program, "run", scene, "--seed", c["seed"] * 10 + number, "--out", out, "--threads", 2)
    return {"file": out, "field": field, "reversals": reversals}


def measure(program, c):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        text = f"[cell]\nradius = {c['stated']}\nsize_sd = {SIZE_SD}\nviscosity = {VISCOSITY}\n"
        for number, field in enumerate(c["fields"]):
            v = record(program, folder, c, field, number)
            text += f'[[video]]\nfile = "{v["file"]}"\nfield = "{v["field"]} T"\nreversals = {v["reversals"]}\n'
        (folder / "study.toml").write_text(text)
        return faba(program, "moment", folder / "study.toml", "--threads", 2)


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--program", type=pathlib.Path, default=ROOT / "build/faba", help="the program, default build/faba")
    p.add_argument("--cases", type=int, default=40, help="number of cases, default 40")
    p.add_argument("--first", type=int, default=1000, help="seed of the first case, default 1000; 1 to 99 were used during development")
    p.add_argument("--out", type=pathlib.Path, default=HERE / "results", help="folder of the results, default bench/results")
    o = p.parse_args()
    rows, errors, rate_errors, inside, good = "", [], [], 0, 0
    for i in range(o.cases):
        c = draw(o.first + i)
        j = measure(o.program.resolve(), c)
        true_rate = c["moment"] / c["drag"]
        m, rate = j["moment_am2"], j["rate_per_t_per_s"]
        fields = ", ".join(f"{1e6 * f:.0f}" for f in c["fields"])
        if m is None:
            rows += f"| {c['seed']} | {c['moment']:.2e} | {fields} | {c['rate']} | - | - | - | 0 | {j['quality']} |\n"
            continue
        errors.append(abs(m["median"] / c["moment"] - 1))
        rate_errors.append(rate["median"] / true_rate - 1)
        holds = m["ci90"][0] <= c["moment"] <= m["ci90"][1]
        inside += holds
        good += j["quality"] == "good"
        rows += (f"| {c['seed']} | {c['moment']:.2e} | {fields} | {c['rate']} | {m['median']:.2e} | {m['ci90'][0]:.2e} to {m['ci90'][1]:.2e}"
                 f"{'' if holds else ' (outside)'} | {100 * rate_errors[-1]:+.1f} % | {j['turns']} | {j['quality']}"
                 f"{''.join(' ' + w['aspect'] for w in j['warnings'])} |\n")
        print(rows.splitlines()[-1], flush=True)
    error, low, high = statistics.median(errors), 0.8 * o.cases, 0.98 * o.cases
    met = low <= inside <= high and error < 0.15
    text = f"""# Magnetic moment from U-turns

Generated by `bench/uturn.py`: {o.cases} cultures with moments of 3e-16 to 2e-15 A m^2, rendered by the simulated microscope at two or three
field strengths and tracked like real videos. Seeds from {o.first}; others were used during development.

| | result | goal |
|---|---|---|
| 90 % intervals that contain the moment | {inside} of {o.cases} | {low:.0f} to {math.floor(high)}: {"met" if low <= inside <= high else "NOT MET"} |
| median error of the moment | {100 * error:.1f} % | below 15 %: {"met" if error < 0.15 else "NOT MET"} |
| error of the turning rate, without the uncertainty of the size | median {100 * statistics.median(rate_errors):+.1f} %, rms {100 * math.sqrt(statistics.mean(e * e for e in rate_errors)):.1f} % | |
| quality `good` | {good} of {o.cases} | |

| seed | moment, A m^2 | fields, uT | frames/s | estimate | 90 % interval | error of the rate | turns | quality |
|---|---|---|---|---|---|---|---|---|
{rows}"""
    print(text, end="")
    o.out.mkdir(parents=True, exist_ok=True)
    (o.out / "uturn.md").write_text(text)
    return 0 if met else 1


sys.exit(main())
