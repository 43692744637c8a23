"""Step responses in camera frames: Figs 3.24, 3.25, 4.8."""

import numpy as np

from reproduce_rows import read
from reproduce_rows.models import frames


def step_input(lab, found):
    step = lab.run("step-response", "scenes/step-response.toml")
    s, scene = read.series(step), read.scenario(step)
    places, t = read.tracks(step)
    um, rate = scene["scale"]["um_per_px"], float(scene["camera"]["rate"].split()[0])
    after = int((s["t_s"] >= 1 - 1e-9).sum())
    # From 0.34 s after the field reversal, when all cells have turned, to 1.54 s, when no cell has reached the opposite edge.
    a, b = (int(np.abs(t - w).argmin()) for w in (1.34, 2.54))
    speed = (places[b, :, 0] - places[a, :, 0]) * um / (t[b] - t[a])
    mean, error = float(speed.mean()), float(speed.std(ddof=1) / np.sqrt(len(speed)))
    before, then = s["field_x_ut"][int(0.5 * rate)], s["field_x_ut"][int(1.5 * rate)]
    found.value = (
        f"the field changes from {before / 1000:+.1f} to {then / 1000:+.1f} mT after 1 s; the swarm leaves the edge at {mean:.0f} ±"
        f" {error:.0f} µm/s; {after} frames after the field reversal"
    )
    found.about(
        "Speed at which the swarm leaves the edge",
        mean,
        186,
        4 * error,
        "mean speed of the cells when aligned with the field, 186 µm/s, within four standard errors",
        "µm/s",
    )
    found.within("Frames after the field reversal", after, 89, 91, "6 s at 15 Hz, about 90 frames", "")
    found.about("Field after the reversal divided by the field before", float(then / before), -1, 1e-6, "same strength, opposite direction")
    found.show(
        read.figure(step.folder / "report.html", "Magnetic field", "Step input"),
        read.figure(step.folder / "report.html", "Path in the picture", "Centroid of the swarm"),
        frames(step, "Step response"),
    )


def response_frames(lab, found):
    # The field is reversed at the first frame, so times count from the reversal.
    step = lab.run("step-frames", "scenes/as-seen.toml", 'controller={type="manual", field=["-1 mT", "0 T"]}', "--duration", "4.2 s")
    s = read.series(step)
    visible = s["visible_count"][-1] / s["visible_count"][0]
    moved = s["true_centroid_x_px"][-1] - s["true_centroid_x_px"][0]
    found.value = f"frames from 0 to {s['t_s'][-1]:.2f} s; {100 * visible:.0f} % of the cells are in view at the end"
    found.about("Time of the last frame", float(s["t_s"][-1]), 4.16, 1 / 15, "time of the last frame of the figure, within one frame", "s")
    found.within("Fraction of the cells in view at the end", float(visible), None, 0.5, "at least half of the cells leave the field of view")
    found.within("Displacement of the centroid to the right", float(moved), 0, None, "the swarm moves away from the edge", "px")
    found.show(frames(step, "Step response in camera frames"))
