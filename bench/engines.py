#!/usr/bin/python3
"""Measures what an engine adds to the computing time of a study: 2000 trials of 50 ms with two local workers, GNU parallel, Dask, and a Slurm
cluster of three nodes on this machine; and planning and collecting of a million trivial tasks, extrapolated to ten millions. Checks that all
results have the bytes of a study without an engine. Prints a table and writes it to bench/results/engines.md.

    bench/engines.py [--program build/faba] [--tasks 2000] [--trivial 1000000] [--only NAME,...]

Engines whose packages are missing are skipped, visibly. Exit status 1 if a result differs.
"""

import argparse
import datetime
import json
import os
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "tests/e2e"))
import slurm_cluster

TASK_S, CELLS = 0.05, 400
SCENE = """duration = "{duration:.4f} s"
[controller]
type = "proportional"
[reference]
type = "hold"
setpoint_px = [320, 240]
[arena]
type = "box"
size_px = [640, 480]
[[swarm]]
count = {count}
model = {{ type = "basic", max_speed = 4 }}
start = {{ type = "edge", direction = "180 deg" }}
"""
STUDY = """scene = "scene.toml"
seeds = {seeds}
delays = {delays}
[[controller]]
type = "fuzzy"
[[controller]]
type = "proportional"
"""
OUTPUTS = ("controllers.json", "controllers.csv", "report.html")


class Job:
    """A process that has ended: duration, peak memory of the process, output."""

    def __init__(self, words, folder, codes=(0,)):
        begin = time.monotonic()
        with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
            process = subprocess.Popen([str(w) for w in words], cwd=folder, stdout=out, stderr=err)
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            self.s, self.mb = time.monotonic() - begin, usage.ru_maxrss * 1024 / 1e6
            out.seek(0)
            err.seek(0)
            self.out = out.read().decode()
            if process.returncode not in codes:
                sys.exit(f"engines.py: {' '.join(map(str, words))}: exit code {process.returncode}: {err.read().decode()}")


def task_times(folder):
    """Sum of the computing times of all tasks in result files, s, and their number."""
    total, number = 0.0, 0
    for file in folder.glob("*.results"):
        data = file.read_bytes()
        at = 64
        while at < len(data):
            size, = struct.unpack_from("<I", data, at + 4)
            total += struct.unpack_from("<f", data, at + 24)[0]
            number += 1
            at += 8 + size
    return total, number


class Bench:
    def __init__(self, o, folder):
        self.o, self.folder, self.lines, self.wrong = o, folder, [], []

    def add(self, *lines):
        self.lines += lines
        print("\n".join(lines), flush=True)

    def faba(self, *words, codes=(0,)):
        return Job([self.o.program, *words], self.folder, codes)

    def write(self, duration, count, seeds, delays):
        (self.folder / "scene.toml").write_text(SCENE.format(duration=duration, count=count))
        (self.folder / "study.toml").write_text(STUDY.format(seeds=seeds, delays=delays))

    def check(self, out, what):
        if any((self.folder / out / n).read_bytes() != (self.folder / "one" / n).read_bytes() for n in OUTPUTS):
            self.wrong.append(what)
            self.add("", f"WRONG: {what}: the files differ from those of a study without an engine.")


def with_length(b):
    """Writes a study whose trials take TASK_S, and returns the duration of a trial."""
    duration = 20.0
    for _ in range(2):
        b.write(duration, CELLS, 25, [0, 2])
        b.faba("compare-controllers", "study.toml", "--quiet", "--force", "--threads", "2", "--out", "length")
        total, number = task_times(b.folder / "length/results")
        duration *= TASK_S / (total / number)
        shutil.rmtree(b.folder / "length")
    b.write(duration, CELLS, b.o.tasks // 4, [0, 2])
    return duration


def reference(b, out):
    """Runs the study without an engine on all processors; returns the sum of the computing times of its tasks, and its duration, s."""
    shutil.rmtree(b.folder / out, ignore_errors=True)
    job = b.faba("compare-controllers", "study.toml", "--quiet", "--threads", str(os.cpu_count()), "--out", out)
    return task_times(b.folder / out / "results")[0], job.s


def engines(b):
    cores, length = os.cpu_count(), with_length(b)
    before, duration = reference(b, "one")
    b.add("", f"## {b.o.tasks} tasks of {1e3 * before / b.o.tasks:.0f} ms", "",
          f"`compare-controllers`, trials of {length:.1f} s with {CELLS} cells. Work: the sum of the computing times of the tasks without an engine on {cores} threads ({duration:.1f} s at "
          "first), as the mean of a run before and a run after that on the engine, because the speed of a shared machine changes. Ideal: work divided by min(workers, processors). "
          "Busy: the fraction of the time of the workers in which they computed tasks; the rest is their start, and gaps between jobs. Three workers share two processors: "
          "two busy workers are enough for the ideal.",
          "", "| engine | workers | work before, after, s | ideal, s | duration, s | longer by | goal | busy | attempts |", "|---|---|---|---|---|---|---|---|---|")
    for name, workers, goal in (("local", 2, 10), ("parallel", 2, None), ("dask", 2, None), ("slurm", 3, 25)):
        if name not in b.o.engines.split(","):
            continue
        why = slurm_cluster.missing() if name == "slurm" else slurm_cluster.missing_package(name)
        if why:
            b.add(f"| {name} | {workers} | | | SKIPPED: {why} | | | | |")
            continue
        cluster = slurm_cluster.Cluster(b.folder / "slurm") if name == "slurm" else None
        try:
            job = b.faba("compare-controllers", "study.toml", "--quiet", "--engine", name, "--workers", str(workers), "--out", f"on-{name}")
        finally:
            if cluster:
                cluster.stop()
        b.check(f"on-{name}", name)
        after = reference(b, "again")[0]
        attempts = (b.folder / f"on-{name}/attempts.csv").read_text().count(",submitted,")
        ideal = (before + after) / 2 / min(workers, cores)
        over = 100 * (job.s / ideal - 1)
        busy = task_times(b.folder / f"on-{name}/results")[0] / workers / job.s
        b.add(f"| {name} | {workers} | {before:.1f}, {after:.1f} | {ideal:.1f} | {job.s:.1f} | {over:.0f} % | {'' if goal is None else f'{goal} %, ' + ('met' if over <= goal else 'NOT MET')} | {100 * busy:.0f} % | {attempts} |")
        before = after


def trivial(b):
    """Tasks that take almost no time: trials of one frame with one cell."""
    b.add("", "## Trivial tasks", "", "Trials of one frame with one cell. `plan` and `collect` are single processes, `work` two at a time. The last row is a line through the two before it.", "",
          "| tasks | plan, s | plan, MB | work, s | result files, MB | collect, s | collect, MB | engine local, s | engine local, MB | no engine, s |",
          "|---|---|---|---|---|---|---|---|---|---|")
    rows = []
    for tasks in (b.o.trivial // 10, b.o.trivial):
        for out in ("one", "parts", "local"):
            shutil.rmtree(b.folder / out, ignore_errors=True)
        b.write(0.04, 1, tasks // 20, list(range(10)))
        one = b.faba("compare-controllers", "study.toml", "--quiet", "--out", "one")
        plan = b.faba("study", "plan", "study.toml", "--out", "parts", "--json")
        planned = json.loads(plan.out)["tasks"]
        assert planned == f"1-{tasks}", planned
        begin = time.monotonic()
        workers = [subprocess.Popen([b.o.program, "study", "work", "parts", "--quiet", "--tasks", part, "--results", f"parts/results/{k}.results"], cwd=b.folder)
                   for k, part in enumerate((f"1-{tasks // 2}", f"{tasks // 2 + 1}-{tasks}"))]
        if any(w.wait() for w in workers):
            sys.exit("engines.py: a worker failed")
        worked = time.monotonic() - begin
        size = sum(f.stat().st_size for f in (b.folder / "parts/results").iterdir()) / 1e6
        collect = b.faba("study", "collect", "parts", "--quiet")
        b.check("parts", f"{tasks} trivial tasks")
        local = b.faba("compare-controllers", "study.toml", "--quiet", "--engine", "local", "--workers", "2", "--out", "local")
        b.check("local", f"{tasks} trivial tasks with --engine local")
        rows.append((plan.s, plan.mb, worked, size, collect.s, collect.mb, local.s, local.mb, one.s))
        b.add(f"| {tasks} | " + " | ".join(f"{v:.3g}" for v in rows[-1]) + " |")
    line = [large + 10 * (large - small) for small, large in zip(*rows)]
    b.add(f"| {10 * b.o.trivial} (extrapolated) | " + " | ".join(f"{v:.3g}" for v in line) + " |", "")
    seconds, memory = rows[-1][0] + rows[-1][4], max(rows[-1][1], rows[-1][5])
    b.add(f"{b.o.trivial} tasks are planned and collected in {seconds:.1f} s (goal: 60, {'met' if seconds < 60 else 'NOT MET'}) and {memory:.0f} MB "
          f"(goal: 500, {'met' if memory < 500 else 'NOT MET'}).")


SECTIONS = {"engines": engines, "trivial": trivial}


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("--program", type=pathlib.Path, default=HERE.parent / "build/faba", help="the program, default build/faba")
    a.add_argument("--tasks", type=int, default=2000, help="tasks of 50 ms, default 2000")
    a.add_argument("--trivial", type=int, default=1000000, help="trivial tasks, default 1000000")
    a.add_argument("--engines", default="local,parallel,dask,slurm", help="default local,parallel,dask,slurm")
    a.add_argument("--only", default=",".join(SECTIONS), help=f"sections, default {','.join(SECTIONS)}")
    a.add_argument("--out", type=pathlib.Path, default=HERE / "results", help="folder of the results, default bench/results")
    o = a.parse_args()
    o.program = o.program.resolve()
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as name:
        b = Bench(o, pathlib.Path(name))
        b.add("# Overhead of engines", "", f"{datetime.date.today()}, {os.cpu_count()} processors. Generated by `bench/engines.py`.")
        for section in o.only.split(","):
            SECTIONS[section](b)
    o.out.mkdir(parents=True, exist_ok=True)
    (o.out / "engines.md").write_text("\n".join(b.lines) + "\n")
    return 1 if b.wrong else 0


sys.exit(main())
