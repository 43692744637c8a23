"""Optical-flow activity of rendered experiments: Figs 3.26 to 3.29 and 4.9."""

import math

import numpy as np

from reproduce_rows import plot, read
from reproduce_rows.exposure import FILM, FROM_S, REVERSAL_S, SCENE, a_film
from reproduce_rows.models import frames


def first(lab):
    """One video of a fresh sample, and its measured activity with all pictures."""
    film = lab.all([a_film(lab, 0, 100, True)])[0]
    step = lab.call(
        "activity-first",
        "activity",
        str(lab.at("exposure", "1-100")),
        "--direction",
        "0",
        "--from",
        str(FROM_S),
        "--report",
        "@report.html",
        "--picture",
        "@filtered.png",
        "--out",
        "@series.csv",
        "--force",
        after=[film],
    )
    return film, step


def procedure(lab, found):
    film, step = first(lab)
    a = step.answer["videos"][0]
    pictures = read.frames(film)
    k = round(a["maximum_s"] / a["frame_s"])
    both = [lab.write("procedure", f"{n}.png", p) for n, p in zip(("before", "after"), pictures[k : k + 2])]
    pair = lab.call("procedure", "flow", *both, "--preset", "published", "--out", "@flow.flo", "--picture", "@flow.png", "--force")
    u, v = read.flo(pair.folder / "flow.flo")
    fast = np.hypot(u, v)
    kept = (fast > a["threshold_px"]) & (u >= math.cos(math.radians(45)) * fast)
    recomputed = float((np.abs(u) + np.abs(v))[kept].sum())
    s = read.table(step.folder / "series.csv")
    reported = float(s["activity"][np.abs(s["t0_s"] - k * a["frame_s"]).argmin()])
    found.value = (
        f"activity of one frame pair {reported:.1f} px·px²; recomputed from its flow {recomputed:.1f} px·px²; the filter keeps"
        f" {100 * kept.mean():.1f} % of the pixels"
    )
    found.about(
        "Activity of the frame pair divided by the sum over its filtered flow",
        reported / recomputed,
        1,
        1e-5,
        "both are the same sum; the flow file has 32-bit floats",
    )
    found.within(
        "Fraction of pixels that the filter keeps",
        float(kept.mean()),
        1 / kept.size,
        0.5,
        "at least one pixel and at most half of them: most of the picture has no cells, and noise has all directions",
    )
    found.show(
        plot.picture(
            "Flow before and after filtering",
            step.folder / "filtered.png",
            "The frame pair with the largest activity. Hue: direction; saturation: speed.",
            True,
        ),
        plot.picture("A frame of the rendered experiment", pictures[k]),
        plot.picture("Optical flow from this frame to the next", pair.folder / "flow.png"),
    )


def histograms(lab, found):
    reference, run = lab.all([a_film(lab, 0, 100, True), a_film(lab, 1, 100, True)])
    t0 = [w for n in ("--reference-t0", "--t0") for w in (n, str(REVERSAL_S))]
    step = lab.call(
        "compare-two",
        "compare",
        str(lab.at("exposure", "1-100")),
        str(lab.at("exposure", "2-100")),
        "--direction",
        "0",
        *t0,
        "--duration",
        "6",
        "--report",
        "@report.html",
        "--force",
        after=[reference, run],
    )
    a, page = step.answer, step.folder / "report.html"
    mean = a["runs"][0]["mean"]
    found.value = (
        f"mean distance {mean:.2f}; between two runs of one scenario {a['floor']:.2f}; to a video without motion {a['naive']:.2f}"
    )
    found.within(
        "Mean distance", mean, None, a["naive"], "smaller than the distance to a video without motion: the simulation is informative"
    )
    found.within(
        "Floor", a["floor"], None, a["naive"], "two runs of one scenario are closer to each other than to a video without motion"
    )
    found.show(
        read.figure(page, "Reference", "Flow of the experiment"),
        read.figure(page, "Run", "Flow of the simulation"),
        read.figure(page, "Flow by column", "Sums over columns"),
        read.figure(page, "Flow by row", "Sums over rows"),
        read.figure(page, "Distance between the flows over time"),
    )


def signature(lab, found):
    film, step = first(lab)
    plain = lab.all([a_film(lab, 0, 100, False)])[0]
    a = step.answer["videos"][0]
    truth = lab.call(
        "activity-first-plain",
        "activity",
        str(lab.at("exposure", "1-100-plain")),
        "--direction",
        "0",
        "--from",
        str(FROM_S),
        "--flow-threshold",
        repr(a["threshold_px"]),
        after=[plain],
    ).answer["videos"][0]["gaussian"]
    g = a["gaussian"]
    found.value = (
        f"(1) onset {a['onset_s'] - REVERSAL_S:.2f} s, (2) maximum {a['maximum_s'] - REVERSAL_S:.2f} ± {g['se_peak_s']:.2f} s, (3) departure"
        f" {a['departure_s'] - REVERSAL_S:.2f} s after the field reversal"
        if g["good"]
        else "no Gaussian fits"
    )
    found.true("A Gaussian fits", g["good"], "expected for a sample that responds")
    found.true(
        "Order in time: onset, maximum, departure; the maximum is after the field reversal",
        bool(g["good"]) and a["onset_s"] < a["maximum_s"] < a["departure_s"] and a["maximum_s"] > REVERSAL_S,
        "definition of the three points",
    )
    error = math.hypot(g["se_peak_s"], truth["se_peak_s"])
    found.about(
        "Time of the maximum with camera noise minus the time without it",
        g["peak_s"] - truth["peak_s"],
        0,
        3 * error,
        "the same cells rendered without camera noise; three standard errors",
        "s",
    )
    found.note.append(
        "Onset and departure are the times at which the Gaussian has 10 % of its height. Activity rises faster than a Gaussian, so the onset"
        " can be before the field reversal."
    )
    found.show(
        wide(read.figure(step.folder / "report.html", "1-100", "Activity after the field reversal at 20 s")),
        frames(film, "The rendered experiment"),
    )


def wide(markup):
    return markup and markup.replace("<figure>", '<figure class="wide">', 1)


def dead_sample(lab):
    """Cells that do not swim: the rendered video and its measured activity."""
    film = lab.run("exposure/dead", SCENE, *FILM, "exposure=900 s", "swarm[0].count=240", "swarm[0].model.motile=0")
    return film, lab.call(
        "activity-dead",
        "activity",
        str(lab.at("exposure", "dead")),
        "--direction",
        "0",
        "--from",
        str(FROM_S),
        "--report",
        "@report.html",
        "--force",
        after=[film],
    )


def dead(lab, found):
    film, step = dead_sample(lab)
    live = first(lab)[1].answer["videos"][0]
    a = step.answer["videos"][0]
    found.value = (
        f"mean activity {a['mean_activity']:.0f} px·px² (fresh sample: {live['mean_activity']:.0f});"
        f" {a['gaussian']['reason'] or 'a Gaussian fits'}"
    )
    found.true("No Gaussian fits", not a["gaussian"]["good"], "cells that do not swim give no peak of activity")
    found.true("No response", not a["responds"], "no cell swims")
    found.within(
        "Mean activity divided by that of a fresh sample",
        a["mean_activity"] / live["mean_activity"],
        None,
        1,
        "only camera noise and diffusion contribute",
    )
    found.show(wide(read.figure(step.folder / "report.html", "dead", "A dead sample")), frames(film, "Cells that do not swim"))
