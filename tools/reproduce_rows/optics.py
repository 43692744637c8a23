"""Field of view of the two objectives: section 4.1.1."""

import numpy as np

from reproduce_rows import read
from reproduce_rows.models import frames

VIEW = (640, 480)
FOLLOWED_S = 1.3  # after the field reversal: the end of the part in which `faba activity` measures the speed
# Changes of scenes/as-seen.toml, which has the scale of the objective 10x: the same drop and swarm in a picture of ten times the scale.
AT_100X = (
    "scale.um_per_px=0.08015",
    "arena.radius_px=11000",
    "arena.centre_px=[11080, 240]",
    'swarm[0].start={type="edge", direction="180 deg", visible=true, depth_px=200}',
    'microscope.psf_sd="0.0825 um"',
    "record.tracks=true",
)


def still_in_view(step):
    """Fraction of the cells of the view at the field reversal that are in view FOLLOWED_S later."""
    places, t = read.tracks(step)
    view = ((places > -0.5) & (places < np.array(VIEW) - 0.5)).all(axis=-1)
    first, last = (int(np.abs(t - s).argmin()) for s in (1, 1 + FOLLOWED_S))
    return float((view[first] & view[last]).sum() / view[first].sum())


def objectives(lab, found):
    ten, hundred = (s.answer for s in lab.all([(f"optics-{o}", "optics", "--objective", o) for o in ("10x", "100x")]))
    videos = lab.all(
        [
            lab.a_run("optics-video-10x", "scenes/as-seen.toml", "scale.um_per_px=0.8015", "record.tracks=true"),
            lab.a_run("optics-video-100x", "scenes/as-seen.toml", *AT_100X),
        ]
    )
    speeds = [s.answer["videos"][0]["speed_um_per_s"] for s in lab.all([(f"{v.folder.name}-speed", "activity", str(v.folder)) for v in videos])]
    seen = [still_in_view(v) for v in videos]
    swarm = [next(v for v in plan["verdicts"] if v["measurement"] == "swarm") for plan in (ten, hundred)]
    found.value = (
        f"10x: {ten['view_um'][0]:.0f} × {ten['view_um'][1]:.0f} µm, a cell crosses it in {ten['crossing_time_s']:.1f} s; 100x:"
        f" {hundred['view_um'][0]:.0f} × {hundred['view_um'][1]:.0f} µm, {hundred['crossing_time_s']:.2f} s; a swarm needs"
        f" {ten['gathering_time_s']:.1f} s; {FOLLOWED_S} s after the field reversal {100 * seen[0]:.0f} % and {100 * seen[1]:.0f} % of a"
        " rendered swarm are in view"
    )
    found.chosen = "Drop with a radius of 0.88 mm. The scale at 100x, which the thesis did not measure, is a tenth of that at 10x."
    half = "640 px times 0.8015 µm/px (table 4.1), half of the last digit"
    found.about("Width of the view, 10x", ten["view_um"][0], 512.96, 0.005, half, "µm")
    found.about("Width of the view, 100x", hundred["view_um"][0], 51.296, 0.0005, "a tenth of it", "µm")
    found.within("Width of a cell, 10x", ten["cell_px"], 1, 3, "section 4.1.4: a bacterium has one to three pixels", "px")
    found.within(
        "Time of a swarm to gather", ten["gathering_time_s"], 3.5, 4.6, "section 4.3: 4 s until the swarm is in its corner (Fig 4.17)", "s"
    )
    found.true("10x: the swarm forms in view", swarm[0]["quality"] == "good", swarm[0]["evidence"])
    found.true("100x: cells leave the view before the swarm forms", swarm[1]["quality"] == "poor", swarm[1]["evidence"])
    found.within("10x: fraction of the swarm that is followed", seen[0], 0.5, 1, "most of a rendered swarm is in view while its speed is measured")
    found.within("100x: fraction of the swarm that is followed", seen[1], 0, 0.05, "a rendered swarm has left the view")
    found.true("10x: the speed of the swarm is measured", speeds[0] is not None, "`faba activity` of the rendered video")
    found.true("100x: no speed is measured", speeds[1] is None, "the swarm has left the view before")
    found.show(*(frames(v, f"Rendered step response, {o}") for v, o in zip(videos, ("10x", "100x"))))
