"""Videos of cells for `faba activity`: after a field reversal, or without a response."""

import numpy

from . import film, material as m
from .outcome import outcome

INTERVAL = ("wrong: a response of cells that do not respond, or no response of cells that do; a segment whose direction is off by more than 30 degrees; an onset "
            "whose 90 % interval, widened by 1.19, does not overlap with the time from the field reversal to three frames after it")
REVERSAL = 1.0
WIDER = 1.96 / 1.645


def judged(kit, rng, k, f, frames, responds=True, file=None):
    file = file or kit.film(frames, f.text, f.seed, float(frames.sum()), float(frames.std()))
    known = ["--reversal", REVERSAL] if k % 2 else []  # half of the users recorded it
    a = kit.json("activity", file, "--fps", f.rate, "--direction", 0, "--threads", 1, *known)
    true_value = f"a response at {REVERSAL} s to the right" if responds else "no response"
    if "refused" in a:
        return outcome(a, False, true_value, "", "")
    v = a["videos"][0]
    wrong = v["responds"] != responds
    stated = [f"responds: {str(v['responds']).lower()}"]
    for s in v["segments"]:
        stated.append(f"{s['t0_s']:.2f} to {s['t1_s']:.2f} s at {s['direction_deg']:.0f} deg")
        right = 180 if (s["t0_s"] + s["t1_s"]) / 2 < REVERSAL else 0
        off = abs((s["direction_deg"] - right + 180) % 360 - 180)
        wrong = wrong or (responds and off > 30)
    interval = ""
    if responds and v["responds"] and v["onset_s"] is not None:
        low, high = (v["onset_s"] + WIDER * (x - v["onset_s"]) for x in v["onset_ci90"])
        wrong = wrong or high < REVERSAL or low > REVERSAL + 3 / f.rate
        stated.append(f"onset {v['onset_s']:.2f} s")
        interval = f"{low:.2f} to {high:.2f} s"
    return outcome(a, wrong, true_value, "; ".join(stated), interval)


def base(kit, rng, **look):
    """Cells rest at the left edge of a drop until the field reversal, then swim to the right."""
    radius = 600
    return film.Film(kit, rng, **{"cells": int(rng.integers(120, 250)), "speed": rng.uniform(35, 60), "rate": 30, "duration": 3.0,
                                  "reversal": REVERSAL, "diameter": 4, "arena": f"radius_px = {radius}\ncentre_px = [{radius + 30}, {m.HEIGHT / 2}]",
                                  "start": '{ type = "edge", direction = "180 deg", visible = true, depth_px = 8 }', **look})


def suitable(kit, rng, k):
    f = base(kit, rng)
    return judged(kit, rng, k, f, f.frames(kit))


def defect(change, **look):
    def case(kit, rng, k):
        f = base(kit, rng, **look)
        return judged(kit, rng, k, f, change(f.frames(kit), rng))
    return case


def without_response(change, **look):
    """Cells that do not respond: dead ones (even cases), or ones that swim in all directions."""
    def case(kit, rng, k):
        f = base(kit, rng, **{"reversal": None, "field": 0, "motile": k % 2, "start": film.DISC, **look})
        return judged(kit, rng, k, f, change(f.frames(kit), rng), False)
    return case


def unchanged(frames, rng):
    return frames


def drifting(frames, rng):
    return m.drifting(frames, rng.uniform(0.5, 2), rng.uniform(-0.5, 0.5))


def h264(kit, rng, k):
    f = base(kit, rng, contrast=-0.12) if k % 2 else base(kit, rng, contrast=-0.12, reversal=None, field=0, motile=0, start=film.DISC)
    return judged(kit, rng, k, f, f.frames(kit), bool(k % 2), file=f.run / "video.mp4")


def polarity(kit, rng, k):
    """Half of the cells swim along the field, the other half against it."""
    f = base(kit, rng)
    return judged(kit, rng, k, f, (lambda p: (p + p[:, :, ::-1]) / 2)(f.frames(kit)))


KINDS = {"suitable": (suitable, 10), "undriven": (without_response(unchanged), 3), "textured background": (defect(film.textured), 2),
         "moving texture": (without_response(film.moving_texture), 2), "too fast": (defect(unchanged, speed=186, rate=15), 2),
         "too dense": (defect(unchanged, cells=4000), 2), "wrong focus": (defect(film.unfocused), 2), "drift": (without_response(drifting), 2),
         "coded": (h264, 2), "illumination flicker": (without_response(film.flickering), 3), "moving light": (without_response(film.shadows), 2),
         "two populations": (defect(unchanged, motile=0.4), 2), "wrong polarity": (polarity, 2), "noise": (defect(film.noisy), 2)}
