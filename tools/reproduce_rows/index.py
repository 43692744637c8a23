"""Every result of the thesis that software can reproduce, in its order: what it shows, its value, the verdict it is to get, and why."""

import dataclasses

from reproduce_rows import activity, control, exposure, fields, flow, identification, models, pictures, structure, videos
from reproduce_rows.check import CORRECTED, SAME, VIDEOS


@dataclasses.dataclass
class Row:
    """`work(lab, found)` computes it; `seconds` is about how long that takes on two cores, for the time that is left."""

    item: str
    shows: str
    thesis: str
    verdict: str
    reason: str
    work: object
    seconds: float = 3


NO_VIDEO = ("The thesis's videos are not public, so its number cannot be had again; the same procedure on rendered experiments "
            "gives back what is known of them.")

ROWS = [
    Row("Fig 3.10", "The simulator's modules", "Window, data, bacteria (Basic, Adapted), field, controller, analysis", SAME,
        "Each module has its part here; what depends on what is held by a test.", structure.modules),
    Row("Eq 3.1", "The Basic model", "Step per axis: randi(2ρ + 1) − ρ − 1 + m", SAME,
        "Steps are a whole number, all from −ρ to ρ alike, plus the commanded drift.", models.basic, 4),
    Row("3.3.3.3", "The Adapted model",
        "Four rules: direction by the field, cells that differ, innate speeds, a little inertia; the Earth adds one unit along y", SAME,
        "All four hold, with the Earth's tilt and the share of cells that do not respond as the rules imply.", models.adapted, 6),
    Row("Fig 3.11", "Both coils push the same way", "Field lines cross the sample in one direction", SAME,
        "One direction all over the sample.", fields.concurring),
    Row("Fig 3.12", "The coils against each other", "A zero of the field between them, at which a swarm is to gather", CORRECTED,
        "The zero is there, but it is a saddle: without divergence and curl a field that draws cells in along the coils' axis drives them"
        " out across it. Two coils gather no swarm.",
        fields.opposed),
    Row("Fig 3.13", "A computed field with a zero", "Field lines for one set of currents", SAME,
        "Unequal currents move the zero as the reference computation says.", fields.computed),
    Row("Fig 3.14", "The library of fields", "Computed and stored beforehand; loaded, and the field with the nearest zero applied", SAME,
        "The same four steps, and in every frame the nearest entry is in use. Solving for the currents makes them unnecessary.",
        fields.library, 12),
    Row("Fig 3.15, 3.16", "Open loop (gradient) and closed loop (fuzzy)", "Block diagrams of the two", SAME,
        "Both loops run, and bring the swarm to its setpoints.", control.loops, 10),
    Row("Fig 3.18", "Memberships “close” and “far”", "Two trapezoids, whose breakpoints only the figure shows", SAME,
        "Two complementary trapezoids. Their breakpoints, 40 and 120 px, are assumed, and the program says so.", control.memberships),
    Row("Eq 3.2, Fig 3.19", "Output of the fuzzy controller",
        "Half of the maximum near the setpoint, all of it far away, weighted means between", SAME,
        "The weighted mean of the rules, to the last digit recorded.", control.sugeno),
    Row("Fig 3.20", "The main window",
        "Model, controller, number of cells, largest speed, setpoint, recording, field model, manual field", SAME,
        "`faba lab` has all of it on a page in the browser, and every other value of a scenario beside it.", structure.window, 8),
    Row("Fig 3.21", "Simulation in a box", "All cells in view, nobody crosses the limits; crosses at the mean and the setpoint", SAME,
        "Nobody leaves the box and no pixel holds two cells, in any frame.", models.constrained),
    Row("Fig 3.22, 3.23", "Set-up from an experiment's picture", "Grey, edges, Hough lines, circle, then a simulation inside it", SAME,
        "The same stages on a rendered experiment give its drop back, and cells stay in it. The circle is fitted to all pixels of the "
        "edge, not to the ends of lines, which on short arcs is far surer.",
        pictures.set_up, 12),
    Row("Fig 3.24, 3.25", "Step input and step response", "The swarm leaves the edge after the reversal; 6 s, about 90 frames", SAME,
        "The field steps, and the swarm leaves the edge at its cells' speed.", videos.step_input, 4),
    Row("Fig 3.26, 3.27", "How activity is measured", "Optical flow before and after the filter", VIDEOS,
        "The procedure on a rendered experiment, and its sum repeated outside of the program.", activity.procedure, 6),
    Row("Fig 3.28, 3.29", "Flow of experiment and simulation", "Filtered flow and its sums over columns and rows", VIDEOS,
        "Shown on two rendered experiments. The thesis calls the sums derivatives, which they are not.", activity.histograms, 12),
    Row("Fig 3.30", "The sweep of parameters", "Five values, three simulations of each, per model against one reference video", VIDEOS,
        "The same sweep with the thesis's values, three rendered experiments and both models.", identification.sweep, 110),
    Row("Fig 3.31", "Baseline and fitted line", "A video against itself: a = b = 0", SAME,
        "Exactly zero, and lines are those of least squares.", identification.baseline),
    Row("Fig 3.32", "Difference of Basic at 1 and 20", "Slopes 0.1943 and −0.0381", VIDEOS,
        "The same procedure on rendered experiments; what the slopes come to is the videos', not the parameter's alone.",
        identification.two_series),
    Row("Fig 3.33", "Slopes against the parameter", "Where their line crosses zero is taken for the parameter", CORRECTED,
        "A difference that is large from the first frame to the last has slope zero, too, so that the crossing does not mark the truth. "
        "The thesis's two printed slopes alone cross at 16.89, not at 8.12.",
        identification.crossing),
    Row("Fig 3.34", "The loop of improvement", "Experiment, models, difference, best model, controller, and back", SAME,
        "`identify` names the model of a rendered experiment, and controllers are compared in the scene that it writes.",
        identification.loop, 40),
    Row("Fig 4.5 a-d", "Four configurations of the coils",
        "One swarm (a, b), a swarm in the middle (c), two swarms (d); the rig did not show c and d", CORRECTED,
        "a and b are as published. c cannot be: the zero of two coils is a saddle, which splits a swarm. d needs equal currents and no "
        "Earth: a tenth of difference and 18 µT move the zero out of the drop, as the rig showed.",
        fields.four_configurations, 16),
    Row("Table 4.1", "Calibration of the camera", "0.7341, 0.7846, 0.7881, 0.8202, 0.8806; mean 0.8015, s.d. 0.053 µm/px", CORRECTED,
        "The ratio rises with the width: every line reads some 10 px too wide. The slope of a line through the same readings is free of "
        "that.",
        pictures.calibration),
    Row("Fig 4.7", "A line of the ruler, measured twice", "Two readings of each width", SAME,
        "The readings' repeatability, and a made ruler of known pitch given back.", pictures.ruler),
    Row("Fig 4.8", "Frames of the step response", "From 0 to 4.16 s", VIDEOS,
        "A rendered experiment shows the same: the pile at the edge dissolves and leaves the view.", videos.response_frames, 4),
    Row("Fig 4.9 a", "Activity of one video", "(1) onset, (2) maximum, (3) the swarm leaves; a Gaussian", VIDEOS, NO_VIDEO,
        activity.signature, 5),
    Row("Fig 4.9 b", "Activity of a dead sample", "Mean 0.83e4, no Gaussian fits", VIDEOS,
        "The floor is made by the camera's noise, which differs from camera to camera; that no Gaussian fits is the same.",
        activity.dead, 5),
    Row("Fig 4.10-4.12", "Several videos of one experiment, then four experiments together", "The procedure", VIDEOS,
        "Four rendered experiments at eight exposures, measured as one study.", exposure.pooled, 150),
    Row("Fig 4.11", "Activity and maximum against exposure, one experiment of seven videos", "Activity falls, the maximum comes later",
        VIDEOS, "Both hold on a rendered experiment that is filmed fast enough for flow to follow its cells, 60 Hz.",
        exposure.one_experiment, 30),
    Row("Eq 4.1, Fig 4.13", "Frame of the maximum against exposure, four experiments", "f = 0.078 t + 14.89 up to 700 s", VIDEOS,
        NO_VIDEO, exposure.line),
    Row("Fig 4.14", "Mean difference of the two models", "Basic 15.5902 (s.d. 2.1296), Adapted 14.6310 (s.d. 4.6621): Basic is chosen",
        CORRECTED,
        "Numbers that far apart come about by chance, and a smaller spread is no reason to choose a model whose mean is larger.",
        identification.means),
    Row("Fig 4.15", "Best parameter of Basic", "8.1181, from 1, 5, 10, 15, 20", VIDEOS, NO_VIDEO, identification.best_parameter("basic")),
    Row("Fig 4.16", "Best parameter of Adapted", "8.9937, from 5, 10, 15, 20, 30", VIDEOS, NO_VIDEO,
        identification.best_parameter("adapted"), 35),
    Row("Fig 4.17", "A swarm is driven into the top-left corner", "640 × 480 px, about 4 s", SAME,
        "One iteration is one frame of a 15 Hz camera.", control.corner, 4),
    Row("Fig 4.18", "The fuzzy controller brings the swarm from the edge to the centre", "Frames", SAME,
        "Both models' swarms come and stay.", control.to_the_centre, 4),
    Row("Fig 4.19", "Distance to the setpoint over the iterations", "Basic is faster than Adapted", SAME,
        "So it is with a command per axis, one of the two readings that the text leaves open.", control.distance, 7),
    Row("Fig 4.20", "Dispersion over the iterations", "Adapted spreads more, for its randomness; more fuzzy states are to reduce that",
        CORRECTED,
        "Adapted spreads more because its cells differ in speed, not because of its noise. No number of fuzzy states makes a swarm "
        "smaller: one field moves all cells alike.",
        control.dispersion, 4),
    Row("4.4.0.1", "A route of setpoints", "The swarm follows a list of setpoints", SAME,
        "It comes to all of them. When to go on to the next one is assumed.", control.route, 4),
    Row("4.1, 4.2", "No response after some time in air", "About 11 min; videos after 700 s are left out", VIDEOS,
        "The rendered cells lose their response as the thesis observed, and the cut-off is found from the videos alone.",
        exposure.cutoff, 1),
    Row("B.1-B.5", "Optical flow: brightness constancy, energy, iteration", "The derivation, and the iteration that follows", CORRECTED,
        "The last line is right, but signs, a factor and a term before it are not: with Ix It in both rows the system as it is printed "
        "gives nonsense.",
        flow.horn_schunck),
    Row("Fig B.3", "The 5 × 5 Gaussian kernel", "Whole numbers, sum 273", SAME,
        "They are the Gaussian of 1 px, averaged over each pixel and rounded.", pictures.kernel, 0),
    Row("Fig B.4-B.7", "The Hough transform in (ρ, θ)", "Edge pixels vote for lines", SAME, "The lines with most votes touch the drop.",
        pictures.hough),
    Row("B.6, B.7", "The law of Biot and Savart; field on a coil's axis", "µ0 i R² / (2 (R² + z²)^(3/2))", SAME,
        "To the last digits. µ0 is the permeability; the thesis calls it the permittivity.", fields.biot_savart),
    Row("Fig B.9, B.11", "Field of a magnet, field of a coil", "Pictures", SAME, "Both maps, and the laws that they must keep.",
        fields.magnet_and_coil),
    Row("B.8", "Quadratic-Chi distance", "Definition and program", SAME, "All digits of the reference table.", flow.distance),
]


def wanted(names):
    """The rows that `names` mean, by item or a part of it that no letter or digit follows; all where there are none."""
    chosen = []
    for name in names:
        own = [r for r in ROWS if r.item.lower() == name.lower()] or [r for r in ROWS if name.lower() in r.item.lower().replace(",", "").split()]
        if not own:
            raise KeyError(name)
        chosen += own
    return [r for r in ROWS if r in chosen] if names else ROWS
