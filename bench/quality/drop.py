"""Pictures of a drop's edge for `faba drop`."""

import math

import numpy

from . import material as m
from .outcome import outcome

INTERVAL = ("the radius +- 2 of its standard errors, and both coordinates of the centre +- 3 (rounded outward by 0.1 px, the printed digit). "
            "A picture without the circular edge of a drop has no right answer")


def geometry(rng, arc=None):
    """Centre and radius; of a large drop only an arc of about this angle (degrees) is in view."""
    if arc is None:
        r = rng.uniform(60, 100)
        return rng.uniform(r + 12, m.WIDTH - r - 12), rng.uniform(r + 12, m.HEIGHT - r - 12), r
    r = m.HEIGHT / (2 * math.sin(math.radians(arc) / 2))
    inset = rng.uniform(40, 90) + r * (1 - math.cos(math.radians(arc) / 2))
    return (inset + r if rng.random() < 0.5 else m.WIDTH - inset - r), m.HEIGHT / 2 + rng.uniform(-20, 20), r


MARGIN = 60  # px around the picture, for blur and motion at its border


def picture(kit, rng, at, margin=0, **look):
    """The first frame of a run in the drop `at` (centre and radius), with cells in view; larger by a margin on each side."""
    x, y, r = at
    cells = look.pop("cells", 60)
    text = m.scene(cells=cells, duration=0.1, rate=10, arena=f"radius_px = {r:.3f}\ncentre_px = [{x + margin:.3f}, {y + margin:.3f}]", um_per_px=1.16,
                   size=(m.WIDTH + 2 * margin, m.HEIGHT + 2 * margin), **{"noise": 0.01, **look})
    return kit.frames(kit.run(text, int(rng.integers(1, 1 << 30))))[0].astype(float)


def cut(image):
    return image[MARGIN:-MARGIN, MARGIN:-MARGIN]


def measured(kit, rng, image, at):
    """The answer for a picture whose edge is the circle `at`, or which has none (None)."""
    file = m.write_pgm(kit.folder / f"{m.digest(image.sum(), image.std(), rng.integers(1 << 60))}.pgm", image)
    a = kit.json("drop", file)
    file.unlink()
    if "refused" in a:
        return outcome(a, False, "no circle" if at is None else f"radius {at[2]:.1f}", "", "")
    sd, off = a["sd_px"], [abs(p - q) for p, q in zip((*a["center_px"], a["radius_px"]), at)] if at else [math.inf] * 3
    wrong = off[2] > 2 * sd["radius"] + 0.1 or off[0] > 3 * sd["x"] + 0.1 or off[1] > 3 * sd["y"] + 0.1
    return outcome(a, wrong, f"radius {at[2]:.1f}" if at else "no circle", f"radius {a['radius_px']:.1f}",
                   f"+- {2 * sd['radius']:.1f}; arc {a['arc_deg']:.0f} deg")


def suitable(kit, rng, k):
    at = geometry(rng, None if k % 2 else rng.uniform(45, 90))
    return measured(kit, rng, picture(kit, rng, at), at)


def on_texture(kit, rng, k):
    at = geometry(rng, None if k % 2 else 60)
    image = picture(kit, rng, at)
    return measured(kit, rng, image * (1 + rng.uniform(0.08, 0.3) * m.texture(rng, image.shape, rng.uniform(2, 10))), at)


def unfocused(kit, rng, k):
    at = geometry(rng, None if k % 2 else 60)
    return measured(kit, rng, cut(m.blurred(picture(kit, rng, at, MARGIN, noise=0), rng.uniform(4, 14))) + 2 * rng.standard_normal((m.HEIGHT, m.WIDTH)), at)


def not_round(kit, rng, k):
    """An elliptical drop: any single radius is wrong unless the interval contains both half axes."""
    x, y, r = at = geometry(rng)
    stretch = rng.uniform(1.06, 1.25)
    cx, cy = m.WIDTH / 2, m.HEIGHT / 2
    px, py = m.grid((m.HEIGHT, m.WIDTH))
    image = m.warped(picture(kit, rng, at, MARGIN), MARGIN + x + (px - cx) * math.sqrt(stretch), MARGIN + y + (py - cy) / math.sqrt(stretch))
    a = measured(kit, rng, image, (cx, cy, r / math.sqrt(stretch)))
    b = measured(kit, rng, image, (cx, cy, r * math.sqrt(stretch)))
    return {**a, "wrong": a["wrong"] or b["wrong"], "truth": f"half axes {r / math.sqrt(stretch):.1f} and {r * math.sqrt(stretch):.1f}"}


def second_edge(kit, rng, k):
    """A stronger edge, not concentric: the wall of the chamber, or a second drop."""
    x, y, r = at = geometry(rng, None if k % 2 else 60)
    image = picture(kit, rng, at, microscope="edge_contrast = -0.15\noutside_level = 0.97")
    px, py = m.grid(image.shape)
    other = r + rng.uniform(8, 25)
    d = numpy.hypot(px - x - rng.uniform(-8, 8), py - y - rng.uniform(-8, 8)) - other
    return measured(kit, rng, image * (1 - 0.5 * numpy.exp(-(d / 2) ** 2 / 2)), at)


def short_arc(kit, rng, k):
    at = geometry(rng, rng.uniform(10, 22))
    return measured(kit, rng, picture(kit, rng, at), at)


def no_drop(kit, rng, k):
    image = 148 + 2.5 * rng.standard_normal((m.HEIGHT, m.WIDTH))
    px, py = m.grid(image.shape)
    if k % 4 == 0:
        image += 25 * m.texture(rng, image.shape, rng.uniform(6, 20))
    elif k % 4 == 1:  # a rectangular chamber
        image -= 60 * numpy.exp(-((numpy.maximum(numpy.abs(px - 160) / 1.4, numpy.abs(py - 120)) - rng.uniform(70, 100)) / 1.5) ** 2 / 2)
    elif k % 4 == 2:  # a wavy boundary
        image += 30 * (py > 120 + 18 * numpy.sin(px / rng.uniform(15, 40)))
    else:  # cells in a band
        image += m.spots(image.shape, numpy.stack([rng.uniform(0, 320, 400), 120 + 15 * rng.standard_normal(400)], 1), 1.5, -50)
    return measured(kit, rng, image, None)


def coded(kit, rng, k):
    at = geometry(rng, None if k % 2 else 60)
    faint = "edge_contrast = -0.12\noutside_level = 0.98"
    return measured(kit, rng, m.coded(picture(kit, rng, at, microscope=faint), rng.uniform(1, 4)), at)


def uneven_light(kit, rng, k):
    at = geometry(rng, None if k % 2 else 60)
    image = picture(kit, rng, at)
    px, py = m.grid(image.shape)
    angle = rng.uniform(0, 2 * math.pi)
    along = (px - 160) * math.cos(angle) + (py - 120) * math.sin(angle)
    light = 1 / (1 + numpy.exp(-along / rng.uniform(5, 60))) * 0.8 + 0.2
    return measured(kit, rng, image * light * rng.uniform(0.8, 1.6), at)


def noisy(kit, rng, k):
    at = geometry(rng, None if k % 2 else 60)
    return measured(kit, rng, picture(kit, rng, at, noise=rng.uniform(0.04, 0.12), microscope="edge_contrast = -0.1\noutside_level = 0.97"), at)


def too_dense(kit, rng, k):
    """A swarm at the edge hides it; the edge itself is faint."""
    at = geometry(rng, 60)
    return measured(kit, rng, picture(kit, rng, at, cells=int(rng.integers(1500, 4000)), microscope="edge_contrast = -0.1",
                                      start='{ type = "edge", visible = true, depth_px = 12 }'), at)


def streaks(kit, rng, k):
    """The stage moved during the exposure."""
    at = geometry(rng, None if k % 2 else 60)
    image = picture(kit, rng, at, MARGIN, noise=0)
    n, length = 24, rng.uniform(10, 30)
    px, py = m.grid(image.shape)
    angle = rng.uniform(0, math.pi)
    moved = [m.warped(image, px + (i / (n - 1) - 0.5) * length * math.cos(angle), py + (i / (n - 1) - 0.5) * length * math.sin(angle))
             for i in range(n)]
    return measured(kit, rng, cut(sum(moved) / n) + 2 * rng.standard_normal((m.HEIGHT, m.WIDTH)), at)


KINDS = {"suitable": (suitable, 12), "textured background": (on_texture, 3), "wrong focus": (unfocused, 3), "not round": (not_round, 3),
         "second edge": (second_edge, 3), "short arc": (short_arc, 3), "no drop": (no_drop, 4), "coded": (coded, 3),
         "uneven light": (uneven_light, 3), "noise": (noisy, 3), "too dense": (too_dense, 2), "moved": (streaks, 2)}
