"""Controllers: Figs 3.15 to 3.19 and 4.17 to 4.20, route of setpoints, later controllers."""

import math

import numpy as np

from reproduce_rows import plot, read, stats
from reproduce_rows.models import frames

SEEDS = range(1, 11)
BASIC, ADAPTED = "scenes/thesis-basic.toml", "scenes/thesis-adapted.toml"
NEITHER = ("record.video=false", "record.tracks=false")
WHY = "range over seeds of an exact re-implementation of the thesis's model (theory, A21)"
VECTOR = {0: 2.5, 40: 2.5, 60: 3.125, 80: 3.75, 100: 4.375, 120: 5, 300: 5}


def seeds(lab, name, scene, *settings):
    return [read.series(s) for s in lab.all([lab.a_run(f"{name}-{k}", scene, *settings, *NEITHER, seed=k) for k in SEEDS])]


def arrival(s):
    """Iterations until the centroid of the swarm is within 32 px of the setpoint."""
    near = np.flatnonzero(s["distance_px"] < 32)
    return float(near[0]) if len(near) else math.nan


def steady(s):
    d = s["distance_px"]
    return float(np.sqrt(np.mean(d[len(d) * 2 // 3 :] ** 2)))


def loops(lab, found):
    opened = lab.run("null-route", "scenes/null-route.toml")
    closed = lab.run("basic-film", BASIC)
    a, b = opened.answer, closed.answer
    found.value = (
        f"open loop: {a['setpoints_reached']} of 3 setpoints reached, final distance {a['final_distance_px']:.1f} px; closed loop: settling"
        f" time {b['settling_time_s']:.2f} s, steady-state distance {b['steady_rms_px']:.1f} px rms"
    )
    found.within(
        "Open loop: setpoints reached", a["setpoints_reached"], 3, 3, "counted from the recording, with the tolerance of the route"
    )
    found.within("Open loop: final distance to the last setpoint", a["final_distance_px"], None, 20, "the tolerance of the route", "px")
    found.within("Closed loop: distance to the setpoint in the last third", b["steady_rms_px"], 1.5, 3, WHY, "px rms")
    chain = (
        (10, 20, 100, "setpoint"),
        (150, 20, 130, "nearest zero|library or solved"),
        (320, 20, 110, "coil currents"),
        (470, 20, 120, "swarm|at the zero"),
    )
    found.show(
        plot.boxes(
            "Open loop",
            chain,
            [(0, 1), (1, 2), (2, 3)],
            "There is no feedback: the field moves the cells to its zero.",
            (620, 80),
        )
    )
    loop = (
        (10, 20, 100, "setpoint"),
        (150, 20, 130, "fuzzy controller"),
        (320, 20, 110, "field"),
        (470, 20, 120, "swarm"),
        (310, 100, 130, "estimator|centroid of the cells"),
    )
    found.show(
        plot.boxes(
            "Closed loop",
            loop,
            [(0, 1), (1, 2), (2, 3), (3, 4), (4, 1)],
            "The distance of the centroid to the setpoint determines the field strength.",
            (620, 160),
            True,
        )
    )
    found.show(
        read.figure(opened.folder / "report.html", "Path in the picture", "Open loop: path of the swarm"),
        read.figure(closed.folder / "report.html", "Distance to the setpoint", "Closed loop: distance to the setpoint"),
    )


def strength(s, scene):
    """Estimated distance to the setpoint and commanded field strength in field units, per frame."""
    unit, gain = _si(scene["scale"]["field_unit"], "T"), _si(scene["field"]["gain"], "T/A")
    m = np.hypot(s["current_0_a"], s["current_1_a"]) * gain / unit
    d = np.hypot(s["estimated_centroid_x_px"] - s["setpoint_x_px"], s["estimated_centroid_y_px"] - s["setpoint_y_px"])
    return d, m


def _si(value, unit):
    """A value of scenario.toml in SI units; the unit is optional."""
    return float(value.removesuffix(unit)) if isinstance(value, str) else float(value)


def _law(lab):
    """The properties of the fuzzy controller from `faba parts`, and the defaults of breakpoints and maximum output."""
    about = lab.call("parts", "parts").answer["controller"]["fuzzy"]["properties"]
    return about, tuple(float(about[k]["default"]) for k in ("near_px", "far_px", "max_output"))


def far(d, near, far_px):
    return np.clip((d - near) / (far_px - near), 0, 1)


def memberships(lab, found):
    about, (near, far_px, most) = _law(lab)
    step = lab.run("basic-film", BASIC)
    d, m = strength(read.series(step), read.scenario(step))
    measured = 2 * m / most - 1
    off = float(np.abs(measured - far(d, near, far_px)).max())
    found.value = (
        f"“close” up to {near:g} px, “far” from {far_px:g} px (assumed); memberships from the commands of a run deviate by at most {off:.1e}"
    )
    found.within(
        "Maximum deviation of the memberships from the trapezoids",
        off,
        None,
        1e-5,
        "series.csv has 9 digits, and d is a difference of two numbers up to 640",
    )
    found.true(
        "The program reports the breakpoints as assumed",
        all("assumed" in str(about[k]) for k in ("near_px", "far_px")),
        "the thesis gives them only in a figure",
    )
    at = np.linspace(0, 160, 321)
    found.show(
        plot.plot(
            "Membership functions",
            "distance (px)",
            "membership",
            [
                ("line", "close", at, 1 - far(at, near, far_px)),
                ("line", "far", at, far(at, near, far_px)),
                ("dots", "from the commands of a run", d, measured),
            ],
            "Dots: membership in \u201cfar\u201d computed from the commands of a run.",
            x=(0, 160),
            wide=True,
        )
    )


def sugeno(lab, found):
    _, (near, far_px, most) = _law(lab)
    calls = [
        lab.a_run(
            f"fuzzy-{d}",
            BASIC,
            "swarm[0].count=1",
            f'swarm[0].start={{type="places", places_px=[[{320 - d}, 240]], scatter_px=0}}',
            *NEITHER,
            "--duration",
            "0.0667 s",
        )
        for d in VECTOR
    ]
    commands = []
    for step in lab.all(calls):
        d, m = strength(read.series(step), read.scenario(step))
        commands.append((float(d[0]), float(m[0])))
    worst = max(abs(m - most / 2 * (1 + far(d, near, far_px))) for d, m in commands)
    step = lab.run("basic-film", BASIC)
    d, m = strength(read.series(step), read.scenario(step))
    found.value = "M = " + ", ".join(f"{m:.3f}" for _, m in commands) + " at " + ", ".join(f"{d:.0f}" for d, _ in commands) + " px"
    found.within(
        "Maximum difference to the weighted mean of the rules",
        worst,
        None,
        1e-6,
        "eq. 3.2 at the recorded distance; series.csv has 9 digits",
    )
    for (d0, m0), (wanted, output) in zip(commands, VECTOR.items()):
        found.about(
            f"M at {wanted} px",
            m0,
            output,
            1e-6 + abs(d0 - wanted) * most / 2 / (far_px - near),
            f"test vector with m_max = 5 and breakpoints at 40 and 120 px; the recorded distance is {d0:.4f} px",
        )
    at = np.linspace(0, 330, 331)
    found.show(
        plot.plot(
            "Field strength",
            "distance (px)",
            "command (field units)",
            [("line", "eq. 3.2", at, most / 2 * (1 + far(at, near, far_px))), ("dots", "commands of a run", d, m)],
            "Half of the maximum near the setpoint, the maximum far from it.",
            y=(0, 5.4),
            wide=True,
        )
    )


def corner(lab, found):
    film = lab.run("corner", "scenes/corner.toml")
    times = []
    for s in seeds(lab, "corner-seed", "scenes/corner.toml"):
        off = np.hypot(s["true_centroid_x_px"] - s["true_centroid_x_px"][-1], s["true_centroid_y_px"] - s["true_centroid_y_px"][-1])
        times.append(float(s["t_s"][np.flatnonzero(off <= 30)[0]]))
    mean, low, high = stats.mean_ci95(times)
    scene = read.scenario(film)
    swarm, field = scene["swarm"][0], [1e6 * _si(b, "T") for b in scene["controller"]["field"]]
    found.chosen = (
        "The thesis gives the size of the grid, the direction, and the arrival in the corner after 4 s. All other inputs are assumed:"
        f" model Basic with {swarm['model']['max_speed']:g} px per iteration (the best model of the thesis has 8.1181, and steps are"
        f" integers), {swarm['count']} cells (as in the next experiment of the thesis), a start in a disc with a radius of"
        f" {swarm['start']['radius_px']:g} px at the centre, a constant field of {abs(field[0]):g} and {abs(field[1]):g} µT"
        " along x and y (5 field units each), one iteration per frame at 15 Hz. The arrival is the first time at which the centroid of the"
        " swarm is within 30 px of its final position."
    )
    found.value = f"{mean:.2f} s (95 % interval of the mean {low:.2f} to {high:.2f} s; ten seeds: {min(times):.2f} to {max(times):.2f} s)"
    found.within("Shortest of ten seeds", min(times), 3.5, 4.6, WHY, "s")
    found.within("Longest of ten seeds", max(times), 3.5, 4.6, WHY, "s")
    found.show(frames(film, "Into the top-left corner"), read.figure(film.folder / "report.html", "Path in the picture"))


def to_the_centre(lab, found):
    films = lab.all([lab.a_run("basic-film", BASIC), lab.a_run("adapted-film", ADAPTED)])
    a = [s.answer for s in films]
    found.value = "; ".join(
        f"{n}: settling time {x['settling_time_s']:.1f} s, steady-state distance {x['steady_rms_px']:.1f} px rms"
        for n, x in zip(("Basic", "Adapted"), a)
        if x["settling_time_s"] is not None
    )
    for name, x, low, high in (("Basic", a[0], 1.5, 3), ("Adapted", a[1], 2.8, 4.5)):
        found.within(f"{name}: distance to the setpoint in the last third", x["steady_rms_px"], low, high, WHY, "px rms")
    found.show(*(frames(s, f"{n}: from the edge to the centre") for n, s in zip(("Basic, 8", "Adapted, 9"), films)))


def distance(lab, found):
    runs = {n: seeds(lab, f"{n}-seed", scene) for n, scene in (("basic", BASIC), ("adapted", ADAPTED))}
    signs = {n: seeds(lab, f"{n}-sign", scene, "controller.direction=axis-sign") for n, scene in (("basic", BASIC), ("adapted", ADAPTED))}
    straight, by_axis = ({n: [arrival(s) for s in of] for n, of in each.items()} for each in (runs, signs))
    lead, low, high = stats.mean_ci95(np.subtract(by_axis["adapted"], by_axis["basic"]))
    even, even_low, even_high = stats.mean_ci95(np.subtract(straight["adapted"], straight["basic"]))
    rms = {n: stats.mean_ci95([steady(s) for s in of]) for n, of in runs.items()}
    found.value = (
        f"within 32 px after {np.mean(straight['basic']):.0f} (Basic) and {np.mean(straight['adapted']):.0f} iterations (Adapted);"
        f" steady-state distance {rms['basic'][0]:.1f} [{rms['basic'][1]:.1f}, {rms['basic'][2]:.1f}] and {rms['adapted'][0]:.1f}"
        f" [{rms['adapted'][1]:.1f}, {rms['adapted'][2]:.1f}] px rms; with one command per axis Basic is {lead:.0f}"
        f" [{low:.0f}, {high:.0f}] iterations faster"
    )
    for n, model in (("basic", "Basic"), ("adapted", "Adapted")):
        found.within(f"{model}: iterations until the distance is below 32 px, mean of ten seeds", float(np.mean(straight[n])), 55, 75, WHY)
    found.within("Basic: distance to the setpoint in the last third", rms["basic"][0], 1.5, 3, WHY, "px rms")
    found.within("Adapted: distance to the setpoint in the last third", rms["adapted"][0], 2.8, 4.5, WHY, "px rms")
    found.within(
        "Iterations of Adapted minus those of Basic, one command per axis: lower limit of the 95 % interval",
        low,
        0,
        None,
        "Basic is significantly faster, as published, if the interval of the paired difference is above zero",
        "it",
    )
    found.note.append(
        "The rules of the thesis determine the field strength but not its direction. With a field in the direction of the setpoint both"
        f" models take the same time (difference {even:+.1f} [{even_low:.1f}, {even_high:.1f}] iterations). With one command per axis, the"
        " other possible reading, Basic is faster. In both cases Basic stays closer to the setpoint."
    )
    found.show(
        both("Distance to the setpoint", "distance (px)", "distance_px", runs, "Field towards the setpoint; means of ten seeds."),
        both("Distance, one command per axis", "distance (px)", "distance_px", signs, "direction = axis-sign; means of ten seeds."),
    )


def both(heading, label, column, runs, caption):
    layers = [("line", name if name in LATER else name.capitalize(), np.arange(400), np.mean([s[column][:400] for s in of], axis=0)) for name, of in runs.items()]
    return plot.plot(heading, "iteration", label, layers, caption)


def dispersion(lab, found):
    runs = {n: seeds(lab, f"{n}-seed", scene) for n, scene in (("basic", BASIC), ("adapted", ADAPTED))}
    bare = seeds(lab, "adapted-quiet", ADAPTED, "swarm[0].model.noise_amplitude=0")
    states = (
        'controller.set=[{name="at", trapezoid_px=[0, 0, 1, 8], output=0}, {name="near", trapezoid_px=[1, 8, 40, 120], output=2.5}, '
        '{name="far", trapezoid_px=[40, 120, 1e9, 1e9], output=5}]'
    )
    three = seeds(lab, "basic-three", BASIC, states)
    last = {n: stats.mean_ci95([s["true_sigma_x_px"][-1] for s in of]) for n, of in {**runs, "bare": bare, "three": three}.items()}
    at50 = {n: stats.mean_ci95([s["true_sigma_x_px"][50] for s in of]) for n, of in {**runs, "bare": bare}.items()}
    found.value = (
        f"σx after 50 iterations: Basic {at50['basic'][0]:.0f}, Adapted {at50['adapted'][0]:.0f} px; at the end"
        f" {last['basic'][0]:.0f} [{last['basic'][1]:.0f}, {last['basic'][2]:.0f}] and {last['adapted'][0]:.0f} [{last['adapted'][1]:.0f},"
        f" {last['adapted'][2]:.0f}] px"
    )
    for n, model, low, high in (("basic", "Basic", 115, 150), ("adapted", "Adapted", 170, 205)):
        found.within(f"{model}: σx at the end", last[n][0], low, high, WHY, "px")
        found.within(f"{model}: σy at the end", float(np.mean([s["true_sigma_y_px"][-1] for s in runs[n]])), 125, 155, WHY, "px")
    found.within(
        "σx after 50 iterations: Adapted without noise divided by Adapted",
        at50["bare"][0] / at50["adapted"][0],
        0.75,
        None,
        "more than half of the variance (0.75² = 0.56) remains without noise: it comes from the different speeds of the cells",
    )
    change, low, high = stats.mean_ci95([a["true_rms_radius_px"][-1] - b["true_rms_radius_px"][-1] for a, b in zip(three, runs["basic"])])
    found.within(
        "Final rms radius with three fuzzy states minus that with two: upper limit of the 95 % interval",
        high,
        0,
        None,
        "not significantly smaller: a uniform field moves all cells in the same way",
        "px",
    )
    found.note.append(
        f"A third fuzzy state changes the rms radius by {change:+.1f} [{low:.1f}, {high:.1f}] px. Cells distributed uniformly in the box"
        " would have σ = 185 × 139 px."
    )
    layers = [
        ("line", n, np.arange(400), np.mean([s["true_sigma_x_px"][:400] for s in of], axis=0))
        for n, of in (("Basic", runs["basic"]), ("Adapted", runs["adapted"]), ("Adapted without noise", bare))
    ]
    found.show(
        both(
            "Dispersion", "rms radius (px)", "true_rms_radius_px", runs, "Root-mean-square distance to the centroid; means of ten seeds."
        ),
        plot.plot(
            "Dispersion along x",
            "iteration",
            "σx (px)",
            layers,
            "The dispersion of Adapted without noise comes only from the different speeds of its cells.",
        ),
    )


def route(lab, found):
    goals = [[320, 110], [540, 240], [320, 370], [320, 240]]
    step = lab.run("route", BASIC, f'reference={{type="route", setpoints_px={goals}}}')
    a = step.answer
    error = a["cross_track_rms_px"]
    found.value = (
        f"{a['setpoints_reached']} of {len(goals)} setpoints reached, final distance {a['final_distance_px']:.1f} px; cross-track error"
        f" {error:.1f} px rms"
        if error
        else ""
    )
    found.within(
        "Setpoints reached",
        a["setpoints_reached"],
        len(goals),
        len(goals),
        "counted from the recording, with the tolerance of the route",
    )
    found.within("Final distance to the last setpoint", a["final_distance_px"], None, 10, "the tolerance of the route", "px")
    found.show(
        read.figure(step.folder / "report.html", "Path in the picture"),
        read.figure(step.folder / "report.html", "Distance to the setpoint"),
    )
    found.show(frames(step, "Along the route"))


# No estimator that predicts: the camera of the experiment has no delay.
LATER = {"fuzzy": (), "lqr": ('controller={type="lqr"}',), "mpc": ('controller={type="mpc"}',)}


def beyond(lab, found):
    runs = {
        (name, model): seeds(lab, f"{model.lower()}-seed" if name == "fuzzy" else f"{model.lower()}-{name}", scene, *settings)
        for name, settings in LATER.items()
        for model, scene in (("Basic", BASIC), ("Adapted", ADAPTED))
    }
    rms = {key: [steady(s) for s in of] for key, of in runs.items()}
    found.value = "steady-state distance: " + "; ".join(
        f"{model} {', '.join(f'{name} {np.mean(rms[name, model]):.2f}' for name in LATER)} px rms" for model in ("Basic", "Adapted")
    )
    for name in ("lqr", "mpc"):
        change, low, high = stats.mean_ci95(np.subtract(rms[name, "Basic"], rms["fuzzy", "Basic"]))
        found.within(
            f"Basic: distance with {name} minus that with fuzzy, upper limit of the 95 % interval",
            high,
            None,
            0,
            "significantly smaller if the interval of the paired difference is below zero",
            "px",
        )
        worse, low, high = stats.mean_ci95(np.subtract(rms[name, "Adapted"], rms["fuzzy", "Adapted"]))
        found.note.append(f"Adapted: {name} minus fuzzy {worse:+.1f} [{low:.1f}, {high:.1f}] px.")
    found.note.append(
        "Cells of Adapted keep their velocity for two iterations and swim at their own speed in any field, so that every controller makes"
        " them cross the setpoint. No controller reduces the dispersion."
    )
    for model in ("Basic", "Adapted"):
        curves = {name: runs[name, model] for name in LATER}
        found.show(
            both(f"Distance to the setpoint, {model}", "distance (px)", "distance_px", curves, "Means of ten seeds."),
            both(f"Dispersion, {model}", "rms radius (px)", "true_rms_radius_px", curves, "Means of ten seeds."),
        )
