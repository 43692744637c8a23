"""Tables of measured fields for `faba field fit`."""

import math

import numpy

from . import material as m
from .outcome import outcome

INTERVAL = ("gain and each determined shift and offset, +- 3 standard errors (with seven parameters together about the level of 95 % to 98 %). "
            "Of parameters that the verb names as undetermined nothing is asked")
# The same system for all cases: two coils with 2 A, close enough that their distance matters within the map.
COILS = [(-30e-3, 1.0), (34e-3, 0.8)]
RIG = "".join(f'[[coil]]\ntype = "loop"\nradius = "20 mm"\nturns = {int(50 * w)}\ncurrent = "2 A"\nposition = [0, 0, {z}]\n' for z, w in COILS)


def field(kit, at, coils=RIG):
    """The field of coils at positions (n, 3) in m, T, by the program itself (its formulas are tested elsewhere)."""
    folder = kit.folder / ("at-" + m.digest(coils, at.tolist()))
    folder.mkdir(exist_ok=True)
    (folder / "rig.toml").write_text(coils)
    (folder / "p.csv").write_text("x_m,y_m,z_m\n" + "".join("%.9g,%.9g,%.9g\n" % tuple(p) for p in at))
    _, out, error = kit.call("field", "at", folder / "rig.toml", "--points", folder / "p.csv")
    if not out:
        raise RuntimeError(error)
    return numpy.array([[float(x) for x in line.split(",")[3:]] for line in out.splitlines()[1:]])


def lattice(n=(5, 5, 5), side=8e-3):
    return numpy.stack(numpy.meshgrid(*[numpy.linspace(-side, side, k) if k > 1 else [0.0] for k in n], indexing="ij"), -1).reshape(-1, 3)


class Truth:
    def __init__(self, rng):
        self.gain = rng.uniform(0.85, 1.15)
        self.shift = rng.uniform(-1.5e-3, 1.5e-3, 3)
        self.offset = rng.uniform(-40e-6, 40e-6, 3)

    def field(self, kit, at, coils=RIG):
        return self.gain * field(kit, at - self.shift, coils) + self.offset


def measured(kit, rng, truth, at, b, columns="x_m,y_m,z_m,bx_t,by_t,bz_t", only=(0, 1, 2)):
    folder = kit.folder / ("fit-" + m.digest(at.tolist(), b.tolist(), rng.integers(1 << 60)))
    folder.mkdir()
    (folder / "rig.toml").write_text(RIG)
    (folder / "m.csv").write_text(columns + "\n" + "".join(",".join("%.9g" % x for x in (*p, *(v[k] for k in only))) + "\n" for p, v in zip(at, b)))
    a = kit.json("field", "fit", folder / "rig.toml", "--map", folder / "m.csv")
    for f in folder.iterdir():
        f.unlink()
    folder.rmdir()
    if "refused" in a:
        return outcome(a, False, f"gain {truth.gain:.3f}", "", "")
    off = []
    def add(name, value, right, se):
        if se is not None:
            off.append((abs(value - right) / max(se, 1e-12), name, right, value, se))
    add("gain", a["gain"], truth.gain, a["gain_se"])
    for k, axis in enumerate("xyz"):
        add(f"shift {axis} (mm)", 1e3 * a["shift_m"][k], 1e3 * truth.shift[k], a["shift_se_m"][k] and 1e3 * a["shift_se_m"][k])
        add(f"offset {axis} (uT)", 1e6 * a["offset_t"][k], 1e6 * truth.offset[k], a["offset_se_t"][k] and 1e6 * a["offset_se_t"][k])
    if not off:
        return outcome(a, False, f"gain {truth.gain:.3f}", "nothing determined", "")
    worst, name, right, value, se = max(off)
    return outcome(a, worst > 3, f"{name} {right:.4g}", f"{value:.4g}", f"+- {3 * se:.2g}")


def noise(rng, b, sd=1e-6):
    return b + sd * rng.standard_normal(b.shape)


def suitable(kit, rng, k):
    t = Truth(rng)
    at = lattice(((5, 5, 5), (7, 7, 1), (9, 3, 3))[k % 3], rng.uniform(6e-3, 12e-3))
    return measured(kit, rng, t, at, noise(rng, t.field(kit, at), rng.uniform(0.3e-6, 3e-6)))


def saturated(kit, rng, k):
    """The probe's range ends below the largest field."""
    t, at = Truth(rng), lattice()
    b = t.field(kit, at)
    limit = numpy.quantile(numpy.abs(b), rng.uniform(0.8, 0.95))
    return measured(kit, rng, t, at, numpy.clip(noise(rng, b), -limit, limit))


def one_sided(kit, rng, k):
    """A scan along one line on one side of the coils."""
    t = Truth(rng)
    at = numpy.stack([numpy.zeros(15), numpy.zeros(15), numpy.linspace(60e-3, rng.uniform(90e-3, 130e-3), 15)], 1)
    return measured(kit, rng, t, at, noise(rng, t.field(kit, at), 2e-6), "x_m,y_m,z_m,bz_t", (2,))


def mixed_units(kit, rng, k):
    """Some rows were measured in another range of the display: mT and uT, or gauss and mT, in one column."""
    t, at = Truth(rng), lattice()
    b = noise(rng, t.field(kit, at))
    rows = rng.choice(len(at), int(len(at) * rng.uniform(0.05, 0.4)), replace=False)
    b[rows] *= rng.choice([0.1, 10])
    return measured(kit, rng, t, at, b)


def wrong_sign(kit, rng, k):
    """One component, or one axis of positions, has the opposite sign."""
    t, at = Truth(rng), lattice()
    b = noise(rng, t.field(kit, at))
    if k % 3 == 0:
        b[:, 2] *= -1
    elif k % 3 == 1:
        b[:, 0] *= -1
    else:
        at = at * numpy.array([1, 1, -1])
    return measured(kit, rng, t, at, b)


def swapped(kit, rng, k):
    t, at = Truth(rng), lattice((7, 5, 3))
    b = noise(rng, t.field(kit, at))
    return measured(kit, rng, t, at, b[:, [0, 2, 1]] if k % 2 else b[:, [2, 1, 0]])


def coarse(kit, rng, k):
    """Very few points."""
    t = Truth(rng)
    at = rng.uniform(-8e-3, 8e-3, (int(rng.integers(3, 6)), 3))
    return measured(kit, rng, t, at, noise(rng, t.field(kit, at), 5e-6))


def outliers(kit, rng, k):
    t, at = Truth(rng), lattice()
    b = noise(rng, t.field(kit, at))
    for row in rng.choice(len(at), int(rng.integers(3, 12)), replace=False):
        b[row, rng.integers(3)] += rng.choice([-1, 1]) * rng.uniform(0.2, 1) * numpy.abs(b).max()
    return measured(kit, rng, t, at, b)


def drift(kit, rng, k):
    """The zero of the probe drifts during the scan."""
    t, at = Truth(rng), lattice()
    b = noise(rng, t.field(kit, at))
    return measured(kit, rng, t, at, b + rng.choice([-1, 1]) * rng.uniform(20e-6, 80e-6) * numpy.linspace(-1, 1, len(at))[:, None])


def magnet(kit, rng, k):
    """A magnet, or steel, stands beside the coils."""
    t, at = Truth(rng), lattice()
    from_magnet = at - numpy.array([rng.uniform(25e-3, 45e-3), rng.uniform(-10e-3, 10e-3), 0])
    r = numpy.linalg.norm(from_magnet, axis=1)[:, None]
    moment = rng.uniform(0.02, 0.1) * numpy.array([[math.cos(k), math.sin(k), 0.3]])
    b = 1e-7 * (3 * from_magnet * (from_magnet * moment).sum(1)[:, None] / r**5 - moment / r**3)
    return measured(kit, rng, t, at, noise(rng, t.field(kit, at) + b))


def turned(kit, rng, k):
    """The axes of the probe's stage are turned against those of the coils."""
    t, at = Truth(rng), lattice()
    a = math.radians(rng.choice([-1, 1]) * rng.uniform(4, 15))
    turn = numpy.array([[1, 0, 0], [0, math.cos(a), -math.sin(a)], [0, math.sin(a), math.cos(a)]])
    return measured(kit, rng, t, at, noise(rng, t.field(kit, at @ turn.T) @ turn))


def wrong_coils(kit, rng, k):
    """One of the two coils has another number of turns, or the opposite current, than the file says."""
    t, at = Truth(rng), lattice()
    other = RIG.replace("turns = 40", "turns = 46") if k % 2 else RIG.replace('turns = 40\ncurrent = "2 A"', 'turns = 40\ncurrent = "-2 A"')
    return measured(kit, rng, t, at, noise(rng, t.field(kit, at, other)))


def stretched(kit, rng, k):
    """The positions were read on a scale with an error."""
    t, at = Truth(rng), lattice((5, 5, 5), 12e-3)
    return measured(kit, rng, t, at / rng.choice([0.9, 1.15, 1.27]), noise(rng, t.field(kit, at)))


KINDS = {"suitable": (suitable, 12), "saturated probe": (saturated, 3), "one-sided scan": (one_sided, 3), "mixed units": (mixed_units, 3),
         "wrong sign": (wrong_sign, 3), "swapped columns": (swapped, 2), "coarse grid": (coarse, 3), "outliers": (outliers, 3),
         "drift": (drift, 3), "neighbouring magnet": (magnet, 3), "turned stage": (turned, 2), "wrong coils": (wrong_coils, 2),
         "wrong lengths": (stretched, 2)}
