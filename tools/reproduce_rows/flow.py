"""Optical flow and histogram distance: appendix B.1 to B.5 and B.8."""

import math

import numpy as np

from reproduce_rows import plot, read

SHIFT = (0.6, -0.3)
ALPHA2 = 100.0
# Quadratic-Chi distances of P and Q; two independent programs agree on all digits given.
P, Q = (1, 0, 2, 3, 0, 0), (0, 1, 2, 5, 0, 0)
TABLE = {
    (1, 0): 2.449489742783,
    (1, 0.5): 1.581138830084,
    (1, 0.9): 1.447318999187,
    (2, 0): 2.236067977500,
    (2, 0.5): 0.957050245237,
    (2, 0.9): 0.652248645707,
    (3, 0): 2.449489742783,
    (3, 0.5): 0.837148187674,
    (3, 0.9): 0.403214730772,
}


def pair(size=64, sigma=6.0):
    """A bright spot, and the same spot moved by SHIFT."""
    y, x = np.mgrid[0:size, 0:size] - (size - 1) / 2
    return [200 * np.exp(-((x - k * SHIFT[0]) ** 2 + (y - k * SHIFT[1]) ** 2) / (2 * sigma**2)) + 20 for k in (0, 1)]


def derivatives(a, b):
    """Ix, Iy, It: means of four first differences over 2 x 2 pixels of both frames; border pixels are repeated."""
    p, q = (np.pad(i, ((0, 1), (0, 1)), mode="edge") for i in (a, b))
    corners = {(k, r, c): i[r : r + a.shape[0], c : c + a.shape[1]] for k, i in ((0, p), (1, q)) for r in (0, 1) for c in (0, 1)}
    return [sum((1 if key[axis] else -1) * v for key, v in corners.items()) / 4 for axis in (2, 1, 0)]


def neighbours(f):
    p = np.pad(f, 1, mode="edge")
    h, w = f.shape

    def at(r, c):
        return p[1 + r : 1 + r + h, 1 + c : 1 + c + w]

    return (at(0, 1) + at(0, -1) + at(1, 0) + at(-1, 0)) / 6 + (at(1, 1) + at(1, -1) + at(-1, 1) + at(-1, -1)) / 12


def corrected(ix, iy, it, sweeps):
    u = v = np.zeros_like(ix)
    for _ in range(sweeps):
        ua, va = neighbours(u), neighbours(v)
        s = (ix * ua + iy * va + it) / (ALPHA2 + ix**2 + iy**2)
        u, v = ua - ix * s, va - iy * s
    return u, v


def as_printed(ix, iy, it, sweeps):
    """The iteration with the misprint of the appendix: Ix It in both rows."""
    u = v = np.zeros_like(ix)
    det = ALPHA2 * (ALPHA2 + ix**2 + iy**2)
    for _ in range(sweeps):
        p, q = ALPHA2 * neighbours(u) - ix * it, ALPHA2 * neighbours(v) - ix * it
        u, v = ((ALPHA2 + iy**2) * p - ix * iy * q) / det, ((ALPHA2 + ix**2) * q - ix * iy * p) / det
    return u, v


def horn_schunck(lab, found):
    a, b = (np.rint(i) for i in pair())
    files = [lab.write("flow", f"{n}.pgm", read.pgm(i)) for n, i in zip("ab", (a, b))]
    ix, iy, it = derivatives(a, b)
    error, off, sweeps = [], 0.0, (1, 3, 10, 30, 100, 300, 1000, 3000)
    middle = np.s_[22:42, 22:42]  # the spot, up to 1.7 standard deviations from its centre
    steps = lab.all(
        [
            (
                f"flow-{n}",
                "flow",
                *files,
                "--smooth",
                "0",
                "--alpha2",
                f"{ALPHA2:g}",
                "--solver",
                "jacobi",
                "--iterations",
                str(n),
                "--tolerance",
                "0",
                "--out",
                "@ab.flo",
                "--force",
            )
            for n in sweeps
        ]
    )
    for n, step in zip(sweeps, steps):
        u, v = read.flo(step.folder / "ab.flo")
        mine = corrected(ix, iy, it, n)
        off = max(off, float(np.abs(u - mine[0]).max()) / (n + 1), float(np.abs(v - mine[1]).max()) / (n + 1))
        error.append(float(np.hypot(u - SHIFT[0], v - SHIFT[1])[middle].mean()))
    mean = [float(f[middle].mean()) for f in (u, v)]
    wrong = [float(f[middle].mean()) for f in as_printed(ix, iy, it, 1000)]
    found.value = (
        f"({mean[0]:.3f}, {mean[1]:.3f}) px for a spot that moved by ({SHIFT[0]}, {SHIFT[1]}) px; the printed system gives "
        f"({wrong[0]:.1f}, {wrong[1]:.1f}) px"
    )
    found.beside = "The correct iteration and the printed system, both written in Python. They are compared with the flow of the program."
    found.within(
        "Maximum difference to the iteration in Python, per sweep",
        off,
        None,
        2**-23,
        "same equations, 1 to 3000 sweeps; the rounding error of a sweep is at most the spacing of 32-bit floats at 1 px",
        "px",
    )
    found.within(
        "Error of the mean flow on the spot",
        float(np.hypot(mean[0] - SHIFT[0], mean[1] - SHIFT[1])),
        None,
        0.067,
        "10 % of the motion; the smoothness term makes the flow smaller than the motion",
        "px",
    )
    found.true(
        "The mean error decreases from 1 to 3000 sweeps", all(q < p for p, q in zip(error, error[1:])), "the iteration converges to the flow"
    )
    found.within(
        "Error of the printed system",
        float(np.hypot(wrong[0] - SHIFT[0], wrong[1] - SHIFT[1])),
        0.67,
        None,
        "larger than the motion, so the thesis cannot have used the printed system",
        "px",
    )
    shown = lab.call("flow-picture", "flow", *files, "--smooth", "0", "--preset", "published", "--picture", "@flow.png", "--force")
    found.show(
        plot.plot(
            "Convergence",
            "log\u2081\u2080 of the number of sweeps",
            "mean error (px)",
            [("line", "", np.log10(sweeps), error), ("dots", "", np.log10(sweeps), error)],
            f"Mean over the spot; α² = {ALPHA2:g}.",
        ),
        plot.picture("The two pictures", plot.png(np.hstack([a, np.full((len(a), 2), 255), b]), 4)),
        plot.picture("Optical flow", shown.folder / "flow.png", "100 sweeps. Hue: direction; saturation: speed."),
    )


def quadratic_chi(p, q, threshold, m):
    """The definition of the Quadratic-Chi distance, as two sums."""
    n = len(p)
    like = [[max(1 - abs(i - j) / threshold, 0) for j in range(n)] for i in range(n)]
    d = []
    for i in range(n):
        z = sum((p[c] + q[c]) * like[c][i] for c in range(n))
        d.append((p[i] - q[i]) / z**m if z > 0 else 0.0)
    return math.sqrt(max(0.0, sum(d[i] * d[j] * like[i][j] for i in range(n) for j in range(n))))


def distance(lab, found):
    files = [lab.write("distance", f"{n}.txt", "".join(f"{x}\n" for x in values)) for n, values in (("p", P), ("q", Q))]
    steps = lab.all([(f"distance-{t}-{m}", "distance", *files, "--threshold", str(t), "--m", str(m)) for t, m in TABLE])
    reported = {key: s.answer["distance"][0] for key, s in zip(TABLE, steps)}
    worst = max(abs(reported[k] - TABLE[k]) for k in TABLE)
    definition = max(abs(reported[k] - quadratic_chi(P, Q, *k)) for k in TABLE)
    found.value = (
        "; ".join(f"T = {t}: " + ", ".join(f"{reported[t, m]:.12f}" for m in (0, 0.5, 0.9)) for t in (1, 2, 3)) + " for m = 0, 0.5, 0.9"
    )
    found.within(
        "Maximum difference to the table", worst, None, 6e-13, "nine values with twelve digits: half of the last digit, and rounding errors"
    )
    found.within("Maximum difference to the definition", definition, None, 1e-12, "same formula; rounding errors only")
    # The distance of a peak to a moved peak no longer increases beyond the threshold T.
    moved = []
    for k in range(9):
        a, b = ([10 if i == at else 0 for i in range(12)] for at in (1, 1 + k))
        files = [
            lab.write("distance", f"{n}-{k}.txt", "".join(f"{x}\n" for x in values), shown=False) for n, values in (("from", a), ("to", b))
        ]
        moved.append(lab.call(f"distance-moved-{k}", "distance", *files, "--threshold", "3", "--m", "0.9").answer["distance"][0])
    found.within("Distance of a peak to itself", moved[0], 0, 0, "QC(P, P) = 0")
    found.within(
        "Distance of a peak moved by 8 bins minus that of a peak moved by 3 bins",
        moved[8] - moved[3],
        -1e-12,
        1e-12,
        "the distance is constant beyond the threshold of 3 bins",
    )
    found.show(
        plot.plot(
            "Distance of a moved peak",
            "displacement (bins)",
            "distance",
            [("line", "", range(9), moved), ("dots", "", range(9), moved)],
            "T = 3, m = 0.9, peak height 10.",
        )
    )
