"""Which model, which parameter: Figs 3.30 to 3.34, 4.14 to 4.16. Experiments are rendered with a known model; the thesis's rule is
repeated on them as it was, with its values and without the camera's noise in the simulations, beside the program's own answer."""

import numpy as np

from reproduce_rows import activity, plot, read, stats
from reproduce_rows.models import frames

SCENE = "scenes/response.toml"
GRID = {"basic": (1, 5, 10, 15, 20), "adapted": (5, 10, 15, 20, 30)}
TRUTH = {"basic": 8, "adapted": 9}
EXPERIMENTS, REPEATS = range(3), range(3)
# One field segment away from the edge from the first frame on, 6 s, 90 frames.
ONE_DRIVE = ('controller={type="manual", field=["-115 uT", "0 uT"]}', "--duration", "6 s")
REPORTED = {"basic": (15.5902, 2.1296), "adapted": (14.6310, 4.6621)}  # mean difference and its s.d.
SLOPES = {1: 0.1943, 20: -0.0381}

STUDY = """title = "Rendered with MODEL: which model is it?"
boundary = "drop"
field_strength = "115 uT"            # strength of the field
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
CONTROLLERS = """title = "Controllers in the model that was found"
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
    return lab.a_run(f"legacy/{name}", SCENE, f'swarm[0].model={{type="{model}", max_speed={value}}}', *ONE_DRIVE, *settings, seed=seed)


def legacy(lab, model):
    """Per experiment the comparison of its video with 15 simulations; (parameter, slope, mean) of each, and the steps."""
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
    # Flow of less is noise, by the definition of A16: that of a sample in which nothing swims, of the same camera.
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
    said = []
    for model in GRID:
        rows, steps, _ = legacy(lab, model)
        per = [len(s.answer["runs"]) for s in steps]
        said.append(f"{model} {'+'.join(map(str, per))}")
        for e, n in enumerate(per):
            found.within(f"{model.capitalize()}: simulations against experiment {e + 1}", n, 15, 15, "five values, three simulations each")
        found.within(
            f"{model.capitalize()}: smallest difference",
            float(rows[:, 2].min()),
            0,
            None,
            "a distance; none is zero, since no seed is the experiment's",
        )
    found.value = "simulations per experiment: " + ", ".join(said)
    film = lab.steps["legacy/basic-experiment-1"]
    found.show(
        frames(film, "A reference video, rendered with Basic, 8"),
        frames(lab.steps["legacy/basic-1-5-1"], "A simulation with Basic, 5, without noise"),
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
    own = step.answer["runs"][0]
    s = read.table(step.folder / "distance.csv")
    found.value = f"a video against itself: difference {np.abs(s['legacy'][s['run'] == 1]).max():g}, slope {own['legacy']['slope']:g}"
    found.within("Largest difference of a video to itself", float(np.abs(s["legacy"][s["run"] == 1]).max()), 0, 0, "identical videos")
    found.within("Slope of its line", own["legacy"]["slope"], 0, 0, "the baseline, a = 0")
    found.within("Intercept of its line", own["legacy"]["intercept"], 0, 0, "the baseline, b = 0")
    d = read.table(steps[0].folder / "distance.csv")
    at = 1 + next(i for i, (v, _) in enumerate(names[0]) if v == 10)
    y = d["legacy"][d["run"] == at]
    a, b, *_ = stats.line(np.arange(len(y)), y)
    found.about(
        "Slope of a line by the program, less that fitted here",
        steps[0].answer["runs"][at - 1]["legacy"]["slope"] - a,
        0,
        1e-6,
        "least squares twice; the file has 9 digits",
    )
    zero = s["legacy"][s["run"] == 1]
    found.show(
        plot.plot(
            "Baseline: a video against itself",
            "frame",
            "difference",
            [("line", "difference", np.arange(len(zero)), zero)],
            "Zero in every frame.",
            y=(-1, 20),
        ),
        plot.plot(
            "A line fitted to a difference",
            "frame",
            "difference",
            [("line", "Basic, 10", np.arange(len(y)), y), ("dashed", "line", [0, len(y)], [b, b + a * len(y)])],
            f"Slope {a:.4f} per frame.",
        ),
    )


def two_series(lab, found):
    rows, steps, names = legacy(lab, "basic")
    d = read.table(steps[0].folder / "distance.csv")
    mean = {v: stats.mean_ci95(rows[rows[:, 0] == v, 1]) for v in (1, 20)}
    found.value = (
        "; ".join(f"Basic at {v}: slope {m:.4f} [{low:.4f}, {high:.4f}]" for v, (m, low, high) in mean.items())
        + " (nine simulations each; truth 8)"
    )
    kept = mean[1][1] > 0 > mean[20][2]
    found.note.append(
        "Had the rule held here, the slope would be above zero at 1 and below at 20, with the truth of 8 between them. "
        + (
            "It is."
            if kept
            else "It is not: slopes depend on the drop, its cells and the camera, too. What follows from that is said with Fig 3.33."
        )
    )
    for v in (1, 20):
        at = 1 + next(i for i, (value, _) in enumerate(names[0]) if value == v)
        y = d["legacy"][d["run"] == at]
        a, b, *_ = stats.line(np.arange(len(y)), y)
        found.about(
            f"Slope at {v} by the program less that fitted here, first simulation",
            steps[0].answer["runs"][at - 1]["legacy"]["slope"] - a,
            0,
            1e-6,
            "least squares twice; the file has 9 digits",
        )
        found.within(f"Pairs of frames at {v}", len(y), 89, 89, "6 s at 15 Hz have 90 frames")
        found.show(
            plot.plot(
                f"Difference, Basic at {v}",
                "frame",
                "difference",
                [("line", "difference", np.arange(len(y)), y), ("dashed", "line", [0, len(y)], [b, b + a * len(y)])],
                f"Slope {a:.4f}, in the thesis {SLOPES[v]}.",
            )
        )


def slopes_plot(heading, model, rows, caption):
    """Slope of each simulation against its parameter, with their line, zero and the truth."""
    slope, intercept, *_ = stats.line(rows[:, 0], rows[:, 1])
    x = np.array([min(GRID[model]), max(GRID[model])])
    return plot.plot(
        heading,
        "largest speed (px per iteration)",
        "slope per frame",
        [
            ("dots", "45 simulations", rows[:, 0], rows[:, 1]),
            ("line", "their line", x, intercept + slope * x),
            ("dashed", "zero", x, 0 * x),
        ],
        caption,
        rules=[(TRUTH[model], "truth")],
    )


def two_point_zero():
    (x1, y1), (x2, y2) = SLOPES.items()
    return x1 + (x2 - x1) * y1 / (y1 - y2)


def crossing(lab, found):
    said = []
    for model in GRID:
        rows, *_ = legacy(lab, model)
        zero, ends = stats.zero_crossing(rows[:, 0], rows[:, 1])
        said.append(
            f"{model}: zero at {zero:.2f}, 95 % {f'{ends[0]:.2f} to {ends[1]:.2f}' if ends else 'without bounds'} (truth {TRUTH[model]})"
        )
        found.true(
            f"{model.capitalize()}: the rule's interval misses the truth or has no bounds",
            ends is None or not ends[0] <= TRUTH[model] <= ends[1],
            "the claim that is corrected: a slope of zero does not mark the parameter",
        )
        found.show(slopes_plot(f"Slopes, {model.capitalize()}", model, rows, f"The truth is {TRUTH[model]}."))
    found.beside = "Lines through slopes and where they cross zero. Each slope is the program's (`faba compare`)."
    found.about(
        "Zero of the line through the two slopes that the thesis prints",
        two_point_zero(),
        16.89,
        0.5e-2,
        "1 + 19 × 0.1943 / (0.1943 + 0.0381); the thesis has 8.12",
    )
    found.value = "; ".join(said) + f"; the thesis's own two slopes cross zero at {two_point_zero():.2f}"


def identified(lab, model):
    """The program's own answer for an experiment of this model with four field segments, and the film."""
    film = lab.run(f"identify-film-{model}", SCENE, f'swarm[0].model={{type="{model}", max_speed={TRUTH[model]}}}', seed=7)
    path = lab.write(f"identify-study-{model}", "study.toml", STUDY.replace("MODEL", model))
    return film, lab.call(f"identify-{model}", "identify", path, after=[film])


def best_parameter(model):
    def work(lab, found):
        rows, *_ = legacy(lab, model)
        zero, ends = stats.zero_crossing(rows[:, 0], rows[:, 1])
        levels = {v: rows[rows[:, 0] == v, 2].mean() for v in GRID[model]}
        _, step = identified(lab, model)
        own = next(m for m in step.answer["models"] if m["name"] == model)
        p = own["parameters"]["swarm[0].model.max_speed"]
        low, high = p["ci90"]
        found.value = (
            f"truth {TRUTH[model]}: the thesis's rule says {zero:.2f} [{f'{ends[0]:.2f}, {ends[1]:.2f}' if ends else 'no bounds'}], "
            f"the program {p['median']:.2f} [{low:.2f}, {high:.2f}] (90 %)"
        )
        found.within("The truth in the program's 90 % interval", float(TRUTH[model]), low, high, "known truth, which the study is not told")
        found.within(
            "Width of that interval over the truth",
            (high - low) / TRUTH[model],
            None,
            0.5,
            "narrow enough to be an answer: within a quarter to either side",
        )
        found.within(
            "Error of the program's answer over that of the rule",
            abs(p["median"] - TRUTH[model]) / abs(zero - TRUTH[model]),
            None,
            1,
            "nearer to the truth than the published rule",
        )
        found.note.append(
            f"The least mean difference, a better rule than the slope, is at {min(levels, key=levels.get)} of the values tried."
        )
        page = step.folder / "identify.html"
        found.show(slopes_plot("The thesis's rule", model, rows, f"Zero at {zero:.2f}; the truth is {TRUTH[model]}."))
        for name, markup in read.figures(page):
            if "max_speed" in name:
                found.show(markup)

    return work


def means(lab, found):
    p45, p15 = (stats.welch(*REPORTED["basic"], n, *REPORTED["adapted"], n) for n in (45, 15))
    ours = {m: legacy(lab, m)[0][:, 2] for m in GRID}
    p = stats.welch(*(x for m in GRID for x in (ours[m].mean(), ours[m].std(ddof=1), len(ours[m]))))
    found.value = f"the thesis's numbers: p = {p45:.2f} (45 simulations each) to {p15:.2f} (15); rendered experiments: " + ", ".join(
        f"{m} {x.mean():.2f} (s.d. {x.std(ddof=1):.2f})" for m, x in ours.items()
    )
    found.beside = "Welch's tests. The differences of the rendered experiments are the program's (`faba compare`)."
    found.about("Welch's test of the thesis's numbers, 45 each", p45, 0.21, 0.5e-2, "computed elsewhere; half of the last digit")
    found.about("The same with 15 each", p15, 0.48, 0.5e-2, "computed elsewhere; half of the last digit")
    found.within("Smaller of both", min(p45, p15), 0.05, None, "no evidence for either model at 5 %")
    found.note.append(
        f"On rendered experiments, where each model is compared with its own kind, the test gives p = {p:.2g}: it compares two sets of"
        " parameters, not two models."
    )
    found.show(
        *(
            plot.plot(
                f"Mean difference, {m.capitalize()}",
                "largest speed (px per iteration)",
                "mean difference",
                [("dots", "45 simulations", legacy(lab, m)[0][:, 0], x), ("dashed", "mean", [min(GRID[m]), max(GRID[m])], [x.mean()] * 2)],
                f"The truth is {TRUTH[m]}.",
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
    said = ", ".join(f"{n} {m['mean']:.1f} [{m['ci95'][0]:.1f}, {m['ci95'][1]:.1f}] px rms" for n, m in rms.items() if m)
    found.value = f"named: {step.answer['best']} (evidence {step.answer['evidence']}); controllers in it: {said}"
    found.true("The model that made the video is named", step.answer["best"] == "basic", "known truth")
    found.true("The scene of the best model runs", again.answer["complete"], "`best.toml` is what `faba run` takes")
    found.within("Controllers compared in it", len(rms), 2, 2, "back at the controller: the loop is closed")
    found.show(
        *(read.figure(compared.folder / "report.html", n) for n in ("Distance to the setpoint", "Dispersion")),
        frames(again, "The best model at the video's place"),
    )
    for name, markup in read.figures(step.folder / "identify.html")[:2]:
        found.show(markup)
