"""Model selection and parameter estimation: Figs 3.30 to 3.34, 4.14 to 4.16. Experiments are rendered with a known model. The rule of
the thesis is applied to them with its parameter values and with simulations without camera noise, and compared with `faba identify`."""

import numpy as np

from reproduce_rows import activity, plot, read, stats
from reproduce_rows.models import frames

SCENE = "scenes/response.toml"
GRID = {"basic": (1, 5, 10, 15, 20), "adapted": (5, 10, 15, 20, 30)}
TRUTH = {"basic": 8, "adapted": 9}
EXPERIMENTS, REPEATS = range(3), range(3)
# One field segment away from the edge from the first frame on, 6 s, 90 frames.
ONE_SEGMENT = ('controller={type="manual", field=["-115 uT", "0 uT"]}', "--duration", "6 s")
REPORTED = {"basic": (15.5902, 2.1296), "adapted": (14.6310, 4.6621)}  # mean difference and its s.d.
SLOPES = {1: 0.1943, 20: -0.0381}

STUDY = """title = "Model selection for an experiment rendered with MODEL"
boundary = "drop"
field_strength = "115 uT"
simulations = 300

[[video]]
file = "../identify-film-MODEL"

[[model]]
name = "basic"
type = "basic"
free = { "swarm[0].model.max_speed" = [1, 20], "swarm[0].count" = [50, 1000] }

[[model]]
name = "adapted"
type = "adapted"
free = { "swarm[0].model.max_speed" = [1, 20], "swarm[0].count" = [50, 1000] }
"""
CONTROLLERS = """title = "Controllers with the identified model"
scene = "../identify-basic/best.toml"
seeds = 5
delays = [0]

[[controller]]
name = "fuzzy, as published"
type = "fuzzy"
max_output = 5

[[controller]]
type = "proportional"
max_output = 5
"""


def a_video(lab, model, value, name, seed, *settings):
    return lab.a_run(f"legacy/{name}", SCENE, f'swarm[0].model={{type="{model}", max_speed={value}}}', *ONE_SEGMENT, *settings, seed=seed)


def legacy(lab, model):
    """Compares the video of each experiment with 15 simulations: rows of (parameter, slope, mean difference), steps, simulation names."""
    calls, names = [], []
    for e in EXPERIMENTS:
        calls.append(a_video(lab, model, TRUTH[model], f"{model}-experiment-{e + 1}", 100 + e))
        names.append([])
        for value in GRID[model]:
            for r in REPEATS:
                name = f"{model}-{e + 1}-{value}-{r + 1}"
                names[-1].append((value, name))
                calls.append(a_video(lab, model, value, name, 1000 * (e + 1) + 10 * value + r, "microscope.noise=0"))
    made = lab.all(calls)
    # Flow threshold (theory A16): measured with the same camera on a sample in which no cell swims.
    threshold = activity.dead_sample(lab)[1].answer["videos"][0]["threshold_px"]
    steps = lab.all(
        [
            (
                f"legacy/compare-{model}-{e + 1}",
                "compare",
                str(lab.at("legacy", f"{model}-experiment-{e + 1}")),
                *(str(lab.at("legacy", n)) for _, n in names[e]),
                "--direction",
                "0",
                "--flow-threshold",
                f"{threshold:.4g}",
                "--no-align",
                "--no-floor",
                "--out",
                "@distance.csv",
                "--report",
                "@report.html",
                "--force",
            )
            for e in EXPERIMENTS
        ],
        after=made,
    )
    rows = [
        (value, run["legacy"]["slope"], run["legacy"]["mean"])
        for e, s in enumerate(steps)
        for (value, _), run in zip(names[e], s.answer["runs"])
    ]
    return np.array(rows), steps, names


def sweep(lab, found):
    counts = []
    for model in GRID:
        rows, steps, _ = legacy(lab, model)
        per = [len(s.answer["runs"]) for s in steps]
        counts.append(f"{model} {'+'.join(map(str, per))}")
        for e, n in enumerate(per):
            found.within(f"{model.capitalize()}: simulations for experiment {e + 1}", n, 15, 15, "five values, three simulations each")
        found.within(
            f"{model.capitalize()}: smallest mean difference",
            float(rows[:, 2].min()),
            0,
            None,
            "a distance is not negative; it is not zero either, because no simulation has the seed of the experiment",
        )
    found.value = "simulations per experiment: " + ", ".join(counts)
    film = lab.steps["legacy/basic-experiment-1"]
    found.show(
        frames(film, "Reference video, rendered with Basic, 8"),
        frames(lab.steps["legacy/basic-1-5-1"], "Simulation with Basic, 5, without camera noise"),
    )


def baseline(lab, found):
    _, steps, names = legacy(lab, "basic")
    name = str(lab.at("legacy", "basic-experiment-1"))
    step = lab.call(
        "legacy/baseline",
        "compare",
        name,
        name,
        "--direction",
        "0",
        "--no-align",
        "--no-floor",
        "--out",
        "@distance.csv",
        "--report",
        "@report.html",
        "--force",
    )
    itself = step.answer["runs"][0]["legacy"]
    s = read.table(step.folder / "distance.csv")
    found.value = (
        f"a video compared with itself: maximum difference {np.abs(s['legacy'][s['run'] == 1]).max():g}, slope {itself['slope']:g}"
    )
    found.within(
        "Maximum difference of a video to itself", float(np.abs(s["legacy"][s["run"] == 1]).max()), 0, 0, "the two videos are identical"
    )
    found.within("Slope of its line", itself["slope"], 0, 0, "the baseline, a = 0")
    found.within("Intercept of its line", itself["intercept"], 0, 0, "the baseline, b = 0")
    d = read.table(steps[0].folder / "distance.csv")
    at = 1 + next(i for i, (v, _) in enumerate(names[0]) if v == 10)
    y = d["legacy"][d["run"] == at]
    a, b, *_ = stats.line(np.arange(len(y)), y)
    found.about(
        "Slope by the program minus slope by an independent fit",
        steps[0].answer["runs"][at - 1]["legacy"]["slope"] - a,
        0,
        1e-6,
        "both are least-squares fits; the file has 9 digits",
    )
    zero = s["legacy"][s["run"] == 1]
    found.show(
        plot.plot(
            "Baseline: a video compared with itself",
            "frame",
            "difference",
            [("line", "difference", np.arange(len(zero)), zero)],
            "The difference is zero in every frame.",
            y=(-1, 20),
        ),
        plot.plot(
            "Line fitted to a difference",
            "frame",
            "difference",
            [("line", "Basic, 10", np.arange(len(y)), y), ("dashed", "fitted line", [0, len(y)], [b, b + a * len(y)])],
            f"Slope {a:.4f} per frame.",
        ),
    )


def two_series(lab, found):
    rows, steps, names = legacy(lab, "basic")
    d = read.table(steps[0].folder / "distance.csv")
    mean = {v: stats.mean_ci95(rows[rows[:, 0] == v, 1]) for v in (1, 20)}
    found.value = (
        "; ".join(f"Basic at {v}: slope {m:.4f} [{low:.4f}, {high:.4f}]" for v, (m, low, high) in mean.items())
        + " (nine simulations each; true value 8)"
    )
    holds = mean[1][1] > 0 > mean[20][2]
    found.note.append(
        "By the rule of the thesis the slope should be positive at 1 and negative at 20, because the true value of 8 is between them. "
        + (
            "This is the case here."
            if holds
            else "This is not the case here: slopes also depend on the drop, the cells and the camera. Fig 3.33 shows the consequence."
        )
    )
    for v in (1, 20):
        at = 1 + next(i for i, (value, _) in enumerate(names[0]) if value == v)
        y = d["legacy"][d["run"] == at]
        a, b, *_ = stats.line(np.arange(len(y)), y)
        found.about(
            f"First simulation at {v}: slope by the program minus slope by an independent fit",
            steps[0].answer["runs"][at - 1]["legacy"]["slope"] - a,
            0,
            1e-6,
            "both are least-squares fits; the file has 9 digits",
        )
        found.within(f"Frame pairs at {v}", len(y), 89, 89, "90 frames in 6 s at 15 Hz")
        found.show(
            plot.plot(
                f"Difference, Basic at {v}",
                "frame",
                "difference",
                [("line", "difference", np.arange(len(y)), y), ("dashed", "fitted line", [0, len(y)], [b, b + a * len(y)])],
                f"Slope {a:.4f} (thesis: {SLOPES[v]}).",
            )
        )


def slopes_plot(heading, model, rows, caption):
    """Slope of each simulation against its parameter, with the fitted line, zero and the true parameter."""
    slope, intercept, *_ = stats.line(rows[:, 0], rows[:, 1])
    x = np.array([min(GRID[model]), max(GRID[model])])
    return plot.plot(
        heading,
        "maximum speed (px per iteration)",
        "slope per frame",
        [
            ("dots", "45 simulations", rows[:, 0], rows[:, 1]),
            ("line", "fitted line", x, intercept + slope * x),
            ("dashed", "zero", x, 0 * x),
        ],
        caption,
        rules=[(TRUTH[model], "true value")],
    )


def two_point_zero():
    (x1, y1), (x2, y2) = SLOPES.items()
    return x1 + (x2 - x1) * y1 / (y1 - y2)


def crossing(lab, found):
    zeros = []
    for model in GRID:
        rows, *_ = legacy(lab, model)
        zero, ends = stats.zero_crossing(rows[:, 0], rows[:, 1])
        interval = f"95 % interval {ends[0]:.2f} to {ends[1]:.2f}" if ends else "95 % interval unbounded"
        zeros.append(f"{model}: zero at {zero:.2f}, {interval} (true value {TRUTH[model]})")
        found.true(
            f"{model.capitalize()}: the interval of the rule does not contain the true value, or is unbounded",
            ends is None or not ends[0] <= TRUTH[model] <= ends[1],
            "the corrected statement: a slope of zero does not give the parameter",
        )
        found.show(slopes_plot(f"Slopes, {model.capitalize()}", model, rows, f"The true value is {TRUTH[model]}."))
    found.beside = "The lines through the slopes, and their zeros. The slopes are computed by the program (`faba compare`)."
    found.about(
        "Zero of the line through the two slopes printed in the thesis",
        two_point_zero(),
        16.89,
        0.5e-2,
        "1 + 19 × 0.1943 / (0.1943 + 0.0381); the thesis has 8.12",
    )
    found.value = "; ".join(zeros) + f"; zero of the line through the two slopes of the thesis: {two_point_zero():.2f}"


def identified(lab, model):
    """A rendered experiment of this model with four field segments, and the result of `faba identify` for it."""
    film = lab.run(f"identify-film-{model}", SCENE, f'swarm[0].model={{type="{model}", max_speed={TRUTH[model]}}}', seed=7)
    path = lab.write(f"identify-study-{model}", "study.toml", STUDY.replace("MODEL", model))
    return film, lab.call(f"identify-{model}", "identify", path, after=[film])


def best_parameter(model):
    def work(lab, found):
        rows, *_ = legacy(lab, model)
        zero, ends = stats.zero_crossing(rows[:, 0], rows[:, 1])
        levels = {v: rows[rows[:, 0] == v, 2].mean() for v in GRID[model]}
        _, step = identified(lab, model)
        posterior = next(m for m in step.answer["models"] if m["name"] == model)
        p = posterior["parameters"]["swarm[0].model.max_speed"]
        low, high = p["ci90"]
        found.value = (
            f"true value {TRUTH[model]}; rule of the thesis {zero:.2f} [{f'{ends[0]:.2f}, {ends[1]:.2f}' if ends else 'unbounded'}] (95 %); "
            f"`faba identify` {p['median']:.2f} [{low:.2f}, {high:.2f}] (90 %)"
        )
        found.within(
            "True value; accepted: 90 % interval of `faba identify`", float(TRUTH[model]), low, high, "ground truth, unknown to the study"
        )
        found.within(
            "Width of that interval divided by the true value",
            (high - low) / TRUTH[model],
            None,
            0.5,
            "an informative estimate: about ± 25 %",
        )
        found.within(
            "Error of `faba identify` divided by the error of the rule of the thesis",
            abs(p["median"] - TRUTH[model]) / abs(zero - TRUTH[model]),
            None,
            1,
            "closer to the true value than the published rule",
        )
        found.note.append(
            f"The smallest mean difference, a better criterion than the slope, is at {min(levels, key=levels.get)} among the values of the"
            " sweep."
        )
        page = step.folder / "identify.html"
        found.show(slopes_plot("Rule of the thesis", model, rows, f"Zero at {zero:.2f}; the true value is {TRUTH[model]}."))
        for name, markup in read.figures(page):
            if "max_speed" in name:
                found.show(markup)

    return work


def means(lab, found):
    p45, p15 = (stats.welch(*REPORTED["basic"], n, *REPORTED["adapted"], n) for n in (45, 15))
    ours = {m: legacy(lab, m)[0][:, 2] for m in GRID}
    p = stats.welch(*(x for m in GRID for x in (ours[m].mean(), ours[m].std(ddof=1), len(ours[m]))))
    found.value = (
        f"values of the thesis: p = {p45:.2f} for 45 simulations per model, p = {p15:.2f} for 15; mean differences of the rendered"
        " experiments: " + ", ".join(f"{m} {x.mean():.2f} (s.d. {x.std(ddof=1):.2f})" for m, x in ours.items())
    )
    found.beside = "Welch's tests. The differences of the rendered experiments are computed by the program (`faba compare`)."
    found.about(
        "p of Welch's test with the values of the thesis, 45 simulations per model",
        p45,
        0.21,
        0.5e-2,
        "reference value from another program; half of the last digit",
    )
    found.about("p with 15 simulations per model", p15, 0.48, 0.5e-2, "reference value from another program; half of the last digit")
    found.within("Smaller of both p", min(p45, p15), 0.05, None, "no significant difference of the models at the 5 % level")
    found.note.append(
        "On the rendered experiments each model is compared with experiments rendered with the same model. There the test gives"
        f" p = {p:.2g}, although both models are correct: it compares two sets of parameters, not two models."
    )
    found.show(
        *(
            plot.plot(
                f"Mean difference, {m.capitalize()}",
                "maximum speed (px per iteration)",
                "mean difference",
                [("dots", "45 simulations", legacy(lab, m)[0][:, 0], x), ("dashed", "mean", [min(GRID[m]), max(GRID[m])], [x.mean()] * 2)],
                f"The true value is {TRUTH[m]}.",
            )
            for m, x in ours.items()
        )
    )


def loop(lab, found):
    film, step = identified(lab, "basic")
    best = str(lab.at("identify-basic", "best.toml"))
    again = lab.run("best-run", best, "record.tracks=false", after=[step])
    study = lab.write("best-controllers-study", "study.toml", CONTROLLERS)
    compared = lab.call("best-controllers", "compare-controllers", study, after=[step])
    rms = {c["controller"]: c["metrics"].get("steady_rms_px", {}) for c in compared.answer["combinations"]}
    steady = ", ".join(f"{n} {m['mean']:.1f} [{m['ci95'][0]:.1f}, {m['ci95'][1]:.1f}] px rms" for n, m in rms.items() if m)
    found.value = (
        f"best model: {step.answer['best']} (evidence {step.answer['evidence']}); steady-state distance with this model: {steady}"
    )
    found.true("The best model is the one that rendered the video", step.answer["best"] == "basic", "ground truth")
    found.true("The scene of the best model runs", again.answer["complete"], "`best.toml` is a scenario for `faba run`")
    found.within("Controllers compared with this model", len(rms), 2, 2, "the last step of the loop")
    found.show(
        *(read.figure(compared.folder / "report.html", n) for n in ("Distance to the setpoint", "Dispersion")),
        frames(again, "Simulation with the best model"),
    )
    for name, markup in read.figures(step.folder / "identify.html")[:2]:
        found.show(markup)
