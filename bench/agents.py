#!/usr/bin/python3
"""Measures the speed of the simulation: ns per agent-step of the three models, compared with the limits of this machine and with
the same step in NumPy, vectorised Octave, a sequential C++ program and the design of the thesis. All programs run in one call, one
after the other. Prints tables and a verdict for every goal, and writes them to bench/results/.

    bench/agents.py [--quick] [--program build/bench/bench_agents] [--out bench/results]

--quick: up to 1e5 agents, less than a minute, written as agents-quick. Exit status 1 if a result is wrong; slow results do not fail.
"""

import argparse
import datetime
import json
import os
import pathlib
import platform
import shutil
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
MODELS, ORDERS = ("basic", "adapted", "dipole"), ("none", "two-phase")
GOAL = 100000  # agents at which the goals are set
OCTAVE = ["octave-cli", "--norc", "--no-history", "--quiet"]


def arguments():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--quick", action="store_true", help="up to 1e5 agents, less than a minute")
    p.add_argument("--program", type=pathlib.Path, default=HERE.parent / "build/bench/bench_agents", help="default build/bench/bench_agents")
    p.add_argument("--out", type=pathlib.Path, default=HERE / "results", help="folder of the results, default bench/results")
    return p.parse_args()


class Measurements:
    """The JSON lines of all programs; the first line describes the scene."""

    def __init__(self):
        self.rows, self.scene, self.failed = [], {}, []

    def run(self, what, command):
        """Runs a program and adds its lines. Wrong results are collected in `failed`; exits if a program fails otherwise."""
        print(f"  {what} ...", end="", file=sys.stderr, flush=True)
        start = time.monotonic()
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        print(f" {time.monotonic() - start:.0f} s", file=sys.stderr)
        for line in done.stdout.splitlines():
            row = json.loads(line)
            if row["kind"] == "scene":
                self.scene = row
                continue
            self.rows.append(row)
            for c in row.get("checks", []):
                if not c["ok"]:
                    case = " ".join(str(row.get(k, "")) for k in ("kind", "model", "agents", "order", "threads"))
                    self.failed.append(f"{case}: {c['what']}: {c['value']:.6g}; expected {c['expected']:.6g} "
                                       f"+- {c['tolerance']:.2g}")
        if done.returncode != 0 and not self.failed:
            sys.exit(f"agents.py: {what} failed:\n{done.stderr}")

    def ns(self, kind, **case):
        """Median ns of the row with these values, None if it was not measured."""
        for r in self.rows:
            if r["kind"] == kind and all(r.get(k) == v for k, v in case.items()):
                return r["ns"]
        return None

    def limit(self, model, agents, threads=1):
        """Lower limit of the time of one agent-step, ns: its random numbers, elementary functions and memory traffic."""
        part = {what: self.ns("limit", what=what, model=model, agents=agents, threads=threads)
                for what in ("philox", "sincos", "log", "traffic")}
        if model == "dipole":  # two Box-Muller pairs from one block
            return part["philox"] + 2 * part["sincos"] + 2 * part["log"] + part["traffic"]
        return part["philox"] / self.scene["hold"] + part["traffic"]

    def sizes(self):
        return sorted({r["agents"] for r in self.rows if r["kind"] == "faba"})


def measure(options):
    m = Measurements()
    if not options.program.exists():
        sys.exit(f"agents.py: program not found: {options.program}; build it with `make bench` or give its path with --program")
    quick = options.quick
    m.run("faba, limits of the machine, sequential C++", [options.program] + ["--quick"] * quick)
    sizes = [str(n) for n in m.sizes()]
    scene, seconds = json.dumps(m.scene), "0.1" if quick else "0.4"
    m.run("NumPy", [sys.executable, HERE / "peers/numpy_agents.py", scene, seconds, *sizes])
    if shutil.which(OCTAVE[0]):
        m.run("Octave, arrays", OCTAVE + [HERE / "peers/octave_agents.m", scene, seconds, *sizes])
        m.run("Octave, one object per bacterium",
              OCTAVE + [HERE / "peers/thesis_objects.m", scene, "2" if quick else "6", "1000", "10000"])
    else:
        print("  Octave not found (tools/setup.sh bench installs it): skipped", file=sys.stderr)
    return m


def processor():
    try:
        for line in open("/proc/cpuinfo"):
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    except OSError:
        pass
    return platform.processor() or "unknown"


def first_line(command):
    try:
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()[0].strip()
    except (OSError, subprocess.CalledProcessError, IndexError):
        return "not found"


def provenance(m, options, load):
    import numpy

    revision = first_line(["git", "-C", str(HERE), "rev-parse", "--short", "HEAD"])
    return {
        "date": datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%d %H:%M UTC"),
        "quick": options.quick,
        "processor": f"{processor()}, {os.cpu_count()} logical",
        "vector_unit": m.scene["vector_unit"],
        "faba": f"{m.scene['version']} ({revision})",
        "compiler": f"g++ {m.scene['compiler']}",
        "python": platform.python_version(),
        "numpy": numpy.__version__,
        "octave": first_line(OCTAVE + ["--version"]),
        "load_before": load,
    }


def number(v, digits=3):
    """Three significant digits without an exponent; "-" for None."""
    if v is None:
        return "-"
    if v >= 10 ** (digits - 1):
        return f"{v:,.0f}".replace(",", " ")
    return f"{v:.{digits}g}"


def ratio(a, b):
    return None if a is None or b is None else a / b


def times(v):
    return "-" if v is None else number(v) + "x"


def table(head, rows):
    """A Markdown table with aligned columns."""
    width = [max(len(r[i]) for r in [head] + rows) for i in range(len(head))]
    line = lambda cells: "| " + " | ".join(c.rjust(w) for c, w in zip(cells, width)) + " |"
    return "\n".join([line(head), "|" + "|".join("-" * (w + 1) + ":" for w in width) + "|"] + [line(r) for r in rows])


def main_table(m):
    rows = []
    for n in m.sizes():
        for model in MODELS:
            for order in ORDERS:
                one, two = (m.ns("faba", model=model, agents=n, order=order, threads=t) for t in (1, 2))
                numpy, octave = (m.ns(k, model=model, agents=n, order=order) for k in ("numpy", "octave"))
                naive = m.ns("sequential", agents=n) if model == "basic" and order != "none" else None
                thesis = m.ns("thesis", agents=n) if model == "basic" and order != "none" else None
                rows.append([f"{n:.0e}".replace("e+0", "e"), model, "yes" if order != "none" else "no", number(one), number(two),
                             times(ratio(one, two)), times(ratio(one, m.limit(model, n))), number(numpy),
                             times(ratio(numpy, one)), number(octave), times(ratio(octave, one)), number(naive),
                             times(ratio(naive, one)), number(thesis), times(ratio(thesis, one))])
    return table(["agents", "model", "excl.", "1 thread", "2 threads", "speedup", "of limit", "NumPy", "ratio", "Octave",
                  "ratio", "C++ seq.", "ratio", "objects", "ratio"], rows)


def published_table(m):
    rows = []
    for n in m.sizes():
        ours, naive = m.ns("faba", model="basic", agents=n, order="published"), m.ns("sequential", agents=n)
        rows.append([f"{n:.0e}".replace("e+0", "e"), number(ours), number(naive), times(ratio(naive, ours))])
    return table(["agents", "faba", "C++ seq.", "ratio"], rows)


def limit_table(m):
    rows = []
    for n in m.sizes():
        for t in (1, 2):
            ns = {w: m.ns("limit", what=w, model="dipole", agents=n, threads=t)
                  for w in ("philox", "sincos", "log", "traffic", "triad")}
            rows.append([f"{n:.0e}".replace("e+0", "e"), str(t)] + [number(1e3 / ns[w]) for w in ("philox", "sincos", "log")] +
                        [number(36 / ns["traffic"]), number(12 / ns["triad"]), number(m.limit("dipole", n, t))])
    return table(["agents", "threads", "Philox M/s", "sincos M/s", "log M/s", "36-byte GB/s", "triad GB/s", "sum, ns"], rows)


def memory_table(m):
    rows = []
    for model in MODELS:
        case = [r for r in m.rows if r["kind"] == "faba" and r["model"] == model and r["agents"] == max(m.sizes())]
        rows.append([model] + [number(next(r["bytes_per_agent"] for r in case if r["order"] == o)) for o in ORDERS])
    return table(["model", "without exclusion", "with exclusion"], rows)


def verdicts(m):
    """(goal, measured value, met) for every goal; met is None if it was not measured."""
    out = []

    def goal(text, value, good, figure):
        out.append((text, "not measured" if value is None else figure.format(value), None if value is None else good(value)))

    def faba(model, order, threads=1, agents=GOAL):
        return m.ns("faba", model=model, order=order, threads=threads, agents=agents)

    dipole, basic = faba("dipole", "none"), faba("basic", "two-phase")
    goal("dipole: time at most 3x the limit of the machine", ratio(dipole, m.limit("dipole", GOAL)), lambda v: v <= 3, "{:.2f}x")
    goal("dipole: at least 4x as fast as NumPy", ratio(m.ns("numpy", model="dipole", order="none", agents=GOAL), dipole),
         lambda v: v >= 4, "{:.2f}x")
    goal("basic with exclusion: at least as fast as sequential C++", ratio(m.ns("sequential", agents=GOAL), basic),
         lambda v: v >= 1, "{:.2f}x")
    goal("basic with exclusion: at least 10 000x as fast as the design of the thesis (1e4 agents)",
         ratio(m.ns("thesis", agents=10000), faba("basic", "two-phase", agents=10000)), lambda v: v >= 10000, "{:.0f}x")
    for model in MODELS:
        for order in ORDERS:
            goal(f"{model} {'with' if order != 'none' else 'without'} exclusion: 2 threads at least 1.8x as fast as 1",
                 ratio(faba(model, order), faba(model, order, 2)), lambda v: v >= 1.8, "{:.2f}x")
    largest = [r["bytes_per_agent"] for r in m.rows if r["kind"] == "faba" and r["agents"] == max(m.sizes())]
    goal("at most 64 bytes of state per agent", max(largest), lambda v: v <= 64, "{:.0f} bytes")
    return out


def verdict_table(all):
    word = {True: "met", False: "NOT MET", None: "-"}
    return table(["goal (1e5 agents and 1 thread by default)", "measured", ""], [[t, f, word[ok]] for t, f, ok in all])


def report(m, about):
    scaling = [ratio(m.ns("limit", what=w, model="dipole", agents=GOAL, threads=1),
                     m.ns("limit", what=w, model="dipole", agents=GOAL, threads=2)) for w in ("philox", "sincos", "log")]
    lines = [
        "# Speed of the simulation", "",
        f"{about['date']}{', quick run' if about['quick'] else ''}. {about['processor']}, {about['vector_unit']}; "
        f"faba {about['faba']}, {about['compiler']}, NumPy {about['numpy']}, {about['octave']}. "
        f"Load before the run {about['load_before']:.2f}. Speedup of loops without shared data with a second thread on this machine: "
        f"{min(scaling):.2f}-{max(scaling):.2f}x.", "",
        "Times are medians in ns per agent-step. Compare only times of the same run. Every program checks its results"
        + (":" if m.failed else "; all are correct."), *[f"- WRONG: {f}" for f in m.failed], "",
        "## Goals", "", verdict_table(verdicts(m)), "",
        "## Models", "",
        "A box with one cell per ten pixels; `basic` and `adapted` as published, `dipole` in 0.5 mT with 5 ms steps. "
        "`of limit`: time with one thread divided by the time of the random numbers, elementary functions and 36 bytes of memory "
        "traffic of a step. `C++ seq.` and `objects` use the sequential rule of the thesis; `objects` has one Octave object per "
        "bacterium. `ratio`: time of the program in the column before, divided by the time of faba with one thread.",
        "", main_table(m), "",
        "## Order of the thesis (`exclusion.order = \"published\"`), `basic`, one thread", "", published_table(m), "",
        "## Limits of the machine", "",
        "Million Philox blocks, sine-cosine pairs and logarithms per second, and GB/s of the 36-byte pattern and of the triad "
        "with the memory size of the agents.", "", limit_table(m), "",
        "## Memory: bytes per agent, without the occupancy grid", "", memory_table(m), ""]
    return "\n".join(lines)


def main():
    options = arguments()
    load = os.getloadavg()[0]
    print("Measuring; other programs on this machine affect the results.", file=sys.stderr)
    m = measure(options)
    about = provenance(m, options, load)
    text = report(m, about)
    print(text)
    options.out.mkdir(parents=True, exist_ok=True)
    name = options.out / ("agents-quick" if options.quick else "agents")
    name.with_suffix(".md").write_text(text)
    goals = [{"goal": t, "measured": f, "met": ok} for t, f, ok in verdicts(m)]
    name.with_suffix(".json").write_text(
        json.dumps({"about": about, "goals": goals, "scene": m.scene, "rows": m.rows}, indent=1) + "\n")
    return 1 if m.failed else 0


if __name__ == "__main__":
    sys.exit(main())
