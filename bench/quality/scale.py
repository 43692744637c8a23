"""Pictures of rulers and tables of readings for `faba scale`."""

import math

import numpy

from . import material as m
from .outcome import inside, outcome

INTERVAL = ("the verb's 95 % interval of um_per_px, for the scale at the centre of the picture. A picture without a ruler has no right answer")
SHAPE = (360, 480)


def logistic(x):
    return 1 / (1 + numpy.exp(-numpy.clip(1.702 * x, -50, 50)))  # within 0.01 of the normal distribution


def ruler(rng, pitch, angle=None, blur=0.6, noise=2.0, depth=110, missing=0.0, jitter=0.0, minor=1.0, bend=0.0, tilt=0.0, ghost=0.0,
          count=None, across=0.0, length=1.0):
    """Dark marks; every fifth is longer, every tenth longest. `pitch` is the distance at the centre (px); `bend`: of a lens, relative change
    of the radius at the corner; `tilt`: relative change of the pitch from the centre to the side; `minor`: contrast of the short marks
    relative to the tenth ones; `ghost`: contrast of a second picture of each mark."""
    angle = rng.uniform(-0.2, 0.2) if angle is None else angle
    x, y = m.grid(SHAPE)
    x, y = x - (SHAPE[1] - 1) / 2, y - (SHAPE[0] - 1) / 2
    r2 = (x * x + y * y) / (SHAPE[0] ** 2 + SHAPE[1] ** 2) * 4
    x, y = x * (1 + bend * r2), y * (1 + bend * r2)
    s, t = x * math.cos(angle) + y * math.sin(angle), y * math.cos(angle) - x * math.sin(angle) - across
    s = s / (1 + tilt * s / (SHAPE[1] / 2))
    s = s + rng.uniform(0, pitch)
    k = numpy.rint(s / pitch).astype(int)
    index = k - k.min()
    off = (jitter * pitch * rng.standard_normal(index.max() + 1))[index]
    there = (rng.random(index.max() + 1) >= missing)[index].astype(float)
    if count:
        there *= numpy.abs(index - index.max() // 2) <= count // 2
    strength = numpy.where(k % 10 == 0, 1.0, minor) * there
    reach = numpy.where(k % 10 == 0, 70, numpy.where(k % 5 == 0, 50, 35)) * length
    width = 0.25 * pitch
    inside = logistic((t + 60) / 0.6) * logistic((reach - 60 - t) / 0.6)

    def marks(shift):
        d = s - k * pitch - off - shift
        return logistic((d + width / 2) / 0.5) - logistic((d - width / 2) / 0.5)

    dark = marks(0) + (ghost * marks(0.37 * pitch) if ghost else 0)
    image = 200 - depth * strength * inside * dark
    if blur > 0.3:
        image = m.blurred(image, blur)
    return image + noise * rng.standard_normal(SHAPE)


def measured(kit, rng, image, pitch, tick=10.0):
    """`pitch`: px between marks that are `tick` um apart; None: no ruler."""
    file = m.write_pgm(kit.folder / f"{m.digest(image.sum(), image.std(), rng.integers(1 << 60))}.pgm", image)
    a = kit.json("scale", file, "--tick", f"{tick:g} um")
    file.unlink()
    truth = tick / pitch if pitch else None
    return judged(a, truth)


def judged(a, truth):
    true_value = f"{truth:.4f} um/px" if truth else "no ruler"
    if "refused" in a:
        return outcome(a, False, true_value, "", "")
    low, high = a["ci95"]
    return outcome(a, truth is None or not inside(low, truth, high), true_value, f"{a['um_per_px']:.4f}", f"{low:.4f} to {high:.4f}")


def table(kit, rng, widths, readings):
    file = kit.folder / f"{m.digest(list(widths), rng.integers(1 << 60))}.csv"
    file.write_text("width_um,px\n" + "".join(f"{w:g},{p:.2f}\n" for w, p in zip(widths, readings)))
    a = kit.json("scale", file)
    file.unlink()
    return a


def pitch_of(rng):
    return rng.uniform(8, 16)


def suitable(kit, rng, k):
    if k % 4 == 3:
        truth, widths = rng.uniform(0.3, 1.5), numpy.repeat([10, 20, 50, 100, 150, 200], 2)
        return judged(table(kit, rng, widths, widths / truth + 0.7 * rng.standard_normal(12)), truth)
    p = pitch_of(rng)
    return measured(kit, rng, ruler(rng, p, rng.uniform(-1.5, 1.5) if k % 2 else None, blur=rng.uniform(0.5, 1.2)), p)


def blurred(kit, rng, k):
    p = pitch_of(rng)
    return measured(kit, rng, ruler(rng, p, blur=p * rng.uniform(0.25, 0.6)), p)


def tilted(kit, rng, k):
    """Not in the plane of focus: the marks are closer together on one side."""
    p = pitch_of(rng)
    return measured(kit, rng, ruler(rng, p, tilt=rng.choice([-1, 1]) * rng.uniform(0.02, 0.15)), p)


def missing(kit, rng, k):
    p = pitch_of(rng)
    return measured(kit, rng, ruler(rng, p, missing=rng.uniform(0.25, 0.6)), p)


def doubled(kit, rng, k):
    """A reflection shows each mark twice."""
    p = pitch_of(rng)
    return measured(kit, rng, ruler(rng, p, ghost=rng.uniform(0.5, 0.95)), p)


def uneven_light(kit, rng, k):
    p = pitch_of(rng)
    image = ruler(rng, p, noise=1)
    x, _ = m.grid(SHAPE)
    return measured(kit, rng, image * (0.05 + 1.5 * logistic((x - rng.uniform(150, 330)) / rng.uniform(20, 80))), p)


def wrong_tick(kit, rng, k):
    """The finest marks are too faint to be seen: the seen ones are ten times further apart than --tick says."""
    p = rng.uniform(3.2, 5.0)
    return measured(kit, rng, ruler(rng, p, minor=rng.uniform(0.01, 0.12), noise=rng.uniform(2, 5)), p)


def few_marks(kit, rng, k):
    p = rng.uniform(25, 60)
    return measured(kit, rng, ruler(rng, p, jitter=0.004, count=int(rng.integers(4, 8))), p)


def coded(kit, rng, k):
    p = pitch_of(rng)
    return measured(kit, rng, m.coded(ruler(rng, p, depth=rng.uniform(15, 50)), rng.uniform(1, 4)), p)


def noisy(kit, rng, k):
    p = pitch_of(rng)
    return measured(kit, rng, ruler(rng, p, depth=25, noise=rng.uniform(12, 30)), p)


def lens(kit, rng, k):
    """A lens that distorts: the scale at the centre is not that of the corners."""
    p = pitch_of(rng)
    return measured(kit, rng, ruler(rng, p, bend=rng.choice([-1, 1]) * rng.uniform(0.02, 0.12), across=rng.uniform(-60, 60)), p)


def two_scales(kit, rng, k):
    p = pitch_of(rng)
    q = p * rng.uniform(1.15, 1.45)
    a, b = ruler(rng, p, 0.0, across=-70, length=0.8), ruler(rng, q, 0.0, across=130, length=rng.uniform(0.6, 1.2))
    return measured(kit, rng, a + b - 200, p)


def no_ruler(kit, rng, k):
    image = 180 + 3 * rng.standard_normal(SHAPE)
    if k % 3 == 0:
        image += 30 * m.texture(rng, SHAPE, rng.uniform(2, 5))
    elif k % 3 == 1:  # strokes of text, about equally wide characters
        for row in range(60, 320, 40):
            for column in range(40, 440, 14):
                for _ in range(3):
                    x = column + int(rng.integers(0, 10))
                    image[row:row + int(rng.integers(6, 18)), x:x + 2] -= 120
    else:  # a row of cells
        image += m.spots(SHAPE, numpy.stack([numpy.arange(30, 450, 18) + 3 * rng.standard_normal(24), 180 + 3 * rng.standard_normal(24)], 1), 3, -90)
    return measured(kit, rng, image, None)


def irregular(kit, rng, k):
    """Drawn by hand."""
    p = pitch_of(rng)
    return measured(kit, rng, ruler(rng, p, jitter=rng.uniform(0.06, 0.18)), p)


def readings(rng):
    truth, widths = rng.uniform(0.3, 1.5), numpy.repeat([10.0, 20, 50, 100, 150, 200], 2)
    return truth, widths, widths / truth + 0.7 * rng.standard_normal(12)


def mixed_units(kit, rng, k):
    """Some widths were typed in another unit."""
    truth, widths, px = readings(rng)
    typed = widths.copy()
    typed[rng.choice(12, 2, replace=False)] *= rng.choice([0.1, 2.54])
    return judged(table(kit, rng, typed, px), truth)


def outlier(kit, rng, k):
    truth, widths, px = readings(rng)
    px[rng.integers(6, 12)] *= rng.choice([0.5, 1.5, 2])
    return judged(table(kit, rng, widths, px), truth)


def not_linear(kit, rng, k):
    """Distances across the picture of a lens that distorts: the scale at the centre is that of short distances."""
    truth, widths, px = readings(rng)
    return judged(table(kit, rng, widths, px * (1 + rng.choice([-1, 1]) * rng.uniform(0.05, 0.12) * (widths / 200) ** 2)), truth)


KINDS = {"suitable": (suitable, 12), "blurred": (blurred, 3), "tilted": (tilted, 3), "missing marks": (missing, 3), "double marks": (doubled, 3),
         "uneven light": (uneven_light, 2), "wrong tick": (wrong_tick, 3), "few marks": (few_marks, 2), "coded": (coded, 2), "noise": (noisy, 2),
         "lens": (lens, 3), "two scales": (two_scales, 2), "no ruler": (no_ruler, 3), "irregular": (irregular, 2),
         "table: mixed units": (mixed_units, 2), "table: outlier": (outlier, 2), "table: not linear": (not_linear, 2)}
