#!/usr/bin/python3
"""Measures what a user waits for: every verb as a complete process, beside its unavoidable work (the simulation alone, decoding alone,
encoding alone, the kernel alone) in the same run, with one and two threads, and its peak memory. Checks that results do not depend on the
number of threads and that recording does not change the state hash. Prints a table and writes it to bench/results/jobs.md.

    bench/jobs.py [--program build/faba] [--before OTHER/faba] [--video FILE] [--only tracks,video,...] [--rounds 3]

--before: the program of an earlier commit, which is measured in turn with this one. --video: a real video for the measurements; by default
one that the program renders. Needs ffmpeg and h5repack (tools/setup.sh bench). Exit status 1 if a result is wrong; slow results do not fail.
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

import h5py

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent
ENCODER = ["-c:v", "libx264", "-preset", "veryfast", "-tune", "zerolatency", "-crf", "20", "-threads", "1", "-x264-params",
           "cpu-independent=1:partitions=none:weightp=0"]  # of the videos of runs
CELLS = (1000, 10000, 30000, 100000)
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

    def best(self, *commands):
        """The fastest of several rounds of each command, measured in turn."""
        best = [None] * len(commands)
        for _ in range(self.o.rounds):
            for i, command in enumerate(commands):
                job = Job(command, self.folder)
                if best[i] is None or job.s < best[i].s:
                    best[i] = job
        return best

    def together(self, command):
        """Wall time of two processes at a time."""
        folders = [self.folder / "one", self.folder / "two"]
        times = []
        for _ in range(self.o.rounds):
            started = time.monotonic()
            running = []
            for f in folders:
                f.mkdir(exist_ok=True)
                running.append(subprocess.Popen([str(x) for x in command], cwd=f, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL))
            for p in running:
                if p.wait():
                    sys.exit(f"jobs.py: {' '.join(map(str, command))} failed")
            times.append(time.monotonic() - started)
        return min(times)

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
    b.add("", "## Runs with video and tracks", "", "Encoding alone: ffmpeg with the same encoder settings and one thread, from the decoded frames of the video.", "",
          "| scene | run, s | encoding alone, s | ratio | goal | earlier commit, s | fraction of it | goal | video, MB (earlier) |",
          "|---|---|---|---|---|---|---|---|---|")
    for name in ("steer", "null-route", "thesis-basic", "as-seen"):
        scene = ROOT / f"scenes/{name}.toml"
        Job(b.run(scene, out="new"), b.folder)
        raw, encoded = b.folder / "frames.y4m", b.folder / "encoded.mp4"
        Job(["ffmpeg", "-v", "error", "-y", "-i", b.folder / "new/video.mp4", "-strict", "-1", raw], b.folder)
        commands = [b.run(scene, out="new"), ["ffmpeg", "-v", "error", "-y", "-i", raw, *ENCODER, encoded]]
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
        if process.wait() == 0:
            continue  # it had ended before
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


def measurements(b):
    film = b.o.video.resolve() if b.o.video else None
    if not film:
        Job(b.run(ROOT / "scenes/as-seen.toml", "--set", "record.lossless=false", out="film"), b.folder)
        film = b.folder / "film/video.mp4"
    Job(b.run(ROOT / "scenes/as-seen.toml", "--duration", "3 s", out="seen"), b.folder)
    Job(b.run(ROOT / "scenes/as-seen.toml", "--duration", "3 s", out="other", seed=2), b.folder)
    b.add("", "## Measurements", "", f"Video: {film.name}. Two processes: the speed-up that two independent processes with one thread each reach.", "",
          "| verb | one thread, s | two threads, s | speed-up | two processes | fraction of it | goal | peak, MiB | earlier commit, one thread, s | all threads, s |",
          "|---|---|---|---|---|---|---|---|---|---|")
    verbs = {
        "activity": (["activity", film, "--json", "--force", "--out", "a.csv"], ["a.csv"]),
        "track": (["track", film, "--json", "--force", "--out", "t.csv"], ["t.csv"]),
        "flow": (["flow", film, "--json", "--force", "--out", "f.h5"], ["f.h5"]),
        "compare": (["compare", b.folder / "seen", b.folder / "other", "--no-floor", "--json", "--force", "--out", "c.csv"], ["c.csv"]),
    }
    for name, (arguments, files) in verbs.items():
        commands = [b.faba(*arguments, "--threads", "1"), b.faba(*arguments, "--threads", "2")]
        if b.o.before:
            commands += [["taskset", "-c", "0", b.o.before, *arguments], b.faba(*arguments, program=b.o.before)]
        jobs = b.best(*commands)
        hashes = {output_hash(b, Job(b.faba(*arguments, "--threads", str(n)), b.folder), files) for n in (1, 2, 3)}
        b.check(len(hashes) == 1, f"{name} depends on the number of threads")
        speed_up, possible = jobs[0].s / jobs[1].s, 2 * jobs[0].s / b.together(commands[0])
        share = speed_up / possible
        row = f"| {name} | {jobs[0].s:.2f} | {jobs[1].s:.2f} | {speed_up:.2f} | {possible:.2f} | {100 * share:.0f} % | 90 %, {'met' if share >= 0.9 else 'NOT MET'} | {jobs[1].mib:.0f} |"
        row += f" {jobs[2].s:.2f} ({100 * jobs[0].s / jobs[2].s:.0f} %) | {jobs[3].s:.2f} ({100 * jobs[1].s / jobs[3].s:.0f} %) |" if b.o.before else " | |"
        b.add(row)
    bound(b, film)


def bound(b, film):
    """Activity against one decoding and its sweeps alone, and the price of a part of the video."""
    activity = ["activity", film, "--json"]
    entire = json.loads(Job(b.faba(*activity), b.folder).out)["videos"][0]
    with_size = json.loads(Job(b.faba("flow", film, "--json"), b.folder).out)
    width, height = with_size["image_size"]
    part_s = entire["frame_s"] * entire["pairs"] * 10 / 76  # 10 s of the video of 76 s in ../shared/data
    jobs = b.best(b.faba(*activity, "--threads", "2"), ["ffmpeg", "-v", "error", "-threads", "2", "-i", film, "-f", "null", "-"],
                  [b.o.sweeps, width, height, entire["pairs"], 2], b.faba(*activity, "--threads", "2", "--to", f"{part_s:.4g} s"))
    unavoidable = jobs[1].s + float(jobs[2].out)
    ratio, part = jobs[0].s / unavoidable, jobs[3].s / jobs[0].s
    b.add("", f"`activity` on two threads takes {jobs[0].s:.2f} s; one decoding and the sweeps of its {entire['pairs']} pairs alone, on two threads, take "
          f"{jobs[1].s:.2f} s + {float(jobs[2].out):.2f} s: ratio {ratio:.2f} (goal: 1.3, {'met' if ratio <= 1.3 else 'NOT MET'}). With `--to` at 13 % of the video it "
          f"takes {100 * part:.0f} % of the time (goal: 20 %, {'met' if part <= 0.2 else 'NOT MET'}).")


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
    commands = [b.faba("--version"), b.run(ROOT / "scenes/thesis-basic.toml", "--duration", "66.7 ms", out="single")]
    rounds, b.o.rounds = b.o.rounds, 15
    jobs = b.best(*commands)
    b.o.rounds = rounds
    b.add("", "## Start", "", f"`faba --version` takes {1e3 * jobs[0].s:.0f} ms (goal: 20, {'met' if jobs[0].s <= 0.02 else 'NOT MET'}), a run of one frame "
          f"{1e3 * jobs[1].s:.0f} ms (goal: 50, {'met' if jobs[1].s <= 0.05 else 'NOT MET'}).")


SECTIONS = {"tracks": tracks, "kill": kill, "video": video, "measurements": measurements, "memory": memory, "million": million, "start": start}


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("--program", type=pathlib.Path, default=ROOT / "build/faba", help="the program, default build/faba")
    a.add_argument("--sweeps", type=pathlib.Path, default=ROOT / "build/bench/bench_jobs", help="default build/bench/bench_jobs")
    a.add_argument("--before", type=pathlib.Path, help="the program of an earlier commit")
    a.add_argument("--video", type=pathlib.Path, help="a video for the measurements; default: rendered")
    a.add_argument("--only", default=",".join(SECTIONS), help=f"sections, default {','.join(SECTIONS)}")
    a.add_argument("--rounds", type=int, default=3, help="rounds of each measurement; the fastest counts; default 3")
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
        b.add("# What a user waits for", "", f"{datetime.date.today()}, {os.cpu_count()} processors. Complete processes, the fastest of {o.rounds} rounds in turn. "
              "Generated by `bench/jobs.py`.")
        for section in o.only.split(","):
            SECTIONS[section](b)
    o.out.mkdir(parents=True, exist_ok=True)
    (o.out / "jobs.md").write_text("\n".join(b.lines) + "\n")
    return 1 if wrong else 0


sys.exit(main())
