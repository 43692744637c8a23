"""The two published models and the box they live in: eq. 3.1, section 3.3.3.3, Fig 3.21."""

import math

import numpy as np

from reproduce_rows import plot, read, stats

SCENE = "scenes/corner.toml"
FREE = ("exclusion.order=none", "arena.size_px=[4000, 3000]", "record.video=false")  # no walls and no crowding in the way
UNIT_UT = 23


def steps_of(step):
    """Displacements of the cells per iteration, y up, one for each draw (velocities are kept for two iterations), and both of a draw."""
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
            f"the drift m that is commanded, within four standard errors of {count} draws",
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
            f"Chi-square of the {2 * n + 1} whole numbers along {name}, p",
            p,
            1e-3,
            None,
            "all alike: a p below 1 in 1000 would say otherwise",
        )
    found.within(
        "Largest distance of step − m to a whole number",
        float(np.abs(draws - m - k).max()),
        None,
        1e-3,
        "places are kept as 32-bit floats, 1.2e-4 px apart at 2000 px, and a step has two",
        "px",
    )
    found.within(
        "Largest difference between the two iterations of a draw",
        float(np.abs(pairs[:, 0] - pairs[:, 1]).max()),
        None,
        1e-3,
        "velocities are redrawn every second iteration",
        "px",
    )
    found.value = (
        f"k + m with k in −8…8, all alike (p = {per_axis[0][4]:.2f} and {per_axis[1][4]:.2f}); mean ({per_axis[0][2]:.2f},"
        f" {per_axis[1][2]:.2f}), variance {per_axis[0][3]:.2f} and {per_axis[1][3]:.2f} px²/it²"
    )
    found.note.append(
        "What the thesis calls maximum speed is the amplitude of a noise: the swarm drifts with m alone, and the 8.1181 found later can"
        " only have been used as 8."
    )
    at = np.arange(-n, n + 1)
    for axis, (name, seen, *_) in enumerate(per_axis):
        found.show(
            plot.plot(
                f"Steps along {name}",
                f"step along {name} (px per iteration)",
                "draws",
                [("bars", "seen", at + m[axis], seen), ("dashed", "all alike", at + m[axis], np.full(len(at), count / (2 * n + 1)))],
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
    way = np.array([5, 1]) / math.sqrt(26)
    places, _ = read.tracks(full)
    own = (places[-1] - places[0]) / (len(places) - 1) @ (way * (1, -1))  # mean speed of each cell along the field
    drift, error = stats.mean_and_error(own)
    speed = np.linalg.norm(innate, axis=1)
    still = float((speed < 0.5).mean())
    tilt = [math.degrees(math.atan2(s[:, 1].sum(), s[:, 0].sum())) for s in (innate, weak)]
    share = 1 / (n + 1)
    across = draws @ np.array([-way[1], way[0]])
    v = n * (n + 1) / 3
    found.value = (
        f"drift {drift:.2f} ± {error:.2f} px/it at 5 units, {100 * still:.1f} % of the cells do not respond, "
        f"tilted by {tilt[0]:.2f}° (5 units) and {tilt[1]:.2f}° (2.5 units)"
    )
    found.about("Mean drift along the field", drift, n / 2, 4 * error, "speeds 0 to n, all alike: n/2 within four standard errors", "px/it")
    found.about(
        "Mean drift at half the field, over that",
        float(np.linalg.norm(weak.mean(0)) / np.linalg.norm(innate.mean(0))),
        1,
        1e-3,
        "the field sets the direction only; same cells, same speeds",
    )
    found.about(
        "Share of cells of speed zero",
        still,
        share,
        4 * math.sqrt(share * (1 - share) / len(speed)),
        "1/(n+1) within four standard errors of 4000 cells",
    )
    found.about(
        "Tilt by the Earth at 5 units",
        tilt[0],
        math.degrees(math.atan2(1, 5)),
        0.01,
        "one unit along y on five along x; steps are good to 1e-4 px",
        "°",
    )
    found.about("Tilt by the Earth at 2.5 units", tilt[1], math.degrees(math.atan2(1, 2.5)), 0.01, "one on two and a half", "°")
    found.about(
        "Variance across the field",
        float(across.var()),
        v,
        4 * v * math.sqrt(2 / len(across)),
        "the \u201cinertia\u201d noise, n(n+1)/3, within four standard errors",
        "px²/it²",
    )
    found.note.append(
        "The thesis says that the resulting speed is always the same, and adds a noise as large as the speed; both are options here"
        " (`noise_amplitude`), with the published one the default."
    )
    found.show(
        plot.plot(
            "Innate speeds",
            "speed (px per iteration)",
            "cells",
            [("bars", "cells", np.arange(n + 1), np.bincount(np.rint(speed).astype(int), minlength=n + 1))],
            "Without the noise every cell's own speed shows; zero is the cell that does not respond.",
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
        f"{places.shape[1]} cells in {len(places)} frames of {width:g} × {height:g} px: {outside} outside, {shared} on a square that is"
        " taken"
    )
    found.within("Cells outside of the box, all frames", outside, 0, 0, "nobody leaves the grid")
    found.within("Cells on a square that another one has", shared, 0, 0, "one cell per pixel at most")
    found.show(frames(step, "Frames of the run", "The green cross is the swarm's mean, the purple one the setpoint."))


def frames(step, title, caption=None):
    """The report's pictures of the video; its path where the program does not make them."""
    page = step.folder / "report.html"
    found = read.figure(page, "Frames", title, caption) or read.figure(page, "Path in the picture", title)
    return found.replace("<figure>", '<figure class="wide">', 1) if "<img" in found else found
