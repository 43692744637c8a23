"""What a video's flow says of it: Figs 3.26 to 3.29 and 4.9, on rendered experiments."""

import math

import numpy as np

from reproduce_rows import plot, read
from reproduce_rows.exposure import FILM, FROM_S, REVERSAL_S, SCENE, a_film
from reproduce_rows.models import frames


def first(lab):
    """One video of a fresh sample, its activity with all pictures."""
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
    own = float((np.abs(u) + np.abs(v))[kept].sum())
    s = read.table(step.folder / "series.csv")
    told = float(s["activity"][np.abs(s["t0_s"] - k * a["frame_s"]).argmin()])
    found.value = (
        f"activity of one pair of frames {told:.1f} px·px²; summed here from its flow {own:.1f}; {100 * kept.mean():.1f} % of the pixels"
        " are kept"
    )
    found.about(
        "Activity of the pair over the sum over its filtered flow",
        told / own,
        1,
        1e-5,
        "the same sum twice; the file of the flow has 32-bit floats",
    )
    found.within(
        "Share of pixels that the filter keeps",
        float(kept.mean()),
        1 / kept.size,
        0.5,
        "some, and fewer than half: noise has any direction, and most of the view is empty",
    )
    found.show(
        plot.picture(
            "Flow before and after filtering",
            step.folder / "filtered.png",
            "The pair of frames with the most flow. Hue: direction; strength: speed.",
            True,
        ),
        plot.picture("A frame of the rendered experiment", pictures[k]),
        plot.picture("Its flow to the next one", pair.folder / "flow.png"),
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
        f"distance {mean:.2f}; between two runs of one scenario {a['floor']:.2f}, to a video in which nothing moves {a['naive']:.2f}"
    )
    found.within(
        "Distance", mean, None, a["naive"], "nearer than a video in which nothing moves: the simulation shows some of the experiment"
    )
    found.within("Floor", a["floor"], None, a["naive"], "two runs of one scenario are nearer to each other than to nothing")
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
        f"(1) {a['onset_s'] - REVERSAL_S:.2f} s, (2) {a['maximum_s'] - REVERSAL_S:.2f} ± {g['se_peak_s']:.2f} s, (3)"
        f" {a['departure_s'] - REVERSAL_S:.2f} s after the reversal"
        if g["good"]
        else "no Gaussian"
    )
    found.true("A Gaussian fits", g["good"], "as it does for a sample that responds")
    found.true(
        "Onset, maximum, leaving in this order, the maximum after the reversal",
        bool(g["good"]) and a["onset_s"] < a["maximum_s"] < a["departure_s"] and a["maximum_s"] > REVERSAL_S,
        "what the three points mean",
    )
    error = math.hypot(g["se_peak_s"], truth["se_peak_s"])
    found.about(
        "Maximum with noise less without",
        g["peak_s"] - truth["peak_s"],
        0,
        3 * error,
        "the same cells rendered without the camera's noise; three standard errors",
        "s",
    )
    found.note.append(
        "Onset and leaving are where the Gaussian is at a tenth of its height. Activity rises faster than a Gaussian does, so that the"
        " onset may lie before the reversal."
    )
    found.show(
        wide(read.figure(step.folder / "report.html", "1-100", "Activity after the reversal at 20 s")),
        frames(film, "The rendered experiment"),
    )


def wide(markup):
    return markup and markup.replace("<figure>", '<figure class="wide">', 1)


def dead_sample(lab):
    """Cells that do not swim: the film and its activity."""
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
        f"mean activity {a['mean_activity']:.0f} px·px² ({live['mean_activity']:.0f} when fresh);"
        f" {a['gaussian']['why'] or 'a Gaussian fits'}"
    )
    found.true("No Gaussian fits", not a["gaussian"]["good"], "nothing rises and falls where nothing swims")
    found.true("No response", not a["responds"], "none of the cells swims")
    found.within(
        "Mean activity over that of a fresh sample",
        a["mean_activity"] / live["mean_activity"],
        None,
        1,
        "a floor: what noise and diffusion make of it",
    )
    found.show(wide(read.figure(step.folder / "report.html", "dead", "A dead sample")), frames(film, "Cells that do not swim"))
