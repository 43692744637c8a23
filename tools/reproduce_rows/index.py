"""All results of the thesis that software can reproduce, in the order of the thesis: content, published value, intended verdict, reason."""

import dataclasses

from reproduce_rows import activity, control, exposure, fields, flow, identification, models, optics, pictures, structure, videos
from reproduce_rows.check import CORRECTED, LATER, SAME, VIDEOS


@dataclasses.dataclass
class Row:
    """One result. `work(lab, found)` computes it; `seconds` is its approximate duration on two cores, for the estimate of the time left."""

    item: str
    shows: str
    thesis: str
    verdict: str
    reason: str
    work: object
    seconds: float = 3


NO_VIDEO = ("The videos of the thesis are not public, so the published value cannot be recomputed. The same procedure recovers the "
            "true value of rendered experiments.")

ROWS = [
    Row("Fig 3.10", "The simulator's modules", "Window, data, bacteria (Basic, Adapted), field, controller, analysis", SAME,
        "Each module of the thesis has a corresponding part; a test checks the dependencies between the folders.", structure.modules),
    Row("Eq 3.1", "The Basic model", "Step per axis: randi(2ρ + 1) − ρ − 1 + m", SAME,
        "A step is a uniformly distributed integer from −ρ to ρ plus the commanded drift.", models.basic, 4),
    Row("3.3.3.3", "The Adapted model",
        "Four rules: the field sets the direction, cells differ, each cell has a constant speed, inertia is small; the Earth's field adds "
        "one unit along y", SAME,
        "All four rules hold. The tilt by the Earth's field and the fraction of cells that do not respond agree with the rules.",
        models.adapted, 6),
    Row("Fig 3.11", "Two coils with fields in the same direction", "Field lines cross the sample in one direction", SAME,
        "The field has the same direction everywhere in the sample.", fields.concurring),
    Row("Fig 3.12", "Two coils with opposing fields", "A zero of the field between the coils, where a swarm should gather",
        CORRECTED,
        "The zero exists, but it is a saddle point. The divergence and the curl of the field are zero, so a field that pulls cells in along"
        " the axis of the coils pushes them out across it. Two coils cannot gather a swarm.",
        fields.opposed),
    Row("Fig 3.13", "A computed field with a zero", "Field lines for one set of currents", SAME,
        "Unequal currents move the zero by the distance that the reference computation gives.", fields.computed),
    Row("Fig 3.14", "The library of fields", "Fields are computed, stored and loaded; the field with the nearest zero is applied", SAME,
        "The same four steps; in every frame the nearest entry of the library is applied. Solving for the currents makes a library "
        "unnecessary.",
        fields.library, 12),
    Row("Fig 3.15, 3.16", "Open loop (gradient) and closed loop (fuzzy)", "Two block diagrams", SAME,
        "Both loops bring the swarm to its setpoints.", control.loops, 10),
    Row("Fig 3.18", "Membership functions “close” and “far”", "Two trapezoids; the breakpoints are given only in the figure", SAME,
        "Two complementary trapezoids. Their breakpoints, 40 and 120 px, are assumed; the program reports them as assumed.",
        control.memberships),
    Row("Eq 3.2, Fig 3.19", "Output of the fuzzy controller",
        "Half of the maximum near the setpoint, the maximum far from it, weighted means between", SAME,
        "The commands equal the weighted mean of the rules to the last recorded digit.", control.sugeno),
    Row("Fig 3.20", "The main window",
        "Model, controller, number of cells, maximum speed, setpoint, recording, field model, manual field", SAME,
        "`faba lab` has all of these settings, and all other settings of a scenario, on a page in the browser.", structure.window, 8),
    Row("Fig 3.21", "Simulation in a box", "All cells in view, no cell crosses the limits; crosses at the mean and the setpoint", SAME,
        "In every frame, no cell is outside the box and no pixel has two cells.", models.constrained),
    Row("Fig 3.22, 3.23", "Set-up from a picture of an experiment", "Grey, edges, Hough lines, circle, then a simulation inside it", SAME,
        "The same stages recover the drop of a rendered experiment, and simulated cells stay in it. The circle is fitted to all edge "
        "pixels, not to the end points of lines; on short arcs its error is smaller.",
        pictures.set_up, 12),
    Row("Fig 3.24, 3.25", "Step input and step response", "The swarm leaves the edge after the field reversal; 6 s, about 90 frames", SAME,
        "The field is reversed, and the swarm leaves the edge at the speed of its cells.", videos.step_input, 4),
    Row("Fig 3.26, 3.27", "Measurement of activity", "Optical flow before and after the filter", VIDEOS,
        "The procedure is applied to a rendered experiment; its sum is computed a second time without the program.",
        activity.procedure, 6),
    Row("Fig 3.28, 3.29", "Flow of experiment and simulation", "Filtered flow and its sums over columns and rows", VIDEOS,
        "Shown on two rendered experiments. The thesis calls the sums derivatives, but they are sums.", activity.histograms, 12),
    Row("Fig 3.30", "The parameter sweep", "Per model five values, three simulations of each, compared with one reference video", VIDEOS,
        "The same sweep with the values of the thesis, for three rendered experiments and both models.", identification.sweep, 110),
    Row("Fig 3.31", "Baseline and fitted line", "A video compared with itself: a = b = 0", SAME,
        "The difference is exactly zero, and the fitted lines are least-squares lines.", identification.baseline),
    Row("Fig 3.32", "Difference of Basic at 1 and 20", "Slopes 0.1943 and −0.0381", VIDEOS,
        "The same procedure on rendered experiments. The slopes depend on the videos and not on the parameter alone.",
        identification.two_series),
    Row("Fig 3.33", "Slopes against the parameter", "The parameter estimate is the zero of the line through the slopes", CORRECTED,
        "A difference that is large in all frames has slope zero too, so the zero of the line is not the true parameter. "
        "The line through the two printed slopes of the thesis crosses zero at 16.89, not at 8.12.",
        identification.crossing),
    Row("Fig 3.34", "The improvement loop", "Experiment, models, difference, best model, controller, and back", SAME,
        "`identify` finds the model of a rendered experiment, and controllers are compared in the scene that it writes.",
        identification.loop, 40),
    Row("4.1.1", "Choice of the objective",
        "100x is not recommended: the bacteria go out of the field of view before the swarm formation", SAME,
        "A cell crosses the view of the objective 100x in a tenth of the time at 10x, which is less than a swarm needs to gather. In the "
        "rendered videos the swarm has left the view at 100x before its speed can be measured; at 10x the speed is measured.",
        optics.objectives, 20),
    Row("Fig 4.5 a-d", "Four configurations of the coils",
        "One swarm (a, b), a swarm in the middle (c), two swarms (d); the experiment did not show c and d", CORRECTED,
        "a and b are as published. c is impossible: the zero of two coils is a saddle point, which splits a swarm. d requires equal "
        "currents and no field of the Earth: a current difference of 10 % and the Earth's 18 µT move the zero out of the drop, as in the "
        "experiment.",
        fields.four_configurations, 16),
    Row("Table 4.1", "Calibration of the camera", "0.7341, 0.7846, 0.7881, 0.8202, 0.8806; mean 0.8015, s.d. 0.053 µm/px", CORRECTED,
        "The ratio increases with the width because every line is measured about 10 px too wide. The slope of a line through the same "
        "readings does not have this error.",
        pictures.calibration),
    Row("Fig 4.7", "A line of the ruler, measured twice", "Two readings of each width", SAME,
        "The repeatability of the readings agrees, and the pitch of a synthetic ruler is recovered.", pictures.ruler),
    Row("Fig 4.8", "Frames of the step response", "From 0 to 4.16 s", VIDEOS,
        "A rendered experiment shows the same: the cells at the edge disperse and leave the field of view.", videos.response_frames, 4),
    Row("Fig 4.9 a", "Activity of one video", "(1) onset, (2) maximum, (3) the swarm leaves; a Gaussian", VIDEOS, NO_VIDEO,
        activity.signature, 5),
    Row("Fig 4.9 b", "Activity of a dead sample", "Mean 0.83e4, no Gaussian fits", VIDEOS,
        "No Gaussian fits, as in the thesis. The remaining activity comes from camera noise, which differs between cameras.",
        activity.dead, 5),
    Row("Fig 4.10-4.12", "Several videos of one experiment, then four experiments pooled", "The procedure", VIDEOS,
        "Four rendered experiments at eight air exposure times, measured as one study.", exposure.pooled, 150),
    Row("Fig 4.11", "Activity and time of its maximum against air exposure time, one experiment of seven videos",
        "Activity decreases, the maximum occurs later", VIDEOS,
        "Both hold for a rendered experiment with 60 frames per second, which is fast enough for optical flow to follow the cells.",
        exposure.one_experiment, 30),
    Row("Eq 4.1, Fig 4.13", "Frame of the maximum against air exposure time, four experiments", "f = 0.078 t + 14.89 up to 700 s", VIDEOS,
        NO_VIDEO, exposure.line),
    Row("Fig 4.14", "Mean difference of the two models", "Basic 15.5902 (s.d. 2.1296), Adapted 14.6310 (s.d. 4.6621): Basic is chosen",
        CORRECTED,
        "The difference of the means is not statistically significant, and a smaller spread does not justify choosing the model with the "
        "larger mean.",
        identification.means),
    Row("Fig 4.15", "Best parameter of Basic", "8.1181, from 1, 5, 10, 15, 20", VIDEOS, NO_VIDEO, identification.best_parameter("basic")),
    Row("Fig 4.16", "Best parameter of Adapted", "8.9937, from 5, 10, 15, 20, 30", VIDEOS, NO_VIDEO,
        identification.best_parameter("adapted"), 35),
    Row("Fig 4.17", "A swarm is driven into the top-left corner", "640 × 480 px, about 4 s", SAME,
        "The time agrees if one iteration is one frame of a 15 Hz camera.", control.corner, 4),
    Row("Fig 4.18", "The fuzzy controller brings the swarm from the edge to the centre", "Frames", SAME,
        "The swarms of both models reach the centre and stay there.", control.to_the_centre, 4),
    Row("Fig 4.19", "Distance to the setpoint over the iterations", "Basic is faster than Adapted", SAME,
        "Basic is faster with one command per axis, one of the two possible readings of the text.", control.distance, 7),
    Row("Fig 4.20", "Dispersion over the iterations",
        "Adapted spreads more because of its randomness; more fuzzy states should reduce the dispersion", CORRECTED,
        "Adapted spreads more because its cells differ in speed, not because of its noise. More fuzzy states do not make a swarm "
        "smaller, because a uniform field moves all cells in the same way.",
        control.dispersion, 4),
    Row("4.4.0.1", "A route of setpoints", "The swarm follows a list of setpoints", SAME,
        "The swarm reaches all setpoints. The criterion for switching to the next setpoint is assumed.", control.route, 4),
    Row("beyond", "The fuzzy controller against later ones, on the experiment of Figs 4.18 to 4.20", "Future work: better controllers", LATER,
        "The regulator and model predictive control hold Basic four times as near; none of them holds Adapted nearer, whose speed no "
        "field changes.",
        control.beyond, 8),
    Row("4.1, 4.2", "Loss of response with air exposure time", "About 11 min; videos after 700 s are excluded", VIDEOS,
        "The rendered cells lose their response as observed in the thesis, and the cut-off is found from the videos alone.",
        exposure.cutoff, 1),
    Row("B.1-B.5", "Optical flow: brightness constancy, energy, iteration", "The derivation and the resulting iteration", CORRECTED,
        "The last line is correct, but earlier lines have wrong signs, a wrong factor and a wrong term: the printed system has Ix It in "
        "both rows and gives a wrong flow.",
        flow.horn_schunck),
    Row("Fig B.3", "The 5 × 5 Gaussian kernel", "Integers, sum 273", SAME,
        "The integers are the Gaussian of 1 px, averaged over each pixel and rounded.", pictures.kernel, 0),
    Row("Fig B.4-B.7", "The Hough transform in (ρ, θ)", "Edge pixels vote for lines", SAME,
        "The lines with the most votes are tangents of the drop.", pictures.hough),
    Row("B.6, B.7", "Biot-Savart law; field on the axis of a coil", "µ0 i R² / (2 (R² + z²)^(3/2))", SAME,
        "The fields agree within rounding. µ0 is the permeability; the thesis calls it the permittivity.", fields.biot_savart),
    Row("Fig B.9, B.11", "Field of a magnet, field of a coil", "Pictures", SAME, "Both field maps are shown and satisfy the dipole laws.",
        fields.magnet_and_coil),
    Row("B.8", "Quadratic-Chi distance", "Definition and program", SAME, "The distances equal the reference table in all its digits.",
        flow.distance),
]


def wanted(names):
    """The rows for `names`, each a complete item ("Fig 4.17") or one word of an item ("4.17"); all rows if `names` is empty."""
    chosen = []
    for name in names:
        matching = [r for r in ROWS if r.item.lower() == name.lower()] or [
            r for r in ROWS if name.lower() in r.item.lower().replace(",", "").split()
        ]
        if not matching:
            raise KeyError(name)
        chosen += matching
    return [r for r in ROWS if r in chosen] if names else ROWS
