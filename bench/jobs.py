#!/usr/bin/python3
"""Measures what a user waits for: every verb as a complete process, beside its unavoidable work (the simulation alone, decoding alone,
encoding alone, the kernel alone) in the same run, with one and two threads, and its peak memory. Checks that results do not depend on the
number of threads and that recording does not change the state hash. Prints a table and writes it to bench/results/jobs.md.

    bench/jobs.py [--program build/faba] [--before OTHER/faba] [--video FILE] [--only tracks,video,...] [--rounds 3]

--before: the program of an earlier commit, which is measured in turn with this one; its benchmarks, in the folder bench beside it, are used
for the kernels. --video: a real video of 2048 x 1080 px, for activity and track; default: ../shared/data. Needs ffmpeg and h5repack (tools/setup.sh bench). Exit status 1 if a result is wrong; slow results do not fail.
"""

import argparse
import datetime
import hashlib
import json
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import time
import types

import h5py

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent
ENCODER = ["-c:v", "libx264", "-preset", "veryfast", "-tune", "zerolatency", "-crf", "20", "-threads", "1", "-x264-params",
           "cpu-independent=1:partitions=none:weightp=0"]  # of the videos of runs at commit 3619ebf
CELLS = (1000, 10000, 30000, 100000)
SHORT_ROUNDS, SHORT_S = 15, 60  # rounds of commands that take less than this together, s
wrong = []


class Job:
    """A finished process: wall time, processor time, peak memory, standard output."""

    def __init__(self, command, cwd):
        started = time.monotonic()
        with open(cwd / "out", "wb") as out, open(cwd / "err", "wb") as err:
            process = subprocess.Popen([str(x) for x in command], cwd=cwd, stdout=out, stderr=err)
            _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        self.s, self.cpu_s, self.mib = time.monotonic() - started, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024
        self.out = (cwd / "out").read_text()
        if process.returncode:
            sys.exit(f"jobs.py: {' '.join(map(str, command))}: {(cwd / 'err').read_text()}")


class Bench:
    def __init__(self, o, folder):
        self.o, self.folder, self.lines = o, folder, []

    def rounds(self):
        """At least o.rounds; more of short commands, because the speed of a machine changes within seconds."""
        started = time.monotonic()
        for k in range(max(SHORT_ROUNDS, self.o.rounds)):
            if k >= self.o.rounds and time.monotonic() - started > SHORT_S:
                return
            yield k

    def best(self, *works):
        """The fastest of several rounds of each, measured in turn: a command, or a function that measures one round."""
        best = [None] * len(works)
        for _ in self.rounds():
            for i, work in enumerate(works):
                job = work() if callable(work) else Job(work, self.folder)
                if best[i] is None or job.s < best[i].s:
                    best[i] = job
        return best

    def together(self, command):
        """Measures two processes at a time."""
        folders = [self.folder / "one", self.folder / "two"]
        for f in folders:
            f.mkdir(exist_ok=True)
        started = time.monotonic()
        running = [subprocess.Popen([str(x) for x in command], cwd=f, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) for f in folders]
        for p in running:
            if p.wait():
                sys.exit(f"jobs.py: {' '.join(map(str, command))} failed")
        return types.SimpleNamespace(s=time.monotonic() - started)

    def faba(self, *arguments, program=None):
        return [program or self.o.program, *arguments]

    def run(self, scene, *arguments, out="run", program=None, seed=1):
        return self.faba("run", scene, "--seed", seed, "--force", "--quiet", "--out", out, *arguments, program=program)

    def add(self, *lines):
        self.lines += lines
        print("\n".join(lines), flush=True)

    def check(self, right, what):
        if not right:
            wrong.append(what)
            self.add(f"\n**WRONG: {what}**\n")


def state_hash(folder):
    return json.loads((folder / "manifest.json").read_text())["state_hash"]


def tracks(b):
    b.add("", "## Recording of tracks", "", "`thesis-basic`, 90 frames, without exclusion (100 000 cells do not fit into the box otherwise), no video.", "",
          "| cells | run without tracks, s | with tracks, s | ratio | goal | file, MB | times its data in HDF5 | h5repack, MB | peak, MiB |",
          "|---|---|---|---|---|---|---|---|---|")
    for n in CELLS:
        common = ["--duration", "6 s", "--set", f"swarm[0].count={n}", "--set", "exclusion.order=none", "--set", "record.video=false"]
        scene = ROOT / "scenes/thesis-basic.toml"
        bare, with_tracks = b.best(b.run(scene, *common, "--set", "record.tracks=false", out="bare"), b.run(scene, *common, out="tracks"))
        b.check(state_hash(b.folder / "bare") == state_hash(b.folder / "tracks"), f"tracks of {n} cells change the state hash")
        file = b.folder / "tracks/tracks.h5"
        with h5py.File(file) as f:
            stored = sum(d.id.get_storage_size() for d in f.values())
            b.check(f["position_px"].shape == (90, n, 2), f"tracks of {n} cells have the shape {f['position_px'].shape}")
        repacked = b.folder / "repacked.h5"
        Job(["h5repack", "-f", "SHUF", "-f", "GZIP=1", file, repacked], b.folder)
        size, other = file.stat().st_size, repacked.stat().st_size
        ratio = with_tracks.s / bare.s
        b.add(f"| {n} | {bare.s:.2f} | {with_tracks.s:.2f} | {ratio:.2f} | 3, {'met' if ratio <= 3 else 'NOT MET'} | {size / 1e6:.2f} | "
              f"{size / stored:.3f} | {other / 1e6:.2f} | {with_tracks.mib:.0f} |")


def video(b):
    b.add("", "## Runs with video and tracks", "", "Encoding alone: ffmpeg with the encoder settings of commit 3619ebf and one thread, from the decoded frames of the video. `as-seen` also "
          "writes a lossless video, which is encoded alone, too.", "",
          "| scene | run, s | encoding alone, s | ratio | goal | earlier commit, s | fraction of it | goal | video, MB (earlier) |",
          "|---|---|---|---|---|---|---|---|---|")
    for name in ("steer", "null-route", "thesis-basic", "as-seen"):
        scene = ROOT / f"scenes/{name}.toml"
        Job(b.run(scene, out="new"), b.folder)
        raw, encoded = b.folder / "frames.y4m", b.folder / "encoded.mp4"
        Job(["ffmpeg", "-v", "error", "-y", "-i", b.folder / "new/video.mp4", "-strict", "-1", raw], b.folder)
        lossless = ["-c:v", "png", "-pix_fmt", "gray", "-pred", "none", "-compression_level", "1", "-threads", "1", b.folder / "encoded.avi"]
        commands = [b.run(scene, out="new"), ["ffmpeg", "-v", "error", "-y", "-i", raw, *ENCODER, encoded, *(lossless if name == "as-seen" else [])]]
        if b.o.before:
            commands.append(b.run(scene, out="old", program=b.o.before))
        jobs = b.best(*commands)
        raw.unlink()
        ratio = jobs[0].s / jobs[1].s
        row = f"| {name} | {jobs[0].s:.2f} | {jobs[1].s:.2f} | {ratio:.2f} | 1.4, {'met' if ratio <= 1.4 else 'NOT MET'} | "
        size = (b.folder / "new/video.mp4").stat().st_size / 1e6
        if b.o.before:
            share, old = jobs[0].s / jobs[2].s, (b.folder / "old/video.mp4").stat().st_size / 1e6
            row += f"{jobs[2].s:.2f} | {100 * share:.0f} % | 45 %, {'met' if share <= 0.45 else 'NOT MET'} | {size:.2f} ({old:.2f}) |"
        else:
            row += f"| | | {size:.2f} |"
        b.add(row)


def kill(b):
    """Kills a recording run at random moments: its file must open at once, and the resumed run must be the same."""
    scene = ROOT / "scenes/thesis-basic.toml"
    settings = ["--set", "swarm[0].count=20000", "--set", "exclusion.order=none", "--set", "record.video=false", "--set", "record.checkpoint=0.2 s"]
    complete = Job(b.run(scene, *settings, out="complete"), b.folder)
    expected, rows, moments = state_hash(b.folder / "complete"), [], random.Random(1)
    while len(rows) < 20:
        out = b.folder / "killed"
        process = subprocess.Popen([str(x) for x in b.run(scene, *settings, out=out)], cwd=b.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while not (out / "tracks.h5").exists():
            time.sleep(0.001)
        time.sleep(complete.s * moments.uniform(0, 0.8))
        process.kill()
        manifest = out / "manifest.json"
        if process.wait() == 0 or (manifest.exists() and json.loads(manifest.read_text()).get("complete")):
            continue  # nothing was left to do
        with h5py.File(out / "tracks.h5", "r", swmr=True) as f:
            rows.append(len(f["position_px"]))
            b.check(rows[-1] == 0 or f["position_px"][rows[-1] - 1].shape == (20000, 2), "the last row of a killed run cannot be read")
        Job(b.faba("resume", out), b.folder)
        b.check(state_hash(out) == expected, "a killed and resumed run has another state hash")
        with h5py.File(out / "tracks.h5") as f, h5py.File(b.folder / "complete/tracks.h5") as g:
            b.check(len(f["position_px"]) == len(g["position_px"]) and bool((f["position_px"][-1] == g["position_px"][-1]).all()),
                    "a killed and resumed run has other tracks")
        shutil.rmtree(out)
    b.add("", "## Killed runs", "", f"A run of {complete.s:.1f} s was killed at 20 random moments: its file opened at once with `swmr=True` and had {min(rows)} to {max(rows)} of "
          "400 frames; resumed, all had the same state hash and the same tracks.")


def output_hash(b, job, files):
    digest = hashlib.sha256(job.out.encode())
    for f in files:
        # In pieces: the peak memory of a process that this one starts is at least that of this one.
        with open(b.folder / f, "rb") as file:
            while piece := file.read(1 << 20):
                digest.update(piece)
    return digest.hexdigest()


IDENTIFY = """boundary = "drop"
field_strength = "1 mT"
simulations = 100
[[video]]
file = "seen"
[[model]]
type = "dipole"
free = { "swarm[0].model.speed" = ["100 um/s", "300 um/s"] }
"""


def measurements(b):
    Job(b.run(ROOT / "scenes/as-seen.toml", "--set", "record.lossless=false", out="film"), b.folder)
    film = b.folder / "film/video.mp4"
    Job(b.run(ROOT / "scenes/as-seen.toml", "--duration", "3 s", out="seen"), b.folder)
    Job(b.run(ROOT / "scenes/as-seen.toml", "--duration", "3 s", out="other", seed=2), b.folder)
    b.add("", "## Measurements", "", "`as-seen`, its video of 90 frames. Two processes: the speed-up that two independent processes with one thread each reach.", "",
          "| verb | one thread, s | two threads, s | speed-up | two processes | fraction of it | goal | peak, MiB |", "|---|---|---|---|---|---|---|---|")
    (b.folder / "study.toml").write_text(IDENTIFY)
    verbs = {
        "activity": (["activity", film, "--json", "--force", "--out", "a.csv"], ["a.csv"]),
        "track": (["track", film, "--json", "--force", "--out", "t.csv"], ["t.csv"]),
        "flow": (["flow", film, "--json", "--force", "--out", "f.h5"], ["f.h5"]),
        "compare": (["compare", b.folder / "seen", b.folder / "other", "--no-floor", "--json", "--force", "--out", "c.csv"], ["c.csv"]),
        "identify": (["identify", b.folder / "study.toml", "--quiet", "--force", "--out", "study"], ["study/identify.json"]),
    }
    for name, (arguments, files) in verbs.items():
        clean = ["sh", "-c", 'rm -rf study; exec "$@"', "sh"]  # a complete study is not computed again
        commands = [clean + b.faba(*arguments, "--threads", str(n)) for n in (1, 2)]
        jobs = b.best(*commands, lambda: b.together(commands[0]))
        hashes = {output_hash(b, Job(clean + b.faba(*arguments, "--threads", str(n)), b.folder), files) for n in (1, 2, 3)}
        b.check(len(hashes) == 1, f"{name} depends on the number of threads")
        speed_up, possible = jobs[0].s / jobs[1].s, 2 * jobs[0].s / jobs[2].s
        share = speed_up / possible
        b.add(f"| {name} | {jobs[0].s:.2f} | {jobs[1].s:.2f} | {speed_up:.2f} | {possible:.2f} | {100 * share:.0f} % | 90 %, {'met' if share >= 0.9 else 'NOT MET'} | {jobs[1].mib:.0f} |")


def real(b):
    """Activity of a real video against one decoding and its sweeps alone, the price of a part of it, and tracks."""
    film = b.o.video.resolve() if b.o.video else ROOT.parent / "shared/data/step-response/rollers.mp4"
    if not film.exists():
        b.add("", "## A real video", "", f"Skipped: no file {film.name}; give --video.")
        return
    activity = ["activity", film, "--json"]
    probe = json.loads(Job(["ffprobe", "-v", "error", "-select_streams", "v", "-show_entries", "stream=width,height", "-of", "json", film], b.folder).out)["streams"][0]
    pairs, shrink = json.loads(Job(b.faba(*activity), b.folder).out)["videos"][0]["pairs"], max(1, -(-max(probe["width"], probe["height"]) // 1024))
    entire, decoding, part, sweeps = b.best(b.faba(*activity, "--threads", "2"), ["ffmpeg", "-v", "error", "-threads", "2", "-i", film, "-f", "null", "-"],
                                            b.faba(*activity, "--threads", "2", "--to", "10 s"),
                                            [b.o.sweeps, probe["width"] // shrink, probe["height"] // shrink, pairs, 2])
    unavoidable = decoding.s + float(sweeps.out)
    ratio, share = entire.s / unavoidable, part.s / entire.s
    b.add("", "## A real video", "", f"`{film.name}`, {probe['width']} x {probe['height']} px, {pairs} pairs of frames, averaged over squares of {shrink} px. `activity` on two threads takes "
          f"{entire.s:.1f} s; one decoding and the sweeps alone, on two threads, take {decoding.s:.1f} s + {float(sweeps.out):.1f} s: ratio {ratio:.2f} (goal: 1.3, "
          f"{'met' if ratio <= 1.3 else 'NOT MET'}). With `--to \"10 s\"` it takes {100 * share:.0f} % of the time (goal: 20 %, {'met' if share <= 0.2 else 'NOT MET'}).")
    track = ["track", film, "--json", "--force", "--out", "t.csv"]
    commands = [b.faba(*track, "--threads", "1"), b.faba(*track, "--threads", "2")]
    if b.o.before:
        commands.append(["taskset", "-c", "0", *b.faba(*track, program=b.o.before)])
    jobs = b.best(*commands)
    text = f"`track` takes {jobs[0].s:.1f} s on one thread and {jobs[1].s:.1f} s on two."
    if b.o.before:
        one, two = jobs[0].s / jobs[2].s, jobs[1].s / jobs[2].s
        text += (f" The earlier commit takes {jobs[2].s:.1f} s on one core: {100 * one:.0f} % (goal: 40 %, {'met' if one <= 0.4 else 'NOT MET'}) and "
                 f"{100 * two:.0f} % (goal: 20 %, {'met' if two <= 0.2 else 'NOT MET'}).")
    b.add("", text)


def kernels(b):
    """Exclusion and multigrid flow beside those of an earlier commit, in turn."""
    if not b.o.before:
        return
    rows = {}

    def put(name, kernel, value):
        rows[name, kernel] = min(value, rows.get((name, kernel), value))

    builds = {"now": b.o.program.parent, "before": b.o.before.parent}
    for name, program in [(name, program) for _ in range(b.o.rounds) for name in builds for program in ("bench_agents", "bench_video")]:
        for line in Job([builds[name] / "bench" / program], b.folder).out.splitlines():
            j = json.loads(line)
            if j.get("kind") == "faba" and j["agents"] == 1000000 and j["threads"] == 1:
                put(name, (j["model"], j["order"]), j["ns"])
            elif j.get("what") == "converged" and j["threads"] == 1:
                put(name, "multigrid", j["ms"] * 1e6)
    cost = {name: {"exclusion, published order, 1e6 cells": rows[name, ("basic", "published")] - rows[name, ("basic", "none")],
                   "exclusion, two-phase, 1e6 cells": rows[name, ("basic", "two-phase")] - rows[name, ("basic", "none")],
                   "multigrid flow, converged": rows[name, "multigrid"], "dipole step, 1e6 cells": rows[name, ("dipole", "none")]} for name in ("now", "before")}
    b.add("", "## Kernels", "", f"One thread, the fastest of {b.o.rounds} rounds in turn. Exclusion: ns per cell of a step with it, less those of a step without it.", "",
          "| kernel | earlier commit | now | times as fast | goal |", "|---|---|---|---|---|")
    for (kernel, before), goal in zip(cost["before"].items(), (2.5, 1.5, 1.35, None)):
        now = cost["now"][kernel]
        scale, unit = (1e-6, "ms per pair") if "flow" in kernel else (1, "ns per cell")
        b.add(f"| {kernel} | {scale * before:.3g} {unit} | {scale * now:.3g} {unit} | {before / now:.2f} | {'' if goal is None else f'{goal}, ' + ('met' if before / now >= goal else 'NOT MET')} |")


def memory(b):
    b.add("", "## Peak memory against length", "", "| job | short, MiB | ten times as long, MiB | ratio | goal |", "|---|---|---|---|---|")
    scene = ROOT / "scenes/as-seen.toml"
    for name, seconds in (("short", 4), ("long", 40)):
        Job(b.run(scene, "--duration", f"{seconds} s", "--set", "record.lossless=false", out=name), b.folder)
    jobs = {"run (as-seen)": [b.run(scene, "--duration", f"{s} s", out="r") for s in (4, 40)]}
    for verb in ("activity", "track", "flow"):
        jobs[verb] = [b.faba(verb, b.folder / name / "video.mp4", "--json", *(["--force", "--out", "f.h5"] if verb == "flow" else [])) for name in ("short", "long")]
    for name, (short, long) in jobs.items():
        a, c = Job(short, b.folder), Job(long, b.folder)
        b.add(f"| {name} | {a.mib:.0f} | {c.mib:.0f} | {c.mib / a.mib:.2f} | 1.1, {'met' if c.mib <= 1.1 * a.mib else 'NOT MET'} |")


def million(b):
    scene = ROOT / "scenes/million.toml"
    duration = ["--duration", "10 s"]
    bare, recorded = b.best(b.run(scene, *duration, "--set", "record.tracks=false", "--set", "record.video=false", out="bare"), b.run(scene, *duration, out="full"))
    b.check(state_hash(b.folder / "bare") == state_hash(b.folder / "full"), "recording of million changes the state hash")
    ratio = recorded.s / bare.s
    b.add("", "## A million cells", "", f"`million`, 150 frames, every tenth recorded: {recorded.s:.1f} s; without recording {bare.s:.1f} s: ratio {ratio:.2f} (goal: 1.5, "
          f"{'met' if ratio <= 1.5 else 'NOT MET'}); peak memory {recorded.mib:.0f} MiB (goal: below 1024, {'met' if recorded.mib < 1024 else 'NOT MET'}).")


def start(b):
    """The goals in ms are 40 and 63 % of the earlier commit's times on the machine on which they were set; what a start takes differs by
    machine more than anything else here."""
    def commands(program):
        return [b.faba("--version", program=program), b.run(ROOT / "scenes/thesis-basic.toml", "--duration", "66.7 ms", out="single", program=program)]
    jobs = b.best(*commands(None), *(commands(b.o.before) if b.o.before else []))
    b.add("", "## Start", "", "| command | ms | goal | earlier commit, ms | fraction of it |", "|---|---|---|---|---|")
    for i, (name, goal) in enumerate((("`faba --version`", 20), ("a run of one frame with video and tracks", 50))):
        ms = 1e3 * jobs[i].s
        before = 1e3 * jobs[i + 2].s if b.o.before else None
        earlier = f"{before:.0f} | {100 * ms / before:.0f} %" if before else "not measured | "
        b.add(f"| {name} | {ms:.0f} | {goal}, {'met' if ms <= goal else 'NOT MET'} | {earlier} |")


SECTIONS = {"tracks": tracks, "kill": kill, "video": video, "measurements": measurements, "real": real, "memory": memory, "million": million, "kernels": kernels, "start": start}


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("--program", type=pathlib.Path, default=ROOT / "build/faba", help="the program, default build/faba")
    a.add_argument("--sweeps", type=pathlib.Path, default=ROOT / "build/bench/bench_jobs", help="default build/bench/bench_jobs")
    a.add_argument("--before", type=pathlib.Path, help="the program of an earlier commit")
    a.add_argument("--video", type=pathlib.Path, help="a real video for activity and track; default: ../shared/data/step-response/rollers.mp4")
    a.add_argument("--only", default=",".join(SECTIONS), help=f"sections, default {','.join(SECTIONS)}")
    a.add_argument("--rounds", type=int, default=3, help="rounds of each measurement, of short commands up to 15; the fastest counts; default 3")
    a.add_argument("--out", type=pathlib.Path, default=HERE / "results", help="folder of the results, default bench/results")
    o = a.parse_args()
    for tool in ("ffmpeg", "h5repack"):
        if not shutil.which(tool):
            sys.exit(f"jobs.py: {tool} not found; run tools/setup.sh bench")
    o.program, o.sweeps, o.before = o.program.resolve(), o.sweeps.resolve(), o.before.resolve() if o.before else None
    for name in o.only.split(","):
        if name not in SECTIONS:
            sys.exit(f'jobs.py: --only: "{name}" is not one of {", ".join(SECTIONS)}')
    with tempfile.TemporaryDirectory() as name:
        b = Bench(o, pathlib.Path(name))
        b.add("# What a user waits for", "", f"{datetime.date.today()}, {os.cpu_count()} processors. Complete processes, the fastest of {o.rounds} rounds in turn, of short ones up to {SHORT_ROUNDS}. "
              "Generated by `bench/jobs.py`.")
        for section in o.only.split(","):
            SECTIONS[section](b)
    o.out.mkdir(parents=True, exist_ok=True)
    (o.out / "jobs.md").write_text("\n".join(b.lines) + "\n")
    return 1 if wrong else 0


sys.exit(main())
