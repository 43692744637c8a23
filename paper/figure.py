#!/usr/bin/python3
"""Draws the figure of the paper from the table of the benchmark of controllers: paper/figure.py [docs/results/control.md] [paper/figure.png]

`faba benchmark-control` writes the table.
"""

import pathlib
import re
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent
SHOWN = {"fuzzy": ("fuzzy (thesis)", "#999999", "v"), "proportional": ("best of three tuned\nproportional laws", "#e69f00", "s"),
         "lqr": ("lqr", "#0072b2", "o"), "mpc": ("mpc", "#009e73", "^")}


def rows(text, case):
    """(controller, delay in frames, mean, half of the 95 % interval) of a case, for the steady-state error."""
    block = re.split(r"^## ", text.split(f"\n## {case}\n", 1)[1], maxsplit=1, flags=re.M)[0]
    table = [[cell.strip() for cell in line.strip("|").split("|")] for line in block.splitlines() if line.startswith("|")]
    names = table[0]
    error = next(i for i, name in enumerate(names) if name.startswith("Steady-state error"))
    for row in table[2:]:
        if len(row) == len(names):
            mean, _, half = row[error].partition("±")
            yield row[0], int(row[1]), float(mean), float(half or 0)


def series(text, case, name):
    found = {}
    for controller, delay, mean, half in rows(text, case):
        same = controller == name or (name == "proportional" and re.fullmatch(r"proportional \d", controller))
        if same and (delay not in found or mean < found[delay][0]):
            found[delay] = (mean, half)
    return found


def main():
    table = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else HERE.parent / "docs/results/control.md").read_text()
    out = sys.argv[2] if len(sys.argv) > 2 else HERE / "figure.png"
    figure, axes = plt.subplots(1, 2, figsize=(9.5, 3.2), sharey=True, layout="constrained")
    for axis, case in zip(axes, ("hold", "route")):
        for name, (label, colour, marker) in SHOWN.items():
            points = series(table, case, name)
            if not points:
                raise SystemExit(f"the table has no rows of {name} in the case {case}")
            delays = sorted(points)
            axis.errorbar(delays, [points[d][0] for d in delays], [points[d][1] for d in delays], label=label, color=colour, marker=marker, capsize=3)
        axis.set(title=case, xlabel="camera delay (frames of 1/60 s)", xticks=delays, yscale="log")
        axis.grid(alpha=0.3, which="both")
    axes[0].set_ylabel("steady-state error (px)")
    axes[1].legend(fontsize=8, loc="center left", bbox_to_anchor=(1, 0.5))
    figure.savefig(out, dpi=150, metadata={"Software": None})


if __name__ == "__main__":
    main()
