"""Set-up of a simulation from a picture, and calibration of the scale: Figs 3.22, 3.23, table 4.1, Figs 4.7, B.3 to B.7."""

import math

import numpy as np

from reproduce_rows import plot, read
from reproduce_rows.models import frames

STAGES = (("1-grey", "Grey, smoothed"), ("2-edges", "Edges"), ("3-lines", "Hough lines"), ("4-circle", "Circle"))
KERNEL = np.array([[1, 4, 7, 4, 1], [4, 16, 26, 16, 4], [7, 26, 41, 26, 7], [4, 16, 26, 16, 4], [1, 4, 7, 4, 1]])
# Width in µm: the two readings of the thesis in px.
READINGS = {30: (41.42, 40.31), 50: (63.25, 64.19), 70: (87.52, 90.10), 100: (121.44, 122.40), 200: (228.55, 225.66)}


def find_drop(lab, name, picture):
    """Runs `faba drop`; gives the step and figures of all stages, or of the overlay alone if the program has no --stages."""
    stages = ["--stages", f"@{name}/"] if "--stages" in lab.help("drop") else []
    step = lab.call(name, "drop", picture, "--overlay", "@overlay.png", "--force", *stages)
    shown = [plot.picture(title, step.folder / f"{file}.png") for file, title in STAGES if (step.folder / f"{file}.png").exists()]
    return step, shown or [
        plot.picture("Detected edge", step.folder / "overlay.png", "Blue: circle; yellow: edge points; purple: lines.")
    ]


def set_up(lab, found):
    film = lab.run("as-seen", "scenes/as-seen.toml")
    truth = read.scenario(film)["arena"]
    step, shown = find_drop(lab, "drop", str(lab.at("as-seen", "video.avi")))
    a = step.answer
    inside = lab.run("drop-run", "scenes/drop.toml", "--from-video", str(lab.at("as-seen", "video.avi")))
    arena = read.scenario(inside)["arena"]
    places, _ = read.tracks(inside)
    beyond = float(np.max(np.linalg.norm(places - np.array(arena["centre_px"]), axis=2)) - arena["radius_px"])
    found.value = (
        f"radius {a['radius_px']:.1f} ± {a['sd_px']['radius']:.1f} px (true value {truth['radius_px']:g}) from an arc of"
        f" {a['arc_deg']:.0f}°; no simulated cell crosses the edge"
    )
    found.within(
        "Error of the radius divided by its estimated standard deviation",
        abs(a["radius_px"] - truth["radius_px"]) / a["sd_px"]["radius"],
        None,
        3,
        "three standard deviations; the drop of the rendered experiment is known",
    )
    for i, axis in enumerate("xy"):
        found.within(
            f"Error of the centre along {axis} divided by its estimated standard deviation",
            abs(a["center_px"][i] - truth["centre_px"][i]) / a["sd_px"][axis],
            None,
            3,
            "three standard deviations",
        )
    found.within(
        "Maximum distance of a cell beyond the edge, all frames",
        beyond,
        None,
        1e-3,
        "cells cannot cross the edge; positions are stored as 32-bit floats",
        "px",
    )
    found.show(*shown, frames(inside, "Simulation in the detected drop"))


def readings(lab):
    rows = "".join(f"{um},{a},{b}\n" for um, (a, b) in READINGS.items())
    return lab.call("scale", "scale", lab.write("scale", "readings.csv", "width_um,px_1,px_2\n" + rows))


def calibration(lab, found):
    a = readings(lab).answer
    found.value = (
        f"ratios {', '.join(f'{r:.6f}' for r in a['ratios'])}; mean {a['ratio_mean']:.6f}, s.d. {a['ratio_sd']:.6f}; slope of the line"
        f" through the readings {a['um_per_px']:.4f} [{a['ci95'][0]:.3f}, {a['ci95'][1]:.3f}] µm/px"
    )
    digits = "between the printed value and one unit more in its last digit, because the thesis truncates numbers"
    for um, ours, printed in zip(READINGS, a["ratios"], (0.7341, 0.7846, 0.7881, 0.8202, 0.8806)):
        found.within(f"Ratio at {um} µm", ours, printed, printed + 1e-4, digits, "µm/px")
    found.within("Mean", a["ratio_mean"], 0.8015, 0.8016, digits, "µm/px")
    found.within("Standard deviation", a["ratio_sd"], 0.053, 0.054, digits, "µm/px")
    reference = "least squares by another program; half of the last digit"
    found.about("Slope of the line", a["um_per_px"], 0.9164, 0.5e-4, reference, "µm/px")
    found.about("Slope: lower limit of the 95 % interval", a["ci95"][0], 0.892, 0.5e-3, reference, "µm/px")
    found.about("Slope: upper limit of the 95 % interval", a["ci95"][1], 0.942, 0.5e-3, reference, "µm/px")
    found.within(
        "Intercept: lower limit of the 95 % interval",
        a["intercept_ci95_px"][0],
        0,
        None,
        "above zero: all lines are measured too wide by the same amount",
        "px",
    )
    um = np.array(list(READINGS))
    px = np.mean(list(READINGS.values()), axis=1)
    x = np.linspace(0, 210, 50)
    found.show(
        plot.plot(
            "Readings against widths",
            "width (µm)",
            "reading (px)",
            [
                ("dots", "readings", np.repeat(um, 2), np.ravel(list(READINGS.values()))),
                ("line", "line", x, a["intercept_px"] + a["slope_px_per_um"] * x),
                ("dashed", "mean of the ratios", x, x / a["ratio_mean"]),
            ],
            "A line through zero does not fit: it is below the readings of narrow lines and above those of the widest line.",
        ),
        plot.plot(
            "Ratio against width",
            "width (µm)",
            "µm per px",
            [
                ("dots", "width over reading", um, um / px),
                ("line", "from the fitted line", x[8:], x[8:] / (a["intercept_px"] + a["slope_px_per_um"] * x[8:])),
            ],
            "The ratio increases monotonically with the width. Five values in random order form a monotonic sequence with probability 1/60.",
        ),
    )


def ruler(lab, found):
    rng, pitch, turn = np.random.default_rng(2), 9.7, math.radians(6)
    y, x = np.mgrid[0:300, 0:520]
    along = math.cos(turn) * (x - 260) + math.sin(turn) * (y - 150)
    across = math.cos(turn) * (y - 150) - math.sin(turn) * (x - 260)
    k = np.rint(along / pitch)
    reach = np.where(k % 10 == 0, 60, np.where(k % 5 == 0, 45, 30))
    off = np.hypot(along - k * pitch, np.maximum(0, np.abs(across) - reach))
    grey = (200 - 60 * x / 520) * (1 - 0.7 / (1 + np.exp(np.clip(4 * (off - 1.5), -50, 50)))) + rng.normal(0, 4, x.shape)
    file = lab.write("ruler", "ruler.pgm", read.pgm(grey))
    step, table = lab.call("ruler", "scale", file, "--tick", "10 um", "--overlay", "@marks.png", "--force"), readings(lab).answer
    a = step.answer
    twice = math.sqrt(np.mean([(p - q) ** 2 / 2 for p, q in READINGS.values()]))
    found.value = (
        f"repeatability of two readings: s.d. {table['repeatability_px']:.2f} px; synthetic ruler with {pitch} px per mark:"
        f" {a['pitch_px']:.4f} ± {a['pitch_se_px']:.4f} px"
    )
    found.about(
        "Repeatability of the readings of the thesis",
        table["repeatability_px"],
        twice,
        1e-9,
        "square root of the mean of (difference of a pair)² / 2",
        "px",
    )
    found.within(
        "Error of the pitch of a synthetic ruler divided by its standard error",
        abs(a["pitch_px"] - pitch) / a["pitch_se_px"],
        None,
        3,
        "three standard errors; the true pitch is known",
    )
    found.show(plot.picture("Detected marks", step.folder / "marks.png", "A light blue line covers one half of every detected mark.", True))


def kernel(lab, found):
    # The Gaussian of 1 px averaged over each pixel, multiplied by an integer and rounded.
    edges = np.array([0.5 * math.erf((k + 0.5) / math.sqrt(2)) for k in range(-3, 3)])
    weights = np.diff(edges)
    square = np.outer(weights, weights) / np.outer(weights, weights).sum()
    scales = [s for s in range(200, 350) if np.array_equal(np.rint(s * square), KERNEL)]
    one = KERNEL.sum(axis=0) / KERNEL.sum()
    width = math.sqrt(sum(w * k * k for w, k in zip(one, range(-2, 3))))
    found.value = (
        f"sum {KERNEL.sum()}, standard deviation {width:.3f} px; the kernel is the Gaussian of 1 px averaged over each pixel, rounded to"
        f" multiples of 1/{scales[0] if scales else '?'}"
    )
    found.beside = (
        "All values: the kernel of the thesis is compared with a Gaussian in Python. `faba drop` uses a Gaussian of 1 px sampled at"
        " 5 × 5 pixels."
    )
    found.within("Sum of the integers", int(KERNEL.sum()), 273, 273, "the divisor of the kernel")
    found.within("Factors for which the rounded Gaussian equals all 25 integers", len(scales), 1, None, "exact comparison of integers")
    found.about(
        "Standard deviation of the kernel",
        width,
        1,
        0.02,
        "the kernel is truncated to five pixels and rounded to 1/273; the pixel-averaged Gaussian, truncated to five pixels, has 0.99",
        "px",
    )
    k = np.arange(-2, 3)
    g = np.exp(-(k**2) / 2)
    found.show(
        plot.plot(
            "Middle row of the kernel",
            "pixel",
            "weight",
            [("bars", "kernel / 273", k, KERNEL[2] / 273), ("line", "sampled Gaussian", k, np.outer(g, g)[2] / np.outer(g, g).sum())],
            "The kernel averages the Gaussian over each pixel, so its maximum is lower than that of the sampled Gaussian.",
        )
    )


def smoothed(grey):
    padded = np.pad(grey.astype(float), 2, mode="edge")
    return sum(KERNEL[i, j] / 273 * padded[i : i + grey.shape[0], j : j + grey.shape[1]] for i in range(5) for j in range(5))


def hough(lab, found):
    rng, truth, radius = np.random.default_rng(1), np.array([200.0, 300.0]), 420.0
    y, x = np.mgrid[0:480, 0:640]
    grey = 110 + 40 / (1 + np.exp(np.clip(np.hypot(x - truth[0], y - truth[1]) - radius, -50, 50))) + rng.normal(0, 6, x.shape)
    file = lab.write("hough", "made.pgm", read.pgm(grey))
    step, shown = find_drop(lab, "hough", file)
    # The transform of the appendix: each edge pixel votes for the lines through it.
    s = smoothed(grey)
    g2 = (s[:-1, :-1] - s[1:, 1:]) ** 2 + (s[:-1, 1:] - s[1:, :-1]) ** 2
    row, column = np.nonzero(g2 > 6 * g2.mean())
    theta = np.radians(np.arange(-90, 90))
    reach = math.ceil(math.hypot(640, 480))
    votes = np.zeros((2 * reach + 1, len(theta)), int)
    for i, t in enumerate(theta):
        rho = np.rint((column + 0.5) * math.cos(t) + (row + 0.5) * math.sin(t)).astype(int) + reach
        votes[:, i] = np.bincount(rho, minlength=2 * reach + 1)
    off = []
    best = votes.copy()
    for _ in range(10):
        r, t = np.unravel_index(best.argmax(), best.shape)
        line = abs(r - reach - truth[0] * math.cos(theta[t]) - truth[1] * math.sin(theta[t]))
        off.append(abs(line - radius))
        best[max(0, r - 15) : r + 16, max(0, t - 3) : t + 4] = 0
    a = step.answer
    found.value = (
        f"the ten lines with the most votes are tangents of the drop within {max(off):.1f} px; the fitted circle has a radius of"
        f" {a['radius_px']:.1f} ± {a['sd_px']['radius']:.1f} px (true value {radius:g})"
    )
    found.beside = "The transform in (ρ, θ) of the appendix and its ten lines. Edge and circle are computed by the program (`faba drop`)."
    found.within(
        "Ten lines with the most votes: maximum distance to a tangent of the known circle",
        max(off),
        None,
        3,
        "half the width of the edge (1.5 px), half a step of ρ (0.5 px), and the deviation of the arc from a straight line (1 px)",
        "px",
    )
    found.within(
        "Error of the fitted radius divided by its estimated standard deviation",
        abs(a["radius_px"] - radius) / a["sd_px"]["radius"],
        None,
        3,
        "three standard deviations; the true radius is known",
    )
    seen = np.sqrt(votes[reach - 640 : reach + 700].reshape(-1, 4, len(theta)).max(axis=1))
    found.show(
        *shown,
        plot.picture(
            "Votes in (ρ, θ)",
            plot.png(255 - 255 * np.kron(seen, np.ones((1, 3))) / seen.max()),
            "Horizontal: θ from −90° to 89°; vertical: ρ from −640 to 700 px, downwards. Dark: lines with many edge pixels.",
        ),
    )
