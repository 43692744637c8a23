#!/usr/bin/python3
"""How long a study of 2000 simulations takes: 500 cells, 90 frames of 320 x 240 px, one parameter. The cells themselves are measured (no
camera), then what a camera sees of them at twelve moments, then the flow of all frames, as the thesis's rule does. Checks that the truth is
in the interval, and prints a table; keeps it in bench/results/.

    bench/study.py [--program build/faba] [--simulations 2000] [--out bench/results]

Flows are measured on the fifteen simulations of the rule, and the time of 2000 of them is that times 133. Exits 1 when an answer is wrong.
"""

import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
TRUTH = 7
SCENE = f"""duration = "6 s"
[scale]
um_per_px = 1.16
[microscope]
cell_diameter = "2.5 um"
[arena]
type = "drop"
view_px = [320, 240]
radius_px = 500
centre_px = [530, 119.5]
[[swarm]]
count = 500
model = {{ type = "basic", max_speed = {TRUTH} }}
start = {{ type = "edge", direction = "180 deg", visible = true }}
[controller]
type = "manual"
field = ["115 uT", "0 T"]
[[controller.segment]]
at = "1 s"
field = ["-115 uT", "0 T"]
[[controller.segment]]
at = "3 s"
field = ["115 uT", "0 T"]
[record]
as_seen = true
lossless = true
tracks = false
"""
STUDY = """boundary = "drop"
field_strength = "115 uT"
simulations = {simulations}
look = "{look}"
legacy = {legacy}
[[video]]
file = "film"
[[model]]
type = "basic"
free = {{ "swarm[0].model.max_speed" = [1, 20] }}
"""
RULE = 15  # simulations of the thesis's rule for one model


def timed(o, folder, look, legacy=False):
    (folder / "study.toml").write_text(STUDY.format(simulations=o.simulations, look=look, legacy=str(legacy).lower()))
    begun = time.monotonic()
    done = subprocess.run([o.program, "identify", "study.toml", "--json", "--force", "--out", f"{look}-{legacy}"], cwd=folder, capture_output=True,
                          text=True)
    if done.returncode:
        sys.exit(f"study.py: {done.stderr}")
    p = json.loads(done.stdout)["models"][0]["parameters"]["swarm[0].model.max_speed"]
    return time.monotonic() - begun, p


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("--program", type=pathlib.Path, default=HERE.parent / "build/faba")
    a.add_argument("--simulations", type=int, default=2000)
    a.add_argument("--out", type=pathlib.Path, default=HERE / "results")
    o = a.parse_args()
    o.program = o.program.resolve()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "scene.toml").write_text(SCENE)
        subprocess.run([o.program, "run", "scene.toml", "--seed", "1", "--quiet", "--out", "film"], cwd=folder, check=True)
        cells, p = timed(o, folder, "positions")
        seen, q = timed(o, folder, "video")
        with_rule, _ = timed(o, folder, "video", legacy=True)
    flows = (with_rule - seen) / RULE * o.simulations
    right = all(x["ci90"][0] <= TRUTH <= x["ci90"][1] for x in (p, q))
    table = [f"# A study of {o.simulations} simulations, {os.cpu_count()} processors", "",
             "500 cells for 90 frames of 320 × 240 px. Made by `bench/study.py`.", "",
             "| what is measured | s | goal, s |", "|---|---|---|",
             f"| the cells themselves | {cells:.1f} | 15 |", f"| what a camera sees, at twelve moments | {seen:.0f} | |",
             f"| that and the flow of all frames ({RULE} simulations measured) | {seen + flows:.0f} | 2400 |", "",
             f"Truth {TRUTH}: found {p['median']:.2f} [{p['ci90'][0]:.2f}, {p['ci90'][1]:.2f}] and {q['median']:.2f} "
             f"[{q['ci90'][0]:.2f}, {q['ci90'][1]:.2f}]{'' if right else ' WRONG'}."]
    print("\n".join(table))
    o.out.mkdir(parents=True, exist_ok=True)
    (o.out / "study.md").write_text("\n".join(table) + "\n")
    sys.exit(0 if right else 1)


if __name__ == "__main__":
    main()
