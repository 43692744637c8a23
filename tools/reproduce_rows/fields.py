"""Coils and their fields: Figs 3.11 to 3.14, 4.5, B.9, B.11, equations B.6 and B.7."""

import math

import h5py
import numpy as np

from reproduce_rows import plot, read

TWO, FOUR = "rigs/thesis-two-coils.toml", "rigs/thesis-four-coils.toml"
MU0 = 1.25663706127e-6
# Reference coil system: values computed with 30 digits and rounded to the digits given; the tolerance is half of the last digit.
PER_COIL_MT = 0.2966  # mT/A of one coil at the centre
CUSP = (-0.0388, 0.0194)  # T/m, opposing fields, 0.5 A
NULL_MM = 0.852  # distance of the zero from the middle, currents in the ratio 1.25 to 1


def field_map(lab, name, rig, *words):
    return lab.call(name, "field", "map", rig, *words, "--picture", "@field.png", "--out", "@field.h5", "--force")


def field_of(step):
    with h5py.File(step.folder / "field.h5") as f:
        return f["b_t"][:], f["x_m"][:], f["y_m"][:]


def concurring(lab, found):
    step = field_map(lab, "coils-alike", TWO, "--current=-0.25,0.25", "--size", "6 mm, 4.5 mm")
    b, x, y = field_of(step)
    bx, by = b[:, :, 0], b[:, :, 1]
    view = np.ix_(np.abs(y) <= 0.24e-3, np.abs(x) <= 0.32e-3)
    off = np.degrees(np.arctan2(np.abs(by), bx))
    centre = 1e3 * bx[np.abs(y).argmin(), np.abs(x).argmin()]
    found.value = (
        f"{centre:.4f} mT at the centre with 0.25 A; the direction deviates from the axis by at most {off.max():.1f}° in 6 × 4.5 mm and"
        f" {off[view].max():.2f}° in 0.64 × 0.48 mm"
    )
    found.within("Zeros of the field", len(step.answer["zeros"]), 0, 0, "the fields of the two coils have the same direction")
    found.within(
        "Maximum angle to the axis of the coils in the sample",
        off.max(),
        None,
        45,
        "at every point the component along the axis is larger than the component across it",
        "°",
    )
    found.about(
        "Field at the centre",
        centre,
        0.5 * PER_COIL_MT,
        0.25e-4,
        "two coils with 0.2966 mT/A each at 0.25 A; half of the last digit",
        "mT",
    )
    found.show(
        plot.picture(
            "Fields in the same direction",
            step.folder / "field.png",
            "6 × 4.5 mm between the two coils; the coils are outside the picture on the left and on the right.",
            True,
        )
    )


def opposed(lab, found):
    step = field_map(lab, "coils-opposed", TWO, "--current", "0.5,0.5", "--size", "6 mm, 4.5 mm")
    zeros = step.answer["zeros"]
    low, high = sorted(zeros[0]["eigenvalues_t_per_m"]) if zeros else (math.nan, math.nan)
    found.value = f"one zero between the coils, a saddle point with gradients of {low:.4f} and +{high:.4f} T/m"
    found.within("Zeros of the field between the coils", len(zeros), 1, 1, "the fields of two equal coils cancel half-way between them")
    found.true(
        "The zero is a saddle point",
        bool(zeros) and zeros[0]["kind"] == "saddle",
        "divergence and curl are zero, so the gradients along and across the axis have opposite signs",
    )
    found.about("Gradient along the axis", low, CUSP[0], 0.5e-4, "reference coil system, 0.5 A; half of the last digit", "T/m")
    found.about("Gradient across the axis", high, CUSP[1], 0.5e-4, "minus half of the gradient along the axis", "T/m")
    found.show(
        plot.picture(
            "Opposing fields",
            step.folder / "field.png",
            "The field points to the zero from the left and from the right, and away from it upwards and downwards.",
            True,
        )
    )


def computed(lab, found):
    step = field_map(lab, "coils-unlike", TWO, "--current", "0.5,0.4", "--size", "6 mm, 4.5 mm")
    four = field_map(lab, "coils-four", FOUR, "--current", "0.5,0.5,0.5,0.5", "--size", "130 mm, 130 mm")
    zeros = step.answer["zeros"]
    x = 1e3 * abs(zeros[0]["at_m"][0]) if zeros else math.nan
    found.value = f"opposing fields, currents of 0.5 A and 0.4 A: the zero is {x:.3f} mm from the middle"
    found.about(
        "Distance of the zero from the middle",
        x,
        NULL_MM,
        0.5e-3,
        "reference coil system, currents in the ratio 1.25 to 1; half of the last digit",
        "mm",
    )
    found.show(
        plot.picture("Two coils, 0.5 A and 0.4 A", step.folder / "field.png", "The zero is displaced towards the weaker coil."),
        plot.picture(
            "Four coils, 0.5 A each, fields inwards",
            four.folder / "field.png",
            "130 × 130 mm: with four coils the zero in the middle is a trap in the plane.",
        ),
    )


def library(lab, found):
    made = lab.call("library", "field", "library", FOUR, "--size", "4.4 mm, 4.4 mm", "--levels", "20", "--out", "@library.h5", "--force")
    file = lab.at("library", "library.h5")
    setting = [f"library.file={file}", 'controller={type="gradient", source="library"}']
    step = lab.run("library-run", "scenes/null-route.toml", *setting, after=[made])
    with h5py.File(made.folder / "library.h5") as f:
        zeros, currents = f["zero_m"][:], f["current_a"][:]
    s, scene = read.series(step), read.scenario(step)
    um = 1e-6 * scene["scale"]["um_per_px"]
    view = step.answer["view_px"]
    middle = (np.array([view["x"], view["y"]] if isinstance(view, dict) else view) - 1) / 2
    wrong, south = 0, -1  # the cells are south-seeking, the traps of the library are for north-seeking cells
    for k in range(len(s["t_s"])):
        at = np.array([s["setpoint_x_px"][k] - middle[0], middle[1] - s["setpoint_y_px"][k]]) * um
        off = np.linalg.norm(zeros - at, axis=1)
        nearest = currents[off <= off.min() + 1e-9]
        given = np.array([s[f"current_{i}_a"][k] for i in range(4)])
        wrong += min(min(np.abs(given - c).max(), np.abs(given - south * c).max()) for c in nearest) > 1e-6
    off_um = 1e6 * made.answer["null_error_m"]["median"]
    found.value = (
        f"the library has {made.answer['entries']} fields from {made.answer['combinations']} sets of currents; median distance of a"
        f" position to the nearest zero {off_um:.0f} µm; the swarm reached {step.answer['setpoints_reached']} of"
        f" {step.answer['setpoints']} setpoints"
    )
    found.within(
        "Frames with other currents than those of the nearest zero", wrong, 0, 0, "compared with the table of the library in every frame"
    )
    found.within("Frames compared", len(s["t_s"]), 900, 900, "60 s at 15 Hz")
    found.note.append(
        f"Solving for the currents places the zero exactly at the setpoint and takes less than 1 ms; with the library its median distance is"
        f" {off_um:.0f} µm."
    )
    found.show(read.figure(step.folder / "report.html", "Path in the picture"), read.figure(step.folder / "report.html", "Coil currents"))


def _sides(step):
    """Positions in the last frame relative to the centre of the drop, in units of its radius."""
    places, _ = read.tracks(step)
    arena = read.scenario(step)["arena"]
    return (places[-1] - np.array(arena["centre_px"])) / arena["radius_px"]


def four_configurations(lab, found):
    ideal = ["field.earth.field=[0, 0, 0]"]
    steps = dict(
        zip(
            "abcdef",
            lab.all(
                [lab.a_run(f"coils-{k}", f"scenes/thesis-coils-{k}.toml") for k in "abcd"]
                + [
                    lab.a_run("coils-c-ideal", "scenes/thesis-coils-c.toml", "controller.current=[-0.5, -0.5]", *ideal),
                    lab.a_run("coils-d-ideal", "scenes/thesis-coils-d.toml", "controller.current=[0.5, 0.5]", *ideal),
                ]
            ),
        )
    )
    at = {k: _sides(s) for k, s in steps.items()}
    left = {k: float((p[:, 0] < 0).mean()) for k, p in at.items()}
    inner = {k: float((np.linalg.norm(p, axis=1) < 0.5).mean()) for k, p in at.items()}
    found.value = (
        f"cells in the left half: a {100 * left['a']:.0f} %, b {100 * left['b']:.0f} %; in the inner quarter of the drop's area: "
        f"c {100 * inner['c']:.0f} %, d {100 * inner['d']:.0f} %"
    )
    most = "one swarm on this side; 5 % are allowed to be elsewhere"
    found.within("a: fraction of cells in the left half", left["a"], 0.95, None, most)
    found.within("b: fraction of cells in the right half", 1 - left["b"], 0.95, None, most)
    even = "below 0.25, the value for uniformly distributed cells: no swarm in the middle"
    found.within("c: fraction in the inner quarter", inner["c"], None, 0.25, even)
    found.within("d: fraction in the inner quarter", inner["d"], None, 0.25, even)
    side = {k: max(left[k], 1 - left[k], float((at[k][:, 1] < 0).mean()), float((at[k][:, 1] > 0).mean())) for k in "cd"}
    found.within("c: fraction on one side", side["c"], 0.75, None, "one swarm at an edge, as in the experiment")
    found.within("d: fraction on one side", side["d"], 0.75, None, "as for c")
    ends = {
        "e": float((np.abs(at["e"][:, 1]) > np.abs(at["e"][:, 0])).mean()),
        "f": float((np.abs(at["f"][:, 0]) > np.abs(at["f"][:, 1])).mean()),
    }
    found.within(
        "c with equal currents, without the Earth's field: fraction of cells farther from the centre along the axis than across it",
        1 - ends["e"],
        None,
        0.25,
        "the saddle point pushes the swarm out across the axis",
    )
    found.note.append(
        "In c and d the currents differ by 10 % and the Earth's field of 18 µT is present, as in a coil system that is not calibrated. The"
        " zero is then outside the drop. With equal currents and without the Earth's field, c gives two swarms, at the upper and the lower"
        f" end of the drop ({100 * ends['e']:.0f} % of the cells; {100 * inner['e']:.0f} % are in the inner quarter), and none in the"
        f" middle; d gives the two expected swarms at the left and the right end ({100 * ends['f']:.0f} %)."
    )
    for k in "abcd":
        found.show(swarm(steps[k], f"({k}) after 60 s", "Circle: edge of the drop; dots: cells."))
    found.show(
        swarm(steps["e"], "(c), equal currents, no field of the Earth", ""),
        swarm(steps["f"], "(d), equal currents, no field of the Earth", ""),
    )


def swarm(step, heading, caption):
    """A plot of the cells in the last frame and the edge of the drop."""
    p = _sides(step)
    turn = np.linspace(0, 2 * np.pi, 181)
    layers = [("line", "", np.cos(turn), np.sin(turn)), ("dots", "", p[:, 0], -p[:, 1])]
    return plot.plot(heading, "x (radii of the drop)", "y", layers, caption, x=(-2.3, 2.3), y=(-1.1, 1.1))


def biot_savart(lab, found):
    radius, current = 0.02, 3.0
    rig = lab.write("loop", "loop.toml", f'[[coil]]\ntype = "loop"\nradius = "{radius} m"\naxis = [0, 0, 1]\ncurrent = "{current} A"\n')
    z = np.linspace(-0.1, 0.1, 201)
    points = lab.write("loop", "points.csv", "x_m,y_m,z_m\n" + "".join(f"0,0,{v!r}\n" for v in z.tolist()), shown=False)
    got = np.array(lab.call("loop", "field", "at", rig, "--points", points).answer["b_t"])
    law = MU0 * current * radius**2 / (2 * (radius**2 + z**2) ** 1.5)
    worst = float(np.max(np.abs(got[:, 2] / law - 1)))
    # Biot-Savart law, summed over n straight pieces of wire with the midpoint rule; relative error about (pi/n)^2/6.
    n, p = 20000, np.array([0.013, 0.004, 0.007])
    spot = lab.write("loop", "off-axis.csv", "x_m,y_m,z_m\n" + ",".join(map(repr, p.tolist())) + "\n")
    off = np.array(lab.call("loop-off", "field", "at", rig, "--points", spot).answer["b_t"][0])
    a = (np.arange(n) + 0.5) * 2 * np.pi / n
    wire = radius * np.stack([np.cos(a), np.sin(a), 0 * a], 1)
    along = radius * 2 * np.pi / n * np.stack([-np.sin(a), np.cos(a), 0 * a], 1)
    away = p - wire
    summed = MU0 * current / (4 * np.pi) * (np.cross(along, away) / np.linalg.norm(away, axis=1)[:, None] ** 3).sum(0)
    found.value = (
        f"relative difference to the formula at 201 points on the axis at most {worst:.1e}; to the sum over the wire at a point off the"
        f" axis {np.linalg.norm(off - summed) / np.linalg.norm(summed):.1e}"
    )
    found.within(
        "Maximum relative difference to B.7 on the axis",
        worst,
        None,
        1e-9,
        "identical formula; 17 digits are printed, and the elliptic integrals of the circular loop have an error of 1e-14",
    )
    found.within(
        "Relative difference to B.6, summed over the wire",
        float(np.linalg.norm(off - summed) / np.linalg.norm(summed)),
        None,
        1e-7,
        "error of the sum over 20000 pieces of wire: (π/20000)² = 2.5e-8 times a factor of order one",
    )
    found.show(
        plot.plot(
            "Field on the axis of a circular loop",
            "height (mm)",
            "field (µT)",
            [("line", "formula", 1e3 * z, 1e6 * law), ("dots", "program", 1e3 * z[::10], 1e6 * got[::10, 2])],
            "Radius 20 mm, 3 A.",
        )
    )


def magnet_and_coil(lab, found):
    magnet = lab.write(
        "magnet", "magnet.toml", '[[coil]]\ntype = "dipole"\nmoment = "1 A m^2/A"\nradius = "4 mm"\naxis = [1, 0, 0]\ncurrent = "1 A"\n'
    )
    coil = lab.write(
        "coil", "coil.toml", '[[coil]]\ntype = "loop"\nradius = "10 mm"\nwire_radius = "1 mm"\naxis = [1, 0, 0]\ncurrent = "1 A"\n'
    )
    maps = [field_map(lab, name, rig, "--size", "60 mm, 60 mm") for name, rig in (("magnet", magnet), ("coil", coil))]
    points = lab.write("magnet", "points.csv", "x_m,y_m,z_m\n0.05,0,0\n0,0.05,0\n")
    pole, side = (b[0] for b in lab.call("magnet-at", "field", "at", magnet, "--points", points).answer["b_t"])
    far = lab.write("coil", "far.csv", "x_m,y_m,z_m\n1,0,0\n")
    loop = lab.call("coil-at", "field", "at", coil, "--points", far).answer["b_t"][0][0]
    expected = MU0 / (2 * math.pi * 0.05**3)
    found.value = f"magnet of 1 A m²: at 50 mm {1e3 * pole:.4f} mT on its axis and {1e3 * side:.4f} mT perpendicular to the axis"
    found.about("Field on the axis divided by µ0 m / 2πr³", pole / expected, 1, 1e-9, "point dipole")
    found.about(
        "Field on the axis divided by the field perpendicular to it", pole / side, -2, 1e-9, "point dipole, at the same distance"
    )
    found.about(
        "Field of the coil at a distance of 100 radii divided by the field of its dipole",
        loop / (MU0 * 1e-4 / 2),
        1,
        1.5e-4 * 1.01,
        "the field of a circular loop is lower than that of its dipole by the fraction 3/2 (R/r)², 1.5e-4 here",
    )
    found.show(
        plot.picture("Field of a magnet", maps[0].folder / "field.png", "The axis of the magnet points to the right; 60 × 60 mm."),
        plot.picture("Field of a coil", maps[1].folder / "field.png", "Circular loop, cross-section through its axis; 60 × 60 mm."),
    )
