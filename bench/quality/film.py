"""Videos of cells, with the defects that `track`, `activity` and `compare` share."""

import numpy

from . import material as m

DISC = '{ type = "disc", centre_px = [160, 120], radius_px = 260 }'  # wider than the view, so that cells come in while others leave
IN_VIEW = m.WIDTH * m.HEIGHT / (numpy.pi * 260**2)


class Film:
    """A run, its frames and the true positions. `fps` is the frame rate."""

    def __init__(self, kit, rng, **look):
        look = {"start": DISC, **look}
        self.rate = look.get("rate", 30)
        self.text, self.seed = m.scene(**look), int(rng.integers(1, 1 << 30))
        self.run = kit.run(self.text, self.seed)
        self.at = kit.positions(self.run)

    def frames(self, kit):
        return kit.frames(self.run).astype(float)

    def in_view(self):
        return ((self.at > -0.5) & (self.at < numpy.array([m.WIDTH, m.HEIGHT]) - 0.5)).all(axis=-1)

    def speed(self, gap, drift=(0, 0)):
        """True mean speed of the cells in view over `gap` frames, px/s, in a view that moves by `drift` px per frame."""
        both = self.in_view()[gap:] & self.in_view()[:-gap]
        d = self.at[gap:] - self.at[:-gap] + gap * numpy.array(drift)
        return float(numpy.linalg.norm(d, axis=-1)[both].mean() * self.rate / gap)

    def median_speed(self, cells, gap=5):
        """Median over the given cells of their mean speed in view."""
        d = numpy.linalg.norm(self.at[gap:, cells] - self.at[:-gap, cells], axis=-1) * self.rate / gap
        both = (self.in_view()[gap:] & self.in_view()[:-gap])[:, cells]
        return float(numpy.median(d[both]))


def textured(frames, rng):
    """Cells over a static structure as strong as they are."""
    return m.on_texture(frames, rng.uniform(0.06, 0.15), rng.uniform(1.5, 4), rng)


def moving_texture(frames, rng):
    """A structure that moves slowly: tissue."""
    p = m.texture(rng, frames[0].shape, rng.uniform(1.5, 3))
    d = rng.uniform(0.1, 0.5)
    return numpy.stack([f * (1 + 0.12 * m.shifted(p, k * d, 0.3 * k * d)) for k, f in enumerate(frames)])


def noisy(frames, rng):
    return frames + rng.uniform(8, 15) * rng.standard_normal(frames.shape)


def unfocused(frames, rng):
    sd = rng.uniform(3, 6)
    return numpy.stack([m.blurred(f, sd) for f in frames]) + 2 * rng.standard_normal(frames.shape)


def coded(frames, rng):
    return m.coded_video(frames, rng.uniform(0.7, 2))


def flickering(frames, rng):
    return m.flickering(frames, rng.uniform(0.02, 0.08), rng)


def shadows(frames, rng):
    """Light from outside moves over the picture."""
    p = m.texture(rng, frames[0].shape, 30)
    d = rng.uniform(1, 3)
    return numpy.stack([f * (1 + 0.08 * m.shifted(p, k * d, 0)) for k, f in enumerate(frames)])
