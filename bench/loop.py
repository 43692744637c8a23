#!/usr/bin/python3
"""The loop on a bench: how late pictures and commands are, whether estimators keep up with a camera on one core, and how the same scene
settles on three rigs. Checks that the swarm came to its setpoint on each. Writes bench/results/loop.md.

    bench/loop.py [--program build/faba] [--seconds 30] [--seeds 5] [--out bench/results]

The bench is simulated, in real time, on the same machine: its rendering takes a good part of one core.
"""

import argparse
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent
FRAME_MS = 1e3 / 60
STEP = ("--set", f"simulation.step={1 / 540}")
ROLLERS = ROOT.parent / "shared/data/step-response/rollers.mp4"


LATE = []  # runs that the guard ended: this is no real-time machine


def faba(program, *arguments, one_core=False):
    before = ["taskset", "-c", "0"] if one_core else []
    for _ in range(6):
        done = subprocess.run([*before, str(program), *map(str, arguments), "--json", "--force"], capture_output=True, text=True, cwd=ROOT)
        if done.returncode != 4 or not any(what in done.stderr for what in ("command timeout", "heartbeat timeout", "stale command")):
            break
        LATE.append(done.stderr.strip())
    if done.returncode != 0:
        sys.exit(f"loop.py: {' '.join(map(str, arguments))}: {done.stderr.strip()}")
    return json.loads(done.stdout)


def verdict(value, goal):
    return "met" if value <= goal else "NOT MET"


WAKE = """
import sys, time
late, end = [], time.monotonic() + float(sys.argv[1])
while (now := time.monotonic()) < end:
    time.sleep(0.001)
    late.append(1e3 * (time.monotonic() - now - 0.001))
late.sort()
print(*(late[min(len(late) - 1, int(q * len(late)))] for q in (0.5, 0.99, 0.999, 1)))
"""


def latency(program, folder, seconds):
    """Rows of the latency table: with both videos recorded. Beside it, how late this machine wakes who sleeps for a millisecond: what no
    program on it can be better than."""
    wake = subprocess.Popen([sys.executable, "-c", WAKE, str(seconds)], stdout=subprocess.PIPE, text=True)
    run = faba(program, "rig", "run", "scenes/bench.toml", "--arm", "--seed", 1, "--duration", f"{seconds} s", "--set", "record.lossless=true",
               "--out", folder / "latency")
    rows = []
    for what, key, goals in (("from mid-exposure to the program", "arrival_ms", None),
                             ("from there to the coils", "command_ms", (5, FRAME_MS))):
        v = run[key]
        goal = f"{goals[0]:.0f} ms {verdict(v['median'], goals[0])}, {goals[1]:.1f} ms {verdict(v['p999'], goals[1])}" if goals else ""
        rows.append(f"| {what} | {v['median']:.1f} | {v['p99']:.1f} | {v['p999']:.1f} | {v['max']:.1f} | {goal} |")
    median, p99, p999, most = map(float, wake.communicate()[0].split())
    rows.append(f"| how late the machine woke another thread meanwhile | {median:.1f} | {p99:.1f} | {p999:.1f} | {most:.1f} |  |")
    return run, rows


def film(program, folder):
    """A lossless video of 640 x 480 px to play."""
    faba(program, "run", "scenes/bench.toml", "--seed", 2, "--duration", "10 s", "--as-seen", "--set", "record.video=false", "--set",
         "record.lossless=true", "--out", folder / "film")
    return folder / "film/video.avi"


PLAYED = """duration = "1000 s"
[scale]
um_per_px = 1
[arena]
type = "box"
size_px = [{width}, {height}]
[estimator]
type = "{estimator}"
[controller]
type = "manual"
[[swarm]]
count = 10
[record]
video = false
[rig]
driver = "none"
[rig.camera]
type = "playback"
file = "{file}"
fast = {fast}
"""


def played(program, folder, file, size, estimator, fast):
    scene = folder / f"{file.stem}-{estimator}-{fast}.toml"
    scene.write_text(PLAYED.format(width=size[0], height=size[1], estimator=estimator, file=file, fast="true" if fast else "false"))
    begun = time.monotonic()
    run = faba(program, "rig", "run", scene, "--arm", "--threads", 1, "--out", folder / scene.stem, one_core=True)
    return run, time.monotonic() - begun


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--program", type=pathlib.Path, default=ROOT / "build/faba")
    p.add_argument("--seconds", type=int, default=30)
    p.add_argument("--seeds", type=int, default=5)
    p.add_argument("--out", type=pathlib.Path, default=HERE / "results")
    o = p.parse_args()
    program = o.program.resolve()
    wrong = []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        run, rows = latency(program, folder, o.seconds)
        text = ["# The loop on a bench", "", "Made by `bench/loop.py` on 2 cores; the bench is simulated, on the same machine, in real time.", "",
                f"640 × 480 px at 60 frames/s, estimator `image`, both videos recorded: {run['frames']} frames taken, {run['frames_dropped']} dropped; "
                f"the recorder was {run['recorder_most_behind']} frames behind at most.", "",
                "| latency | median, ms | 99 % | 99.9 % | most | goals: median, 99.9 % |", "|---|---|---|---|---|---|", *rows, ""]

        text += ["A video played as a camera, as fast as frames are taken, on one core: reading, estimating, deciding.", "",
                 "| video | estimator | ms per frame | a camera gives one every |", "|---|---|---|---|"]
        for file, size, rate in ((film(program, folder), (640, 480), 60), (ROLLERS, (2048, 1080), 15)):
            if not file.exists():
                continue
            for estimator in ("image", "groups"):
                done, seconds = played(program, folder, file, size, estimator, True)
                ms = 1e3 * seconds / done["frames"]
                text.append(f"| {size[0]} × {size[1]} px, {done['frames']} frames | `{estimator}` | {ms:.1f} | {1e3 / rate:.1f} ms at {rate} frames/s, {verdict(ms, 1e3 / rate)} |")
        if ROLLERS.exists():
            done, _ = played(program, folder, ROLLERS, (2048, 1080), "groups", False)
            text += ["", f"The rollers at their own rate: {done['frames']} frames taken, {done['frames_dropped']} dropped, each {done['arrival_ms']['median']:.1f} ms old "
                     f"(median) when it came, {done['command_ms']['median']:.1f} ms more to a command."]

        text += ["", "One scene, `scenes/bench.toml`, on three rigs: settling time, s, for each seed, and the rms distance in the last third, px. Simulations "
                 "with the steps of the bench, a ninth of a frame.", "",
                 "| rig | settling times | median | steady, px (median) |", "|---|---|---|---|"]
        for what, arguments in (("simulation, all positions known", ["run", *STEP]),
                                ("simulation, pictures of the microscope", ["run", *STEP, "--set", "camera.sensor=frames"]),
                                ("simulation, pictures that come one frame late", ["run", *STEP, "--set", "camera.sensor=frames", "--set", "camera.delay_frames=1"]),
                                ("bench: pictures in real time, coils behind an amplifier", ["rig", "run", "--arm"])):
            settled, steady = [], []
            for seed in range(1, o.seeds + 1):
                verb = ["rig", "run"] if arguments[0] == "rig" else ["run"]
                done = faba(program, *verb, "scenes/bench.toml", *arguments[len(verb):], "--seed", seed, "--out", folder / f"{len(text)}-{seed}", "--set", "record.video=false")
                settled.append(done["settling_time_s"])
                steady.append(done["steady_rms_px"])
            if any(s is None for s in settled):
                wrong.append(what)
            known = [s for s in settled if s is not None]
            text.append(f"| {what} | {', '.join('never' if s is None else f'{s:.1f}' for s in settled)} | {statistics.median(known) if known else float('nan'):.1f} "
                        f"| {statistics.median(steady):.1f} |")
    text += ["", f"Runs that the guard ended because this machine stood still for longer than it allows, and that were made again: {len(LATE)}."]
    page = "\n".join(text) + "\n"
    print(page, end="")
    o.out.mkdir(parents=True, exist_ok=True)
    (o.out / "loop.md").write_text(page)
    if wrong:
        sys.exit(f"loop.py: the swarm did not settle: {', '.join(wrong)}")


if __name__ == "__main__":
    main()
