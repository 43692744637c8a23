"""Pairs of pictures with known displacement for `faba flow`."""

import math

import numpy

from . import material as m
from .outcome import outcome

INTERVAL = ("none is printed; the mean endpoint error (where the true displacement is known: on the objects) must be below 0.1 px + 25 % of "
            "the mean true speed, the accuracy that the guide states for the default method (0.32 px at 1.26 px)")
SHAPE = (m.HEIGHT, m.WIDTH)
EVERYWHERE = numpy.ones(SHAPE, bool)


def measured(kit, rng, a, b, u, v, known=EVERYWHERE):
    """`u`, `v`: the true displacement, where `known`."""
    folder = kit.folder / m.digest(a.sum(), b.sum(), rng.integers(1 << 60))
    folder.mkdir()
    u, v = numpy.broadcast_to(u, SHAPE), numpy.broadcast_to(v, SHAPE)
    m.write_pgm(folder / "a.pgm", a)
    m.write_pgm(folder / "b.pgm", b)
    m.write_flo(folder / "t.flo", numpy.where(known, u, numpy.nan), numpy.where(known, v, numpy.nan))
    answer = kit.json("flow", folder / "a.pgm", folder / "b.pgm", "--truth", folder / "t.flo", "--threads", 1)
    for file in folder.iterdir():
        file.unlink()
    folder.rmdir()
    speed = float(numpy.hypot(u, v)[known].mean())
    allowed = 0.1 + 0.25 * speed
    error = math.inf if "refused" in answer else answer["truth"]["endpoint_px"]
    return outcome(answer, error > allowed, f"mean speed {speed:.2f} px", f"endpoint error {error:.2f} px", f"{allowed:.2f} px")


def noise(rng, sd):
    return sd * rng.standard_normal(SHAPE)


def pattern(rng, length, contrast=30.0):
    return 128 + contrast * m.texture(rng, SHAPE, length)


def translation(rng, low, high):
    speed, angle = rng.uniform(low, high), rng.uniform(0, 2 * math.pi)
    return speed * math.cos(angle), speed * math.sin(angle)


def moved(picture, dx, dy):
    return m.shifted(picture - 128, dx, dy) + 128


def swimmers(rng, n, sd, depth, speed, angles):
    """Dark spots on grey, before and after, with their displacement and where it is known (the spots)."""
    at = numpy.stack([rng.uniform(0, SHAPE[1], n), rng.uniform(0, SHAPE[0], n)], 1)
    d = speed * numpy.stack([numpy.cos(angles), numpy.sin(angles)], 1)
    a, b = m.spots(SHAPE, at, sd, depth), m.spots(SHAPE, at + d, sd, depth)
    weight = a + 1e-9
    u = sum(m.spots(SHAPE, at[i:i + 1], sd, depth) * d[i, 0] for i in range(n)) / weight
    v = sum(m.spots(SHAPE, at[i:i + 1], sd, depth) * d[i, 1] for i in range(n)) / weight
    return 150 - a, 150 - b, u, v, a > 0.3 * depth


def suitable(kit, rng, k):
    length = rng.uniform(2, 5)
    if k % 3 == 0:  # spots in one direction
        a, b, u, v, known = swimmers(rng, 150, rng.uniform(2, 3), 60, rng.uniform(0.4, 1.2), numpy.full(150, rng.uniform(0, 2 * math.pi)))
        return measured(kit, rng, a + noise(rng, 1), b + noise(rng, 1), u, v, known)
    p = pattern(rng, length)
    if k % 3 == 1:
        dx, dy = translation(rng, 0.3, 1.2)
        return measured(kit, rng, p + noise(rng, 1), moved(p, dx, dy) + noise(rng, 1), dx, dy)
    x, y = m.grid(SHAPE)  # a small rotation
    w = rng.uniform(0.004, 0.01)
    u, v = -w * (y - 120), w * (x - 160)
    return measured(kit, rng, p + noise(rng, 1), m.warped(p, x - u, y - v) + noise(rng, 1), u, v)


def too_fast(kit, rng, k):
    dx, dy = translation(rng, 5, 20)
    if k % 2:
        a, b, u, v, known = swimmers(rng, 120, 2, 60, math.hypot(dx, dy), numpy.full(120, math.atan2(dy, dx)))
        return measured(kit, rng, a + noise(rng, 1), b + noise(rng, 1), u, v, known)
    p = pattern(rng, rng.uniform(1.5, 3))
    return measured(kit, rng, p + noise(rng, 1), moved(p, dx, dy) + noise(rng, 1), dx, dy)


def too_dense(kit, rng, k):
    """Overlapping cells that swim in all directions."""
    n = 2500
    a, b, u, v, known = swimmers(rng, n, 1.5, 50, rng.uniform(2, 5), rng.uniform(0, 2 * math.pi, n))
    return measured(kit, rng, a + noise(rng, 1), b + noise(rng, 1), u, v, known)


def stripes(kit, rng, k):
    """Only the displacement across the stripes can be seen."""
    angle = rng.uniform(0, math.pi)
    x, y = m.grid(SHAPE)
    s = x * math.cos(angle) + y * math.sin(angle)
    along = angle + math.pi / 2 + rng.uniform(-0.7, 0.7)
    dx, dy = (lambda q: (q * math.cos(along), q * math.sin(along)))(rng.uniform(0.6, 1.5))
    wave = 2 * math.pi / rng.uniform(15, 30)
    p = 128 + 40 * numpy.sin(wave * s)
    return measured(kit, rng, p + noise(rng, 1), 128 + 40 * numpy.sin(wave * (s - dx * math.cos(angle) - dy * math.sin(angle))) + noise(rng, 1),
                    dx, dy)


def noisy(kit, rng, k):
    dx, dy = translation(rng, 0.6, 1.5)
    p = pattern(rng, rng.uniform(3, 6), rng.uniform(1, 4))
    sd = rng.uniform(4, 10)
    return measured(kit, rng, p + noise(rng, sd), moved(p, dx, dy) + noise(rng, sd), dx, dy)


def flicker(kit, rng, k):
    dx, dy = translation(rng, 0.3, 1.2)
    p = pattern(rng, rng.uniform(2, 6), rng.uniform(8, 30))
    return measured(kit, rng, p + noise(rng, 1), moved(p, dx, dy) * (1 + rng.choice([-1, 1]) * rng.uniform(0.04, 0.2)) + noise(rng, 1), dx, dy)


def light_moves(kit, rng, k):
    """A shadow moves across a structure that does not."""
    p = pattern(rng, rng.uniform(2, 5), 20) - 128
    light = m.texture(rng, SHAPE, 25)
    d = rng.uniform(3, 8)
    return measured(kit, rng, 128 + p + 25 * light + noise(rng, 1), 128 + p + 25 * m.shifted(light, d, 0) + noise(rng, 1), 0, 0)


def textured(kit, rng, k):
    """Cells swim over a structure that does not move."""
    n = 60
    a, b, u, v, known = swimmers(rng, n, 2.5, rng.uniform(20, 50), rng.uniform(0.8, 1.8), numpy.full(n, rng.uniform(0, 2 * math.pi)))
    p = 20 * m.texture(rng, SHAPE, rng.uniform(2, 5))
    return measured(kit, rng, a + p + noise(rng, 1), b + p + noise(rng, 1), u, v, known)


def focus_changes(kit, rng, k):
    dx, dy = translation(rng, 0.4, 1.2)
    p = pattern(rng, 2.5)
    return measured(kit, rng, p + noise(rng, 1), m.blurred(moved(p, dx, dy), rng.uniform(2, 5)) + noise(rng, 1), dx, dy)


def unfocused(kit, rng, k):
    dx, dy = translation(rng, 0.5, 1.5)
    p = pattern(rng, 2) - 128
    sd = rng.uniform(6, 14)
    return measured(kit, rng, 128 + m.smooth(p, sd) + noise(rng, 2), 128 + m.shifted(m.smooth(p, sd), dx, dy) + noise(rng, 2), dx, dy)


def coded(kit, rng, k):
    dx, dy = translation(rng, 0.3, 1.0)
    p = pattern(rng, rng.uniform(2, 4), rng.uniform(3, 10))
    a, b = m.coded_video([p + noise(rng, 1), moved(p, dx, dy) + noise(rng, 1)], rng.uniform(0.7, 3))
    return measured(kit, rng, a, b, dx, dy)


def two_populations(kit, rng, k):
    n = 500
    angle = rng.uniform(0, 2 * math.pi)
    a, b, u, v, known = swimmers(rng, n, 2.5, 45, rng.uniform(1, 2), angle + math.pi * (rng.random(n) < 0.5))
    return measured(kit, rng, a + noise(rng, 1), b + noise(rng, 1), u, v, known)


def undriven(kit, rng, k):
    """Nothing moves: what is seen is noise."""
    p = pattern(rng, 3, rng.uniform(0, 3))
    sd = rng.uniform(3, 8)
    return measured(kit, rng, p + noise(rng, sd), p + noise(rng, sd), 0, 0)


def saturated(kit, rng, k):
    dx, dy = translation(rng, 0.5, 1.2)
    p = pattern(rng, 3, 40) + rng.uniform(110, 150)
    return measured(kit, rng, p + noise(rng, 1), moved(p, dx, dy) + noise(rng, 1), dx, dy)


KINDS = {"suitable": (suitable, 12), "too fast": (too_fast, 4), "too dense": (too_dense, 2), "stripes": (stripes, 3), "noise": (noisy, 3),
         "illumination flicker": (flicker, 3), "moving light": (light_moves, 2), "textured background": (textured, 3),
         "focus changes": (focus_changes, 2), "wrong focus": (unfocused, 2), "coded": (coded, 2), "two populations": (two_populations, 2),
         "undriven": (undriven, 2), "saturated": (saturated, 2)}
