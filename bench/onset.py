#!/usr/bin/python3
"""Tests the onset of `faba activity` on rendered step responses with known truth. Renders responses of the three models at several frame
rates, noise levels and field strengths, and dead samples, and writes bench/results/onset.md. Takes about five minutes.

    bench/onset.py [--program build/faba] [--responses 40] [--dead 20] [--first-seed 1000] [--out bench/results]

The true onset is the time at which the true mean velocity of all cells along the new direction has changed by a tenth of its change
(docs/theory/video.md). For `dipole` it is measured in ten simulations at 240 frames per second, with
as many cells, which obstruct each other at the edge. Cells of `basic` and
`adapted` jump once per iteration: their onset is the start of the first frame interval with the new mean displacement.

Exit status 1 if a goal is not met.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

import h5py
import numpy

HERE = pathlib.Path(__file__).resolve().parent
REVERSAL_S = 1
FRACTION = 0.1
TRUE_RUNS = 10
SCENE = """title = "Onset of a response"
seed = {seed}
duration = "{duration} s"
{exposure}
[scale]
um_per_px = 0.92

[camera]
rate = "{rate} Hz"
sensor = "{sensor}"

[microscope]
cell_diameter = "2.5 um"
contrast = -0.4
exposure_time = "4 ms"
noise = {noise}

[arena]
type = "drop"
view_px = [320, 240]
radius_px = 550
centre_px = [{centre}, 119.5]
{motility}
[[swarm]]
count = {cells}
model = {model}
start = {start}

[controller]
type = "manual"
field = ["{field} uT", "0 T"]

[[controller.segment]]
at = "1 s"
field = ["-{field} uT", "0 T"]

[record]
as_seen = {video}
lossless = {video}
video = {video}
"""
EDGE = '{ type = "edge", direction = "180 deg", visible = true, depth_px = 20 }'
MODELS = {  # model, field in uT; three dipoles with different times of a U-turn
    "basic": ('{ type = "basic", max_speed = 7 }', 115),
    "adapted": ('{ type = "adapted", max_speed = 7 }', 115),
    "dipole, 1 mT": ('{ type = "dipole", preset = "IT-1" }', 1000),
    "dipole, 100 uT": ('{ type = "dipole", preset = "IT-1", speed = "100 um/s", speed_sd = "25 um/s" }', 100),
    "dipole, 60 uT": ('{ type = "dipole", preset = "IT-1", speed = "80 um/s", speed_sd = "20 um/s" }', 60),
}
RATES = (15, 30, 60, 120)
NOISES = (0.008, 0.02, 0.04)
STARTS = (("edge", EDGE, 590, 150), ("uniform", '"uniform"', 160, 1800))  # name, start, centre of the drop, cells


def case(number, first_seed):
    """The settings of one response: all combinations are used about equally often."""
    name = list(MODELS)[number % len(MODELS)]
    model, field = MODELS[name]
    rate = RATES[number // 5 % len(RATES)]
    noise = NOISES[(number + number // 7) % len(NOISES)]
    where, start, centre, cells = STARTS[number // 3 % 2]
    return dict(name=name, where=where, seed=first_seed + number, rate=rate, noise=noise, model=model, field=field, start=start, centre=centre,
                cells=cells, duration=3.5, sensor="frames", video="true", exposure="", motility="")


def dead(number, first_seed):
    """A sample without a response: cells that swim in random directions, or that do not move."""
    c = case(number, first_seed)
    still = number % 2 == 1
    c.update(model='{ type = "dipole", preset = "IT-1"' + (", motile = 0, translational_diffusion = \"0.3 um^2/s\"" if still else "") + " }",
             field=1000, exposure='exposure = "3000 s"', motility='[motility]\ntype = "thesis"\n', name="still" if still else "swimming", rate=RATES[number % 3])
    return c


def run(o, folder, c):
    scene, out = folder / "scene.toml", folder / "run"
    scene.write_text(SCENE.format(**c))
    subprocess.run([str(o.program), "run", str(scene), "--out", str(out), "--force", "--quiet"], check=True, stdout=subprocess.DEVNULL)
    return out


def mean_displacements(out):
    """Times of the frames, and the mean displacement of all cells along +x between them."""
    with h5py.File(out / "tracks.h5") as f:
        x = f["position_px"][:, :, 0]
        return f["t_s"][:], numpy.diff(x.mean(axis=1, dtype=float))


def true_onset(t, d, jumps, rate):
    """`jumps`: whether cells jump once per iteration of 1/15 s, and else swim continuously."""
    wide = max(1, round(rate / 15)) if jumps else max(1, round(rate * 0.02))
    smooth = numpy.convolve(d, numpy.ones(wide) / wide, "same")
    first = numpy.searchsorted(t, REVERSAL_S - 1e-9)
    before = smooth[first - int(0.15 * rate) - 1:first - wide].mean()
    change = smooth[first:].max() - before
    if jumps:
        scale = wide  # an iteration moves a cell in one of `wide` frame intervals
        k = next(k for k in range(first, len(d)) if d[k] - before > FRACTION * scale * change)
        return t[k]
    k = next(k for k in range(first, len(d)) if smooth[k] - before > FRACTION * change)
    low, high = smooth[k - 1] - before, smooth[k] - before
    middle = (t[k - 1] + t[k]) / 2
    return max(REVERSAL_S, middle + (FRACTION * change - low) / (high - low) / rate)


def truth(o, folder, c, known):
    jumps = "dipole" not in c["name"]
    if jumps:
        return true_onset(*mean_displacements(folder / "run"), True, c["rate"])
    key = (c["name"], c["where"])
    if key not in known:
        means = []
        for seed in range(1, TRUE_RUNS + 1):
            t, d = mean_displacements(run(o, folder, dict(c, seed=seed, rate=240, duration=2.5, sensor="positions", video="false")))
            means.append(d)
        known[key] = true_onset(t, numpy.mean(means, axis=0), False, 240)
    return known[key]


def measure(o, out):
    done = subprocess.run([str(o.program), "activity", str(out), "--json"], check=True, capture_output=True, text=True)
    return json.loads(done.stdout)["videos"][0]


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--program", type=pathlib.Path, default=HERE.parent / "build/faba", help="default build/faba")
    p.add_argument("--responses", type=int, default=40, help="number of responses, default 40")
    p.add_argument("--dead", type=int, default=20, help="number of dead samples, default 20")
    p.add_argument("--first-seed", type=int, default=1000, help="seed of the first response, default 1000")
    p.add_argument("--out", type=pathlib.Path, default=HERE / "results", help="folder of the results, default bench/results")
    o = p.parse_args()
    rows, known = [], {}
    inside = early = silent = responding = 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for number in range(o.responses):
            c = case(number, o.first_seed)
            v = measure(o, run(o, folder, c))
            true = truth(o, folder, c, known)
            low, high = v["onset_ci90"] or (None, None)
            held = low is not None and low <= true <= high
            inside, silent = inside + held, silent + (low is None)
            early += v["onset_s"] is not None and (v["onset_s"] < REVERSAL_S or low < REVERSAL_S)
            shown = "no response" if low is None else f"{v['onset_s']:.3f} [{low:.3f}, {high:.3f}]"
            method = v["response"]["method"] if v["response"] else ""
            rows.append(f"| {c['name']} | {c['where']} | {c['rate']} | {c['noise']} | {true:.3f} | {shown} | {method} | {'yes' if held else '**no**'} |")
            print(rows[-1], file=sys.stderr, flush=True)
        for number in range(o.dead):
            c = dead(number, o.first_seed + 500)
            v = measure(o, run(o, folder, c))
            false = v["onset_s"] is not None or v["responds"]
            responding += false
            print("dead", c["name"], c["where"], c["rate"], v["onset_s"], v["response"] and v["response"]["t_statistic"], file=sys.stderr, flush=True)
    goals = [(f"{inside} of {o.responses} 90 % intervals contain the true onset (goal: 80 to 98 %)", 0.8 <= inside / max(o.responses, 1) <= 0.98),
             (f"{early} onsets or intervals start before the reversal (goal: none)", early == 0),
             (f"{o.dead - responding} of {o.dead} dead samples have no response (goal: 19 of 20)", o.dead - responding >= 0.95 * o.dead)]
    text = "# The onset of a response\n\nGenerated by `bench/onset.py`: rendered responses to a field reversal at 1 s, 320 x 240 px, lossless.\n\n"
    text += "".join(f"- {what}: {'met' if met else 'NOT MET'}.\n" for what, met in goals)
    text += f"- {silent} of {o.responses} responses were not detected.\n\n"
    text += "| model | start | rate (Hz) | noise | true onset (s) | measured, 90 % interval (s) | measure | inside |\n|---|---|---|---|---|---|---|---|\n"
    text += "\n".join(rows) + "\n"
    print(text)
    o.out.mkdir(parents=True, exist_ok=True)
    (o.out / "onset.md").write_text(text)
    return 0 if all(met for _, met in goals) else 1


sys.exit(main())
