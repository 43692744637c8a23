#!/usr/bin/python3
"""Does `faba activity` give back the line of eq. 4.1? Videos of four experiments at eight exposures (scenes/exposure.toml), rendered
with the camera's noise, are measured, and so are the same cells without noise. Prints a table and a verdict; keeps them in
bench/results/. A seed takes two minutes.

    bench/exposure.py [--program build/bench/bench_exposure] [--seeds 20] [--out bench/results]

Exits 1 when the goal is not met.
"""

import argparse
import datetime
import json
import math
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
SCENE = HERE.parent / "scenes/exposure.toml"
SHARE, CUTOFF_S = 17 / 20, 60


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--program", type=pathlib.Path, default=HERE.parent / "build/bench/bench_exposure")
    p.add_argument("--seeds", type=int, default=20)
    p.add_argument("--out", type=pathlib.Path, default=HERE / "results")
    o = p.parse_args()
    rows = []
    with subprocess.Popen([str(o.program), str(SCENE), str(o.seeds)], stdout=subprocess.PIPE, text=True) as work:
        for line in work.stdout:
            rows.append(json.loads(line))
            print(f"seed {rows[-1]['seed']} of {o.seeds}", file=sys.stderr, flush=True)
    if work.returncode or len(rows) != o.seeds:
        sys.exit(f"exposure.py: {o.program} failed")

    mean = sum(r["noise_free"]["peak_line"]["slope"] for r in rows) / len(rows)
    inside = near = about_mean = intercepts = 0
    table = "| seed | noise-free slope (s/s) | slope and 95 % interval with noise | cut-off, noise-free and with noise (s) |\n|---|---|---|---|\n"
    for r in rows:
        line, truth = r["noisy"]["peak_line"], r["noise_free"]["peak_line"]["slope"]
        low, high = line["ci95"]
        cutoff, true_cutoff = r["noisy"]["cutoff_s"], r["noise_free"]["cutoff_s"]
        held = low <= truth <= high
        from_, to = line["intercept_ci95"]
        intercepts += from_ <= r["noise_free"]["peak_line"]["intercept"] <= to
        close = cutoff is not None and true_cutoff is not None and abs(cutoff - true_cutoff) <= CUTOFF_S
        inside, near, about_mean = inside + held, near + close, about_mean + (low <= mean <= high)
        table += (f"| {r['seed']} | {truth:.5f} | {line['slope']:.5f} ({low:.5f} to {high:.5f}){'' if held else ' **outside**'} | "
                  f"{true_cutoff}, {cutoff}{'' if close else ' **off**'} |\n")
    wanted = math.ceil(SHARE * len(rows))
    met = inside >= wanted and near >= wanted
    text = "# The line of eq. 4.1 from rendered videos\n\n"
    text += f"{datetime.date.today()}; `bench/exposure.py` made this page.\n\n"
    text += f"Inside the interval: the slope of the same cells without noise in {inside} of {len(rows)}, the mean of all of these in {about_mean};\n"
    text += f"its intercept in {intercepts}.\n"
    text += f"Cut-off within {CUTOFF_S} s: {near} of {len(rows)}. Goal: {wanted} each, {'met' if met else 'NOT MET'}.\n\n{table}"
    print(text)
    o.out.mkdir(parents=True, exist_ok=True)
    (o.out / "exposure.md").write_text(text)
    for r in rows:  # of each seed the conclusions; the videos' peaks are in the program's output
        r["noisy"].pop("peaks", None), r["noise_free"].pop("peaks", None)
    (o.out / "exposure.json").write_text(json.dumps(rows, indent=1) + "\n")
    return 0 if met else 1


sys.exit(main())
