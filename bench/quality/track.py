"""Videos of cells for `faba track`."""

import math

import numpy

from . import film, material as m
from .outcome import inside, outcome

INTERVAL = ("the 95 % interval of the mean speed over the verb's own interval of frames, and the 90 % interval of the median speed of a moving "
            "population, widened by 1.19; 3 % of the speed are added, the localisation of tracks/bench (bench/results/tracking.md). One of the two must "
            "contain the truth; also, the number of detections per frame must be within 25 % of the number of cells in view")
WIDER = 1.96 / 1.645


def judged(kit, rng, f, frames, *words, drift=(0, 0), moving=None, file=None, cells=True):
    """`moving`: the cells that swim, if not all do. With a drift of the view, speeds in the picture and in the liquid are both right."""
    file = file or kit.film(frames, f.text, f.seed, float(frames.sum()), float(frames.std()))
    a = kit.json("track", file, "--fps", f.rate, "--threads", 1, *words)
    true_value = f"{f.speed(1):.1f} px/s, {f.in_view().sum(1).mean():.0f} cells"
    if "refused" in a or not a["speed"] or a["speed"]["mean_px_s"] is None:
        return outcome(a, False, true_value, "no speed", "")
    gap = a["speed"]["interval_frames"]
    right = {f.speed(gap), f.speed(gap, drift)} if moving is None else set()
    medians = {f.median_speed(numpy.arange(f.at.shape[1]) if moving is None else moving)}
    low, high = a["speed"]["mean_px_s_ci95"]
    ok = low is not None and any(inside(low - 0.03 * v, v, high + 0.03 * v) for v in right)
    for p in a["populations"]:
        if p["motion"] == "still":
            continue
        value, (lo, hi) = p["speed_px_per_s"], p["ci90"]
        ok = ok or any(inside(value - WIDER * (value - lo) - 0.03 * v, v, value + WIDER * (hi - value) + 0.03 * v) for v in medians)
    count, true = a["detection"]["spots_per_frame"], f.in_view().sum(1).mean()
    ok = ok and (not cells or abs(count / true - 1) < 0.25)
    stated = f"{a['speed']['mean_px_s']:.1f} px/s, {count:.0f} per frame"
    if len(a["populations"]) > 1:
        stated += ", populations " + ", ".join(f"{p['speed_px_per_s']:.1f} ({p['motion']})" for p in a["populations"])
    return outcome(a, not ok, true_value, stated, f"{low or math.nan:.1f} to {high or math.nan:.1f}")


def base(kit, rng, **look):
    return film.Film(kit, rng, **{"cells": int(rng.integers(150, 350)), "speed": rng.uniform(30, 90), "duration": 1.3, **look})


def suitable(kit, rng, k):
    f = base(kit, rng, field=0 if k % 2 else 1000, contrast=rng.uniform(-0.6, -0.35) if k % 3 else 0.8)
    return judged(kit, rng, f, f.frames(kit))


def defect(change, **look):
    def case(kit, rng, k):
        f = base(kit, rng, field=0 if k % 2 else 1000, **look)
        return judged(kit, rng, f, change(f.frames(kit), rng))
    return case


def undriven(kit, rng, k):
    """Dead cells: they diffuse, and have no speed but that of their diffusion."""
    f = base(kit, rng, motile=0, field=0)
    return judged(kit, rng, f, f.frames(kit))


def too_fast(kit, rng, k):
    f = base(kit, rng, speed=rng.uniform(150, 250), rate=10, field=0 if k % 2 else 1000, cells=500, duration=3)
    return judged(kit, rng, f, f.frames(kit))


def too_dense(kit, rng, k):
    f = base(kit, rng, cells=int(rng.integers(2500, 5000)), field=0 if k % 2 else 1000, duration=0.7)
    return judged(kit, rng, f, f.frames(kit))


def drift(kit, rng, k):
    f = base(kit, rng, field=0)
    d = (rng.uniform(-2.5, 2.5), rng.uniform(-2.5, 2.5))
    return judged(kit, rng, f, m.drifting(f.frames(kit), *d), drift=d)


def h264(kit, rng, k):
    """Faint cells in a coded video of the program."""
    f = base(kit, rng, contrast=rng.uniform(-0.15, -0.08), noise=0.01, field=0 if k % 2 else 1000)
    return judged(kit, rng, f, f.frames(kit), file=f.run / "video.mp4")


def two_populations(kit, rng, k):
    f = base(kit, rng, motile=rng.uniform(0.3, 0.7), field=1000)
    swam = numpy.linalg.norm(f.at[-1] - f.at[0], axis=-1) > 5
    return judged(kit, rng, f, f.frames(kit), moving=numpy.flatnonzero(swam))


def polarity(kit, rng, k):
    """The user gives the wrong polarity: bright for dark cells."""
    f = base(kit, rng)
    return judged(kit, rng, f, f.frames(kit), "--polarity", "bright")


def big(kit, rng, k):
    """One large object over slowly moving tissue: nothing of the size of a cell moves by itself."""
    f = base(kit, rng, cells=2, speed=20, diameter=40, duration=1.3, start='"visible"')
    return judged(kit, rng, f, film.moving_texture(f.frames(kit), rng))


KINDS = {"suitable": (suitable, 12), "undriven": (undriven, 2), "textured background": (defect(film.textured), 3),
         "moving texture": (defect(film.moving_texture), 2), "too fast": (too_fast, 2), "too dense": (too_dense, 2),
         "wrong focus": (defect(film.unfocused), 2), "drift": (drift, 2), "coded": (h264, 2), "coded in blocks": (defect(film.coded, contrast=-0.15), 2),
         "illumination flicker": (defect(film.flickering), 2), "moving light": (defect(film.shadows), 2), "two populations": (two_populations, 2),
         "wrong polarity": (polarity, 2), "noise": (defect(film.noisy), 2), "large objects": (big, 2)}
