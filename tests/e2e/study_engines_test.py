#!/usr/bin/python3
"""Studies on engines: `faba identify`, `faba calibrate` and `faba compare-controllers` by plan, work and collect, and with --engine
local, parallel, dask and slurm, give the files of one process byte by byte, and so do `faba activity` and `faba track` with several
videos. With --kills, processes of each kind are killed in the middle, twice each, and a worker of `faba calibrate` once. A task has no
process of its own: it runs in its worker, so that killing `faba study work` kills a task, and killing its parent process (of Dask, of
GNU parallel, or the slurmd of a node) what started it. Engines whose packages are missing are skipped; the exit code is then 77.

    study_engines_test.py --program build/faba [--kills] [--only NAME]..."""

import argparse
import faulthandler
import json
import math
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import dask_checks
import parallel_checks
import slurm_checks
import slurm_cluster
from engine_studies import CALIBRATION, CONTROLLERS, FILM, IDENTIFY, STEER

OUTPUTS = ("identify.json", "identify.html", "best.toml", "background.png", "calibration.json", "calibration.html", "controllers.json", "controllers.csv", "report.html")
VERB = {"identify": "identify", "calibration": "calibrate", "controllers": "compare-controllers"}  # of the studies for all engines
VIDEOS = ("film/video.avi", "film-2/video.avi", "film-3/video.avi")
TRACK = ("track", *VIDEOS, "--um-per-px", "1.2", "--out", "tracks.csv", "--report", "tracks.html", "--quiet")
TIME_LIMIT = 2400  # s, of the complete test: eight times its duration with --kills on two cores
KILLED_STUDY = 10  # s in one process: engines take about 1 s for the start or the end of a worker
ACTIVITY = ("activity", *VIDEOS, "--reversal", "0.6 s")


class Test:
    def __init__(self, program, folder):
        self.program, self.folder = str(program), pathlib.Path(folder)
        self.failures, self.skipped = [], []

    def check(self, good, what):
        print(f"  {'ok' if good else 'FAILED'}: {what}", flush=True)
        if not good:
            self.failures.append(what)

    def skip(self, what):
        print(f"  SKIPPED: {what}", flush=True)
        self.skipped.append(what)

    def faba(self, *arguments, cwd=None, timeout=None):
        return subprocess.run([self.program, *map(str, arguments)], capture_output=True, text=True, cwd=cwd or self.folder, timeout=timeout)

    def start(self, *arguments):
        return subprocess.Popen([self.program, *map(str, arguments)], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)

    def write_studies(self):
        (self.folder / "film.toml").write_text(FILM)
        (self.folder / "identify.toml").write_text(IDENTIFY)
        (self.folder / "calibration.toml").write_text(CALIBRATION)
        for k, video in enumerate(VIDEOS):
            done = self.faba("run", "film.toml", "--seed", 3 + k, "--quiet", "--out", pathlib.Path(video).parent)
            assert done.returncode == 0, done.stderr
        self.compute("identify")
        self.compute("calibration")

    def write_controllers(self, seeds, duration):
        (self.folder / "steer.toml").write_text(STEER.replace("DURATION", duration))
        (self.folder / "controllers.toml").write_text(CONTROLLERS.replace("SEEDS", str(seeds)))
        self.compute("controllers")

    def write_controllers_to_kill(self):
        """A study so long that it can be killed in the middle: its runs last longer on a fast machine. Its results keep their size."""
        duration = 100
        while True:
            begin = time.monotonic()
            self.write_controllers(400, f"{duration} s")
            seconds = time.monotonic() - begin
            if seconds >= KILLED_STUDY:
                return
            duration = math.ceil(1.2 * duration * KILLED_STUDY / seconds)

    def write_slow(self, seeds, duration):
        (self.folder / "slow-steer.toml").write_text(STEER.replace("DURATION", duration))
        (self.folder / "slow.toml").write_text(CONTROLLERS.replace("SEEDS", str(seeds)).replace("steer", "slow-steer"))

    def compute(self, study):
        """The study in one process."""
        done = self.faba(VERB.get(study, "compare-controllers"), f"{study}.toml", "--quiet", "--force", "--out", f"{study}-one")
        assert done.returncode == 0, done.stderr

    def table(self, out):
        """All tasks with their results, as CSV."""
        done = self.faba("study", "export", out, "--out", f"{out}-table.csv", "--force")
        return (self.folder / f"{out}-table.csv").read_bytes() if done.returncode == 0 else done.stderr.encode()

    def equal(self, study, out, what):
        one = f"{study}-one"
        names = [n for n in OUTPUTS if (self.folder / one / n).exists()]
        differ = [n for n in names if not (self.folder / out / n).exists()
                  or (self.folder / out / n).read_bytes() != (self.folder / one / n).read_bytes()]
        table = self.table(out)
        if table != self.table(one) or b"\n" not in table:
            differ.append("exported table")
        self.check(len(names) >= 2 and not differ, f"{what}: files equal those of one process {differ or ''}")

    # --- plan, work, collect ---------------------------------------------------------------------------------------

    def by_hand(self, study):
        out = f"{study}-hand"
        planned = json.loads(self.faba("study", "plan", f"{study}.toml", "--out", out, "--json").stdout)
        rounds = tasks = 0
        while not planned["complete"]:
            rounds += 1
            tasks += planned["open"]
            done = self.faba("study", "work", out, "--tasks", planned["tasks"], "--results", f"{out}/results/{rounds}.results", "--threads", 2)
            self.check(done.returncode == 0, f"work, round {rounds} {done.stderr}")
            collected = self.faba("study", "collect", out, "--json")
            planned = json.loads(collected.stdout)
            if collected.returncode != (0 if planned["complete"] else 10):
                self.check(False, f"exit code of collect: {collected.returncode} {collected.stderr}")
                return
        self.equal(study, out, f"plan, work, collect: {tasks} tasks in {rounds} rounds")
        self.check(len(self.table(out).splitlines()) == tasks + 1, "export: one row for each task")
        self.check(self.faba("study", "export", out, "--out", f"{study}.h5").returncode == 0, "export as HDF5")

    def refused(self):
        """Options without their engine, and names that do not exist, are refused before anything is computed."""
        for words, expected in ((("--workers", "2"), "--engine"), (("--engine", "local", "--scheduler", "tcp://x:1"), "--engine dask"),
                                (("--engine", "local", "--sshlogin", "pc2"), "--engine parallel"), (("--engine", "slurn"), "slurm"),
                                (("--engine", "local", "--engine-set", "partitio=x"), "partition"),
                                (("--engine", "local", "--engine-set", "partition=x"), "by slurm")):
            done = self.faba("compare-controllers", "controllers.toml", "--out", "refused", *words)
            self.check(done.returncode == 2 and expected in done.stderr and not (self.folder / "refused").exists(), f"refused: {done.stderr.strip()}")

    def elsewhere(self):
        """Parts computed in a copy of the folder under another path and with another spelling are used; parts of another study or
        version are refused."""
        copy = self.folder / "mounted/elsewhere"
        self.faba("study", "plan", "controllers.toml", "--out", "parts")
        shutil.copytree(self.folder, copy, ignore=shutil.ignore_patterns("mounted", "*-one", "*-hand"))
        done = self.faba("study", "work", "../elsewhere/./parts", "--tasks", "1-100", "--results", "far.results", cwd=copy)
        self.check(done.returncode == 0, f"work under another path {done.stderr}")
        left = json.loads(self.faba("study", "collect", "parts", copy / "far.results", "--json").stdout)
        total = left["open"] + 100
        self.check(left["tasks"] == f"101-{total}", f"its results are used: open tasks are {left['tasks']}")
        # The video has another path, too.
        planned = json.loads(self.faba("study", "plan", "identify.toml", "--out", "video-parts", "--json").stdout)
        done = self.faba("study", "plan", "../elsewhere/./identify.toml", "--out", "mine", cwd=copy)
        self.check(done.returncode == 0, f"plan under another path {done.stderr}")
        self.faba("study", "work", "mine", "--tasks", "1-20", "--results", "far-video.results", cwd=copy)
        left = json.loads(self.faba("study", "collect", "video-parts", copy / "far-video.results", "--json").stdout)
        self.check(left["tasks"] == f"21-{planned['open']}", f"results of a video under another path are used: open tasks are {left['tasks']}")
        # A worker does not read the video.
        (copy / "film/video.avi").unlink()
        done = self.faba("study", "work", "mine", "--tasks", "21-30", "--results", "more.results", cwd=copy)
        self.check(done.returncode == 0, f"work without the video {done.stderr}")
        other = self.folder / "other.toml"
        other.write_text((self.folder / "controllers.toml").read_text().replace("delays = [0, 2]", "delays = [1, 2]"))
        self.faba("study", "plan", other, "--out", "parts2")
        refused = self.faba("study", "collect", "parts2", copy / "far.results")
        self.check(refused.returncode == 2 and "different study" in refused.stderr, f"another study is refused: {refused.stderr.strip()}")
        self.check(not list((self.folder / "parts2/results").glob("far*")), "its file is not copied")
        planned = self.folder / "parts2/study.json"
        planned.write_text(re.sub(r'"version": "[^"]*"', '"version": "0.0.1"', planned.read_text()))
        for arguments in (("work", "parts2", "--tasks", "1", "--results", "x.results"), ("collect", "parts2")):
            refused = self.faba("study", *arguments)
            self.check(refused.returncode == 2 and "0.0.1" in refused.stderr, f"another version is refused: {refused.stderr.strip()}")

    # --- videos ------------------------------------------------------------------------------------------------------

    def activity_outputs(self, out, *options):
        done = self.faba(*ACTIVITY, "--json", "--force", "--out", f"{out}.csv", "--report", f"{out}.html", *options)
        self.check(done.returncode == 0, f"activity, {out} {done.stderr}")
        return done.stdout, (self.folder / f"{out}.csv").read_bytes(), (self.folder / f"{out}.html").read_bytes()

    def track_outputs(self, out, *options):
        done = self.faba(*TRACK, "--folder", out, *options)
        self.check(done.returncode == 0, f"track, {out} {done.stderr}")
        files = [f for f in (self.folder / out).rglob("*") if f.is_file() and (f.parent.parent.name == "videos" or f.name == "tracks.json")]
        self.check(len(files) == 3 * len(VIDEOS) + 1, f"track, {out}: {len(files)} files")
        return {str(f.relative_to(self.folder / out)): f.read_bytes() for f in files}

    def videos_in_one_process(self):
        self.activity_one, self.tracks_one = self.activity_outputs("activity-one"), self.track_outputs("tracks-one")
        single = self.faba("track", VIDEOS[1], "--um-per-px", "1.2", "--out", "single.csv", "--report", "single.html", "--json")
        self.check(self.tracks_one["videos/video-2/track.json"].decode() == single.stdout
                   and all(self.tracks_one[f"videos/video-2/tracks.{e}"] == (self.folder / f"single.{e}").read_bytes() for e in ("csv", "html")),
                   f"track: several videos give the files of each alone {single.stderr}")
        self.broken()

    def broken(self):
        """A video that cannot be read is named; the results of all others are kept, and no other is computed again."""
        (self.folder / "broken.avi").write_bytes(b"no video")
        command = ("track", VIDEOS[0], "broken.avi", VIDEOS[1], "--folder", "broken", "--quiet")
        for options in ((), ("--engine", "local")):
            done = self.faba(*command, *options)
            self.check(done.returncode in (1, 3) and "broken.avi" in done.stderr and "1 of 3" in done.stderr, f"track, a broken video: {done.stderr.strip()}")
            found = json.loads((self.folder / "broken/tracks.json").read_text())
            self.check(len(found["videos"]) == 2 and found["without_result"] == ["broken.avi"], "track, a broken video: the others are kept")
        done = self.faba("activity", VIDEOS[0], "broken.avi", VIDEOS[1], "--engine", "local", "--folder", "broken-activity", "--json")
        self.check(done.returncode == 1 and "broken.avi" in done.stderr, f"activity, a broken video: {done.stderr.strip()}")

    def engine_for_videos(self, name, *options):
        self.check(self.activity_outputs(f"activity-{name}", "--engine", name, "--folder", f"activity-{name}", *options) == self.activity_one,
                   f"{name}, activity: output and files equal those of one process")
        self.check(self.track_outputs(f"tracks-{name}", "--engine", name, *options) == self.tracks_one, f"{name}, track: files equal those of one process")

    # --- engines ---------------------------------------------------------------------------------------------------

    def engine(self, name, *options):
        for study, verb in VERB.items():
            out = f"{study}-{name}"
            begin = time.time()
            done = self.faba(verb, f"{study}.toml", "--quiet", "--out", out, "--engine", name, *options)
            self.check(done.returncode == 0, f"{name}, {study}: {time.time() - begin:.1f} s {done.stderr}")
            self.equal(study, out, f"{name}, {study}")
            self.check("submitted" in self.log(out), f"{name}, {study}: attempts are logged")
        self.engine_for_videos(name, *options)

    def workers(self, out):
        """Processes of workers of a study."""
        return [p for p in slurm_cluster.processes()
                if " study work " in slurm_cluster.command(p) and f"/{out} " in slurm_cluster.command(p)
                and slurm_cluster.command(p).startswith(self.program)]

    def size_of_results(self, out):
        size = 0
        for file in (self.folder / out / "results").glob("*"):
            try:
                size += file.stat().st_size
            except FileNotFoundError:  # renamed by its worker
                pass
        return size

    def wait_for_results(self, run, out, bytes_, limit=math.inf):
        end = time.monotonic() + limit
        while not (self.size_of_results(out) > bytes_ and self.workers(out)):
            if run.poll() is not None:
                raise RuntimeError(f"{out}: the command ended before it could be interrupted, exit code {run.returncode} {run.stderr.read()}")
            if time.monotonic() > end:
                raise TimeoutError(f"{out}: no results within {limit} s")
            time.sleep(0.01)

    def log(self, out):
        return (self.folder / out / "attempts.csv").read_text()

    def kill_worker(self, run, out, bytes_):
        """Kills a worker in the middle. A worker that has just computed its last task leaves none: then another one is killed, when the
        log has the end of the first."""
        self.wait_for_results(run, out, bytes_)
        before = self.log(out).count("left tasks")
        while self.log(out).count("left tasks") == before:
            self.wait_for_results(run, out, bytes_)
            ends = ended(self.log(out))
            try:
                os.kill(self.workers(out)[0], signal.SIGKILL)
            except (IndexError, ProcessLookupError):  # it has just ended
                continue
            while ended(self.log(out)) == ends and run.poll() is None:
                time.sleep(0.01)

    def kill_calibration(self, name, *options):
        out = f"kill-calibration-{name}"
        run = self.start("calibrate", "calibration.toml", "--quiet", "--out", out, "--engine", name, *options)
        self.kill_worker(run, out, 100)
        code = run.wait()
        self.check(code == 0, f"{name}, calibration: a worker killed, exit code {code} {run.stderr.read()}")
        self.equal("calibration", out, f"{name}, calibration, a worker killed")

    def kill_workers(self, name, *options):
        """A worker is killed twice; then the command, twice, and it is started again."""
        out = f"kill-{name}"
        command = ("compare-controllers", "controllers.toml", "--quiet", "--out", out, "--engine", name, *options)
        run = self.start(*command)
        for size in (20000, 200000):
            self.kill_worker(run, out, size)
        code = run.wait()
        self.check(code == 0, f"{name}: 2 workers killed, exit code {code} {run.stderr.read()}")
        self.equal("controllers", out, f"{name}, workers killed")
        shutil.rmtree(self.folder / out)
        if name in ("dask", "parallel"):
            self.kill_parents(name, out, command)
        for size in (100, 20000):
            run = self.start(*command)
            self.wait_for_results(run, out, size)
            os.kill(run.pid, signal.SIGKILL)
            run.wait()
            if name != "slurm":
                time.sleep(0.5 if name == "local" else 3)
                self.check(not self.workers(out), f"{name}: no worker outlives the command")
        done = self.faba(*command)
        self.check(done.returncode == 0, f"{name}: started again after two kills {done.stderr}")
        self.equal("controllers", out, f"{name}, command killed")

    def interrupt_calibration(self, name, *options):
        """Ctrl-C after the first new results. The engines do this in turn with one study; complete_calibration() computes the rest."""
        out = "interrupted"
        run = self.start("calibrate", "calibration.toml", "--quiet", "--out", out, "--engine", name, *options)
        self.wait_for_results(run, out, self.size_of_results(out) + 300)  # more than the starts of four files
        run.send_signal(signal.SIGINT)
        code, message = run.wait(), run.stderr.read()
        self.check(code == 130 and "completed results are kept" in message, f"{name}, calibration: interrupted, exit code {code} {message}")
        self.check(f"--engine {name}" in (self.folder / out / "incomplete").read_text(), f"{name}, calibration: the command that resumes is kept")

    def complete_calibration(self):
        before = {f: f.read_bytes() for f in (self.folder / "interrupted/results").glob("*.results")}
        done = self.faba("calibrate", "calibration.toml", "--quiet", "--out", "interrupted")
        self.check(done.returncode == 0, f"calibration: interrupted on {self.log('interrupted').count('command stopped')} engines, completed {done.stderr}")
        self.check(all(f.read_bytes() == content for f, content in before.items()), "calibration: the results of the engines are kept")
        self.equal("calibration", "interrupted", "calibration, interrupted")

    def started_by(self, run, out, but):
        """A process that started a worker which has results, none of `but`."""
        while run.poll() is None:
            if any((self.folder / out / "results").glob("*")):
                for parent in map(slurm_cluster.parent, self.workers(out)):
                    if parent > 1 and parent not in but:  # an orphan belongs to process 1
                        return parent
            time.sleep(0.01)
        raise RuntimeError(f"{out}: the command ended before it could be interrupted, exit code {run.returncode} {run.stderr.read()}")

    def kill_parents(self, name, out, command):
        """The process of Dask or GNU parallel that started a worker is killed twice."""
        run = self.start(*command)
        killed = []
        for _ in range(2):
            killed.append(self.started_by(run, out, killed))
            os.kill(killed[-1], signal.SIGKILL)
        code = run.wait()
        self.check(code == 0, f"{name}: parents of {len(killed)} workers killed, exit code {code} {run.stderr.read()}")
        self.equal("controllers", out, f"{name}, parents of workers killed")
        shutil.rmtree(self.folder / out)


def ended(log):
    """Number of attempts whose end is in the log."""
    return log.count("left tasks") + log.count(",complete,")


def limit_time(folder):
    """Ends a test that waits for something that never comes, with what it waits for."""
    time.sleep(TIME_LIMIT)
    faulthandler.dump_traceback()
    print(slurm_cluster.state())
    for log in pathlib.Path(folder).glob("*/attempts.csv"):
        print(log, *log.read_text().splitlines()[-20:], sep="\n  ")
    print(f"FAILED: not complete after {TIME_LIMIT} s", flush=True)
    for process in slurm_cluster.processes():
        if str(folder) in slurm_cluster.command(process) + slurm_cluster.environment(process):
            os.kill(process, signal.SIGKILL)
    os._exit(1)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", required=True, type=pathlib.Path)
    parser.add_argument("--kills", action="store_true")
    parser.add_argument("--only", action="append", default=[])
    options = parser.parse_args()
    wanted = lambda name: not options.only or name in options.only
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        test = Test(options.program.resolve(), folder)
        threading.Thread(target=limit_time, args=(folder,), daemon=True).start()
        test.write_studies()
        test.write_controllers(60, "3 s")
        test.videos_in_one_process()
        if wanted("hand"):
            for study in VERB:
                test.by_hand(study)
            test.elsewhere()
            test.refused()
        if options.kills:
            test.write_controllers_to_kill()
        for name, extra in (("local", ("--workers", 2)), ("parallel", ("--workers", 2)), ("dask", ("--workers", 3))):
            if not wanted(name):
                continue
            if why := slurm_cluster.missing_package(name):
                test.skip(f"{name}: {why}")
                continue
            test.engine(name, *extra)
            test.interrupt_calibration(name, *extra)
            if name == "dask":
                dask_checks.run(test)
            if name == "parallel":
                parallel_checks.run(test)
            if options.kills:
                test.kill_workers(name, *extra)
            if options.kills and name == "parallel":
                test.kill_calibration(name, *extra)
        if wanted("slurm"):
            slurm_checks.run(test, options.kills)
        if (test.folder / "interrupted").exists():
            test.complete_calibration()
    for what in test.failures:
        print("FAILED:", what)
    print(f"{len(test.failures)} failures, {len(test.skipped)} skipped")
    sys.exit(1 if test.failures else 77 if test.skipped else 0)


if __name__ == "__main__":
    main()
