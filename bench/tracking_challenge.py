#!/usr/bin/python3
"""Measures of the ISBI Particle Tracking Challenge (Chenouard et al., Nature Methods 11:281, 2014) on videos of the simulated microscope.

Nine videos of 256 x 256 px and 50 frames: three densities and three noise levels, cells that swim in random directions and cross each
other. Each is tracked by `faba track`; the same detections are linked by a nearest-neighbour baseline: pairs of spots in successive
frames, the nearest first, within the same reach, without prediction and without gaps. Both keep tracks of at least three detections.

Definitions of the paper, with a gate of 5 px: the distance of two tracks is the sum over the frames of their distance, at most the gate,
and the gate where one of them is absent. The found tracks are assigned to the true ones, or none, with the minimum total distance.
alpha: 1 - distance / (distance with no tracks at all). beta: alpha reduced by the spurious tracks. JSC: Jaccard index of positions; a
position is matched when its track is assigned and it is inside the gate. JSC of tracks: the same for tracks. RMSE: of matched positions.

    bench/tracking_challenge.py [--program build/faba] [--seeds 1] [--out bench/results]

Exit status 1 when the baseline has the higher mean alpha, beta or JSC.
"""

import argparse
import csv
import datetime
import json
import pathlib
import subprocess
import sys
import tempfile

import h5py
import numpy

HERE = pathlib.Path(__file__).resolve().parent
SCENE = """title = "Crossing cells"
duration = "{duration} s"

[camera]
rate = "15 Hz"
sensor = "frames"

[microscope]
cell_diameter = "2.5 um"
contrast = -0.4
exposure_time = "1 ms"
noise = {noise}

[arena]
type = "drop"        # larger than the view: cells enter and leave
radius_px = {radius}
centre_px = [128, 128]
view_px = [256, 256]

[[swarm]]
count = {cells}
model = {{ type = "dipole", speed = "60 um/s", speed_sd = "12 um/s" }}
start = "uniform"

[exclusion]
order = "none"       # cells cross each other

[controller]
type = "manual"

[record]
as_seen = true
lossless = true
"""
SIDE, FRAMES, GATE, LEAST = 256, 50, 5, 3  # px, frames, px, detections
CELLS = (25, 100, 250)  # in view; the challenge has about 100, 500 and 1000 in 512 x 512 px, four times this area
DROP_PX = 190  # radius; the corners of the view are at 181 px
NOISE = (2, 12, 24)  # grey levels of 255; a cell is 60 grey levels darker than its surroundings at its centre


def faba(program, *words):
    done = subprocess.run([str(program), *map(str, words)], capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"tracking_challenge.py: faba {' '.join(map(str, words))}: {done.stderr}")
    return done.stdout


def assignment(cost):
    """Rows to columns with the minimum total cost (Hungarian method with potentials); rows <= columns. Returns the column of each row."""
    n, m = cost.shape
    u, v = numpy.zeros(n + 1), numpy.zeros(m + 1)
    row_of, way = numpy.zeros(m + 1, int), numpy.zeros(m + 1, int)
    for i in range(1, n + 1):
        row_of[0], j0 = i, 0
        least, used = numpy.full(m + 1, numpy.inf), numpy.zeros(m + 1, bool)
        while True:
            used[j0] = True
            reduced = cost[row_of[j0] - 1] - u[row_of[j0]] - v[1:]
            better = ~used[1:] & (reduced < least[1:])
            least[1:][better] = reduced[better]
            way[1:][better] = j0
            j1 = 1 + int(numpy.argmin(numpy.where(used[1:], numpy.inf, least[1:])))
            delta = least[j1]
            u[row_of[used]] += delta
            v[used] -= delta
            least[~used] -= delta
            j0 = j1
            if row_of[j0] == 0:
                break
        while j0:
            row_of[j0], j0 = row_of[way[j0]], way[j0]
    out = numpy.zeros(n, int)
    for j in range(1, m + 1):
        if row_of[j]:
            out[row_of[j] - 1] = j - 1
    return out


def as_table(track):
    """Positions of a track {frame: (x, y)} for all frames; NaN where it is absent."""
    table = numpy.full((FRAMES, 2), numpy.nan)
    for frame, at in track.items():
        table[frame] = at
    return table


def pair_distance(a, b):
    """Gated distances of two tracks in each frame, and whether both are present."""
    both = ~numpy.isnan(a[:, 0]) & ~numpy.isnan(b[:, 0])
    either = ~numpy.isnan(a[:, 0]) | ~numpy.isnan(b[:, 0])
    d = numpy.where(either, float(GATE), 0.0)
    d[both] = numpy.minimum(GATE, numpy.linalg.norm(a[both] - b[both], axis=1))
    return d, both


def measures(true, found):
    x, y = [as_table(t) for t in true], [as_table(t) for t in found]
    length = lambda t: numpy.count_nonzero(~numpy.isnan(t[:, 0]))
    dummy = [GATE * length(t) for t in x]
    cost = numpy.full((len(x), len(y) + len(x)), 1e9)
    for i, a in enumerate(x):
        cost[i, len(y) + i] = dummy[i]
        for j, b in enumerate(y):
            near = numpy.linalg.norm(a - b, axis=1)
            if numpy.any(near < GATE):  # others are never better than none
                cost[i, j] = pair_distance(a, b)[0].sum()
    column = assignment(cost)
    total, none = cost[range(len(x)), column].sum(), sum(dummy)
    pairs = [(i, j) for i, j in enumerate(column) if j < len(y)]
    spurious = [y[j] for j in range(len(y)) if j not in {j for _, j in pairs}]
    matched, squares = 0, 0.0
    for i, j in pairs:
        d, both = pair_distance(x[i], y[j])
        inside = both & (d < GATE)
        matched += numpy.count_nonzero(inside)
        squares += (d[inside] ** 2).sum()
    positions = sum(map(length, x)) + sum(map(length, y)) - matched  # true or found
    return {"alpha": 1 - total / none, "beta": (none - total) / (none + GATE * sum(map(length, spurious))), "jsc": matched / positions,
            "jsc_tracks": len(pairs) / (len(x) + len(y) - len(pairs)), "rmse_px": numpy.sqrt(squares / max(1, matched))}


def true_tracks(position):
    """A track for each time that a cell spends in view; shorter ones than LEAST are not counted."""
    inside = ((position > -0.5) & (position < SIDE - 0.5)).all(axis=-1)
    tracks = []
    for cell in range(position.shape[1]):
        track = {}
        for frame in range(FRAMES + 1):
            if frame < FRAMES and inside[frame, cell]:
                track[frame] = position[frame, cell]
            elif track:
                tracks.append(track)
                track = {}
    return [t for t in tracks if len(t) >= LEAST]


def nearest_neighbour(spots, reach):
    """Tracks from the spots of each frame: pairs of successive frames within the reach, the nearest first."""
    tracks = [{0: at} for at in spots[0]]
    live = list(range(len(tracks)))
    for frame in range(1, FRAMES):
        new, next_live = spots[frame], [None] * len(spots[frame])
        if len(new) and live:
            last = numpy.array([tracks[k][frame - 1] for k in live])
            d = numpy.linalg.norm(last[:, None] - numpy.array(new)[None], axis=-1)
            taken = set()
            for a, b in zip(*numpy.unravel_index(numpy.argsort(d, axis=None), d.shape)):
                if d[a, b] > reach:
                    break
                if a not in taken and next_live[b] is None:
                    taken.add(a)
                    next_live[b] = live[a]
        for b, at in enumerate(new):
            if next_live[b] is None:
                next_live[b] = len(tracks)
                tracks.append({})
            tracks[next_live[b]][frame] = at
        live = next_live
    return tracks


def compare(program, folder, cells, noise, seed):
    scene, run, table = folder / "scene.toml", folder / "run", folder / "tracks.csv"
    scene.write_text(SCENE.format(duration=FRAMES / 15, cells=round(cells * numpy.pi * DROP_PX**2 / SIDE**2),
                                   noise=noise / 255, radius=DROP_PX))
    faba(program, "run", scene, "--out", run, "--seed", seed, "--quiet", "--force")
    with h5py.File(run / "tracks.h5") as f:
        true = true_tracks(f["position_px"][:FRAMES].astype(float))
    # With --least 1 the table has every detection.
    found = json.loads(faba(program, "track", run, "--least", 1, "--out", table, "--force", "--json"))
    tracks, spots = {}, [[] for _ in range(FRAMES)]
    with open(table) as f:
        for row in csv.DictReader(f):
            frame, at = int(row["frame"]), numpy.array([float(row["x_px"]), float(row["y_px"])])
            if frame < FRAMES:
                tracks.setdefault(row["track"], {})[frame] = at
                spots[frame].append(at)
    long_enough = lambda all_tracks: [t for t in all_tracks if len(t) >= LEAST]
    return {"faba": measures(true, long_enough(tracks.values())),
            "nearest": measures(true, long_enough(nearest_neighbour(spots, found["tracking"]["reach_px"]))),
            "in_view": sum(map(len, true)) / FRAMES, "spots": found["detection"]["spots_per_frame"], "quality": found["quality"]}


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--program", type=pathlib.Path, default=HERE.parent / "build/faba", help="the program, default build/faba")
    p.add_argument("--seeds", type=int, default=1, help="number of seeds, default 1")
    p.add_argument("--out", type=pathlib.Path, default=HERE / "results", help="folder of the results, default bench/results")
    o = p.parse_args()
    names = ("alpha", "beta", "jsc", "jsc_tracks", "rmse_px")
    rows, totals = [], {"faba": {n: [] for n in names}, "nearest": {n: [] for n in names}}
    table = "| cells in view | noise | detections per frame | method | alpha | beta | JSC | JSC of tracks | RMSE (px) | quality |\n"
    table += "|---|---|---|---|---|---|---|---|---|---|\n"
    with tempfile.TemporaryDirectory() as folder:
        for cells in CELLS:
            for noise in NOISE:
                each = [compare(o.program, pathlib.Path(folder), cells, noise, 1 + k) for k in range(o.seeds)]
                for method, name in (("faba", "`faba track`"), ("nearest", "nearest neighbour")):
                    mean = {n: float(numpy.mean([e[method][n] for e in each])) for n in names}
                    for n in names:
                        totals[method][n].append(mean[n])
                    first = (f"{numpy.mean([e['in_view'] for e in each]):.0f} | {noise} | {numpy.mean([e['spots'] for e in each]):.0f}"
                             if method == "faba" else " | | ")
                    quality = ", ".join(e["quality"] for e in each) if method == "faba" else ""
                    table += f"| {first} | {name} | " + " | ".join(f"{mean[n]:.3f}" for n in names) + f" | {quality} |\n"
                rows.append({"cells": cells, "noise": noise, "runs": each})
                print(json.dumps(rows[-1]), file=sys.stderr, flush=True)
    mean = {m: {n: float(numpy.mean(v)) for n, v in totals[m].items()} for m in totals}
    for method, name in (("faba", "`faba track`"), ("nearest", "nearest neighbour")):
        table += f"| mean | | | {name} | " + " | ".join(f"{mean[method][n]:.3f}" for n in names) + " | |\n"
    text = "# Measures of the Particle Tracking Challenge on rendered videos\n\n"
    text += f"{datetime.date.today()}, {o.seeds} seed(s) for each video. Generated by `bench/tracking_challenge.py`, which defines the measures.\n\n"
    text += f"Videos of {SIDE} x {SIDE} px and {FRAMES} frames, cells 2.7 px wide that swim 4.4 px per frame in random directions; noise in grey levels\n"
    text += "of 255, where the centre of a cell is about 60 grey levels darker than its surroundings. The baseline links the same detections.\n\n"
    text += table
    print(text)
    o.out.mkdir(parents=True, exist_ok=True)
    (o.out / "tracking_challenge.md").write_text(text)
    (o.out / "tracking_challenge.json").write_text(json.dumps(rows, indent=1) + "\n")
    return 0 if all(mean["faba"][n] >= mean["nearest"][n] for n in ("alpha", "beta", "jsc")) else 1


if __name__ == "__main__":
    sys.exit(main())
