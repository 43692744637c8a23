"""The two published models and the box: eq. 3.1, section 3.3.3.3, Fig 3.21."""

import math

import numpy as np

from reproduce_rows import plot, read, stats

SCENE = "scenes/corner.toml"
FREE = ("exclusion.order=none", "arena.size_px=[4000, 3000]", "record.video=false")  # without walls and exclusion
UNIT_UT = 23


def steps_of(step):
    """Displacements per iteration, y up. A velocity is kept for two iterations: the first displacement of each draw, shape (draws, 2),
    and both displacements, shape (pairs, 2, cells, 2)."""
    places, _ = read.tracks(step)
    moves = np.diff(places, axis=0) * (1, -1)
    pairs = moves[: len(moves) // 2 * 2].reshape(-1, 2, *moves.shape[1:])
    return pairs[:, 0].reshape(-1, 2), pairs


def basic(lab, found):
    n, m = 8, np.array([3.0, 2.0])
    # South-seeking cells drift against the field: minus one field unit for each px per iteration.
    field = f'controller.field=["{-UNIT_UT * m[0]:g} uT", "{-UNIT_UT * m[1]:g} uT"]'
    step = lab.run("basic-steps", SCENE, field, "swarm[0].count=2000", *FREE, "--duration", "6.8 s")
    draws, pairs = steps_of(step)
    k = np.rint(draws - m).astype(int)
    count, per_axis = len(draws), []
    for axis, name in enumerate("xy"):
        seen = np.array([(k[:, axis] == v).sum() for v in range(-n, n + 1)])
        expected = count / (2 * n + 1)
        p = stats.chi_square_p(((seen - expected) ** 2 / expected).sum(), 2 * n)
        mean, variance = draws[:, axis].mean(), draws[:, axis].var(ddof=1)
        # Of a uniform law on -n..n: variance v = n(n+1)/3 and fourth moment v (3n(n+1)-1)/5.
        v = n * (n + 1) / 3
        fourth = v * (3 * n * (n + 1) - 1) / 5
        per_axis.append((name, seen, mean, variance, p))
        found.about(
            f"Mean step along {name}",
            mean,
            m[axis],
            4 * math.sqrt(v / count),
            f"commanded drift m, within four standard errors of {count} draws",
            "px/it",
        )
        found.about(
            f"Variance along {name}",
            variance,
            v,
            4 * math.sqrt((fourth - v * v) / count),
            "n(n+1)/3 with n = 8, within four standard errors",
            "px²/it²",
        )
        found.within(
            f"p of a chi-square test of the {2 * n + 1} integers along {name}",
            p,
            1e-3,
            None,
            "no significant deviation from the uniform distribution",
        )
    found.within(
        "Maximum distance of step − m to an integer",
        float(np.abs(draws - m - k).max()),
        None,
        1e-3,
        "a step is the difference of two positions stored as 32-bit floats, with a spacing of 1.2e-4 px at 2000 px",
        "px",
    )
    found.within(
        "Maximum difference between the two iterations of a draw",
        float(np.abs(pairs[:, 0] - pairs[:, 1]).max()),
        None,
        1e-3,
        "velocities are drawn every second iteration",
        "px",
    )
    found.value = (
        f"k + m with k uniform on −8…8 (p = {per_axis[0][4]:.2f} and {per_axis[1][4]:.2f}); mean ({per_axis[0][2]:.2f},"
        f" {per_axis[1][2]:.2f}) px/it, variance {per_axis[0][3]:.2f} and {per_axis[1][3]:.2f} px²/it²"
    )
    found.note.append(
        "The maximum speed of the thesis is a noise amplitude: the mean velocity of the swarm is m. Because steps are integers, the"
        " identified value 8.1181 is equivalent to 8."
    )
    at = np.arange(-n, n + 1)
    for axis, (name, seen, *_) in enumerate(per_axis):
        found.show(
            plot.plot(
                f"Steps along {name}",
                f"step along {name} (px per iteration)",
                "draws",
                [("bars", "observed", at + m[axis], seen), ("dashed", "uniform", at + m[axis], np.full(len(at), count / (2 * n + 1)))],
                f"{count} draws with n = 8 and m = {m[axis]:g}.",
            )
        )


def adapted(lab, found):
    n = 9
    model = 'swarm[0].model={type="adapted", max_speed=9%s}'
    common = ("swarm[0].count=4000", *FREE)
    field = 'controller.field=["%g uT", "0 uT"]'
    full, bare, half = lab.all(
        [
            lab.a_run("adapted-steps", SCENE, model % "", field % (-5 * UNIT_UT), *common, "--duration", "6.8 s"),
            lab.a_run("adapted-bare", SCENE, model % ", noise_amplitude=0", field % (-5 * UNIT_UT), *common, "--duration", "0.2 s"),
            lab.a_run("adapted-half", SCENE, model % ", noise_amplitude=0", field % (-2.5 * UNIT_UT), *common, "--duration", "0.2 s"),
        ]
    )
    draws, _ = steps_of(full)
    innate, weak = steps_of(bare)[0], steps_of(half)[0]
    along = np.array([5, 1]) / math.sqrt(26)
    places, _ = read.tracks(full)
    speeds = (places[-1] - places[0]) / (len(places) - 1) @ (along * (1, -1))  # mean speed of each cell along the field
    drift, error = stats.mean_and_error(speeds)
    speed = np.linalg.norm(innate, axis=1)
    unresponsive = float((speed < 0.5).mean())
    tilt = [math.degrees(math.atan2(s[:, 1].sum(), s[:, 0].sum())) for s in (innate, weak)]
    expected = 1 / (n + 1)
    across = draws @ np.array([-along[1], along[0]])
    v = n * (n + 1) / 3
    found.value = (
        f"mean drift {drift:.2f} ± {error:.2f} px/it at 5 field units; {100 * unresponsive:.1f} % of the cells do not respond; "
        f"tilt {tilt[0]:.2f}° at 5 units and {tilt[1]:.2f}° at 2.5 units"
    )
    found.about(
        "Mean drift along the field", drift, n / 2, 4 * error, "speeds uniform on 0 to n: mean n/2, within four standard errors", "px/it"
    )
    found.about(
        "Mean drift at half the field divided by the drift at the full field",
        float(np.linalg.norm(weak.mean(0)) / np.linalg.norm(innate.mean(0))),
        1,
        1e-3,
        "the field determines only the direction; cells and speeds are the same",
    )
    found.about(
        "Fraction of cells with speed zero",
        unresponsive,
        expected,
        4 * math.sqrt(expected * (1 - expected) / len(speed)),
        "1/(n+1), within four standard errors for 4000 cells",
    )
    found.about(
        "Tilt by the Earth's field at 5 units",
        tilt[0],
        math.degrees(math.atan2(1, 5)),
        0.01,
        "one unit along y and five along x; steps have an error of 1e-4 px",
        "°",
    )
    found.about(
        "Tilt by the Earth's field at 2.5 units",
        tilt[1],
        math.degrees(math.atan2(1, 2.5)),
        0.01,
        "one unit along y and 2.5 along x",
        "°",
    )
    found.about(
        "Variance across the field",
        float(across.var()),
        v,
        4 * v * math.sqrt(2 / len(across)),
        "variance of the \u201cinertia\u201d noise, n(n+1)/3, within four standard errors",
        "px²/it²",
    )
    found.note.append(
        "The thesis states that the resulting speed of a cell is constant, but adds a noise as large as the speed. The option"
        " `noise_amplitude` selects either; the default is the noise, as published."
    )
    found.show(
        plot.plot(
            "Speeds of the cells",
            "speed (px per iteration)",
            "cells",
            [("bars", "cells", np.arange(n + 1), np.bincount(np.rint(speed).astype(int), minlength=n + 1))],
            "Speed of each cell without noise. Cells with speed zero do not respond.",
        )
    )


def constrained(lab, found):
    step = lab.run("basic-film", "scenes/thesis-basic.toml")
    places, _ = read.tracks(step)
    scene = read.scenario(step)["arena"]
    width, height = scene["size_px"]
    outside = int(((places < -0.5) | (places > np.array([width, height]) - 0.5)).any(axis=2).sum())
    squares = np.floor(places + 0.5).astype(int)
    shared = sum(len(f) - len(np.unique(f[:, 0] * 100_000 + f[:, 1])) for f in squares)
    found.value = (
        f"{places.shape[1]} cells in {len(places)} frames of {width:g} × {height:g} px: {outside} outside the box, {shared} on an occupied"
        " site"
    )
    found.within("Cells outside the box, all frames", outside, 0, 0, "no cell leaves the grid")
    found.within("Cells on a site that another cell occupies, all frames", shared, 0, 0, "at most one cell per pixel")
    found.show(frames(step, "Frames of the run", "Green cross: centroid of the swarm; purple cross: setpoint."))


def frames(step, title, caption=None):
    """The frames of the video from the report; the figure of the path if the report has no frames."""
    page = step.folder / "report.html"
    found = read.figure(page, "Frames", title, caption) or read.figure(page, "Path in the picture", title)
    return found.replace("<figure>", '<figure class="wide">', 1) if "<img" in found else found
