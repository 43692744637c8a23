"""Pairs of videos for `faba compare`: a step response as reference, and another one with a defect."""

import numpy

from . import film, material as m
from .outcome import outcome

INTERVAL = ("the mean distance +- the printed standard deviation of the distance over the pairs of frames; truth: the distance of the same two runs "
            "without the defect. Also, the start of the compared motion must be within 3 frames of the field reversal in both videos")
REVERSAL = 0.7
SWARM = {"rate": 30, "duration": 1.5, "reversal": REVERSAL, "diameter": 4, "speed": 50, "cells": 250}


def answer(kit, f, a, b):
    return kit.json("compare", kit.film(a, "compare", float(a.sum()), float(a.std())), kit.film(b, "compare", float(b.sum()), float(b.std())),
                    "--fps", f.rate, "--no-floor", "--threads", 1)


def judged(kit, rng, f, a, b, clean=None):
    """`clean`: both videos without the defect; None: the pair is judged by its start times only."""
    found = answer(kit, f, a, b)
    truth = answer(kit, f, *clean) if clean else found
    if "refused" in found or "refused" in truth:
        return outcome(found, False, truth.get("refused", ""), "", "")
    run, right = found["runs"][0], truth["runs"][0]
    late = max(abs(found["reference_t0_s"] - REVERSAL), abs(run["t0_s"] - REVERSAL))
    wrong = abs(run["mean"] - right["mean"]) > run["sd"] or late > 3 / f.rate
    return outcome(found, wrong, f"distance {right['mean']:.2f}, start {REVERSAL} s",
                   f"{run['mean']:.2f}, starts {found['reference_t0_s']:.2f} and {run['t0_s']:.2f} s", f"+- {run['sd']:.2f}")


def pair(kit, rng, **look):
    """Reference and run: equal but for the seed, and for `look` in the run."""
    return film.Film(kit, rng, **SWARM), film.Film(kit, rng, **{**SWARM, **look})


def suitable(kit, rng, k):
    a, b = pair(kit, rng, speed=rng.uniform(35, 65), cells=int(rng.integers(150, 350)), noise=rng.uniform(0.007, 0.01))
    return judged(kit, rng, b, a.frames(kit), b.frames(kit))


def defect(change, **look):
    def case(kit, rng, k):
        a, b = pair(kit, rng, **look)
        x, y = a.frames(kit), b.frames(kit)
        if k % 3 == 2:  # in the reference
            return judged(kit, rng, a, change(x, rng), y, (x, y))
        return judged(kit, rng, b, x, change(y, rng), (x, y))
    return case


def drifting(frames, rng):
    """The stage moves, with dust on it."""
    return m.drifting(m.on_texture(frames, 0.03, 2, rng), rng.uniform(0.5, 2), rng.uniform(-0.5, 0.5))


def other_size(frames, rng):
    """Another magnification, cut to the same size."""
    x, y = m.grid(frames[0].shape)
    z = rng.uniform(1.25, 1.6)
    return numpy.stack([m.warped(f, 160 + (x - 160) / z, 120 + (y - 120) / z) for f in frames])


def undriven(kit, rng, k):
    """The run shows cells that do not respond: the start of the comparison is not determined."""
    a, b = pair(kit, rng, reversal=None, field=0, motile=k % 2)
    return judged(kit, rng, b, a.frames(kit), b.frames(kit))


def looking(**look):
    """The run was recorded under other conditions; the truth is that under the same conditions."""
    def case(kit, rng, k):
        seed = rng.integers(1 << 30)
        a, b = pair(kit, numpy.random.default_rng(seed), **look)
        _, same = pair(kit, numpy.random.default_rng(seed))
        x = a.frames(kit)
        return judged(kit, rng, b, x, b.frames(kit), (x, same.frames(kit)))
    return case


def h264(kit, rng, k):
    a, b = pair(kit, rng, contrast=-0.15)
    x, y = a.frames(kit), b.frames(kit)
    return judged(kit, rng, b, x, film.coded(y, rng), (x, y))


def too_fast(kit, rng, k):
    """Cells that move by several times their width per frame: the start of the response is found, the flow is not theirs."""
    a, b = pair(kit, rng, speed=rng.uniform(400, 700), extra=", speed_max = \"2000 um/s\"")
    return judged(kit, rng, b, a.frames(kit), b.frames(kit))


KINDS = {"suitable": (suitable, 10), "undriven": (undriven, 2), "textured background": (defect(film.textured), 2),
         "moving texture": (defect(film.moving_texture), 2), "wrong focus": (defect(film.unfocused), 2), "drift": (defect(drifting), 2),
         "coded": (h264, 2), "illumination flicker": (defect(film.flickering), 3), "moving light": (defect(film.shadows), 2),
         "noise": (defect(film.noisy), 2), "other magnification": (defect(other_size), 2), "wrong polarity": (looking(contrast=0.8), 2),
         "too fast": (too_fast, 2)}
