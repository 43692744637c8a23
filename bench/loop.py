#!/usr/bin/python3
"""Measures the control loop on a bench: latency of pictures and commands, processing time per frame on one core, and settling times of
one scene in simulations and on the bench. Checks that the swarm reaches its setpoint. Writes bench/results/loop.md.

    bench/loop.py [--program build/faba] [--seconds 30] [--seeds 5] [--out bench/results]

The bench is simulated in real time on the same machine; its rendering takes a large part of one core.
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


LATE = []  # messages of runs that the guard ended because this computer is not a real-time system


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


def latency(program, folder, seconds, *settings):
    """Rows of the latency table, with both videos recorded, with these settings of the scenario. The last row is the wake-up latency of a thread on this machine that sleeps for
    1 ms: a lower limit for every program."""
    wake = subprocess.Popen([sys.executable, "-c", WAKE, str(seconds)], stdout=subprocess.PIPE, text=True)
    run = faba(program, "rig", "run", "scenes/bench.toml", "--arm", "--seed", 1, "--duration", f"{seconds} s", "--set", "record.lossless=true",
               *(word for s in settings for word in ("--set", s)), "--out", folder / "latency")
    rows = []
    for what, key, goals in (("from mid-exposure to the arrival of the picture", "arrival_ms", None),
                             ("from the arrival of the picture to the command", "command_ms", (5, FRAME_MS))):
        v = run[key]
        goal = f"{goals[0]:.0f} ms {verdict(v['median'], goals[0])}, {goals[1]:.1f} ms {verdict(v['p999'], goals[1])}" if goals else ""
        rows.append(f"| {what} | {v['median']:.1f} | {v['p99']:.1f} | {v['p999']:.1f} | {v['max']:.1f} | {goal} |")
    median, p99, p999, most = map(float, wake.communicate()[0].split())
    rows.append(f"| wake-up latency of another thread at the same time | {median:.1f} | {p99:.1f} | {p999:.1f} | {most:.1f} |  |")
    return run, rows


def film(program, folder):
    """Records a lossless video of 640 x 480 px for playback."""
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
    started = time.monotonic()
    run = faba(program, "rig", "run", scene, "--arm", "--threads", 1, "--out", folder / scene.stem, one_core=True)
    return run, time.monotonic() - started


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--program", type=pathlib.Path, default=ROOT / "build/faba", help="the program, default build/faba")
    p.add_argument("--seconds", type=int, default=30, help="duration of the latency measurement, default 30 s")
    p.add_argument("--seeds", type=int, default=5, help="number of seeds, default 5")
    p.add_argument("--out", type=pathlib.Path, default=HERE / "results", help="folder of the results, default bench/results")
    o = p.parse_args()
    program = o.program.resolve()
    wrong = []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        run, rows = latency(program, folder, o.seconds)
        text = ["# The control loop on a bench", "",
                "Generated by `bench/loop.py` on 2 cores. The bench is simulated in real time on the same machine.", "",
                f"640 × 480 px at 60 frames/s, estimator `image`, both videos recorded: {run['frames']} frames processed, {run['frames_dropped']} dropped; "
                f"maximum queue of the recorder: {run['recorder_most_behind']} frames.", "",
                "| latency | median, ms | 99 % | 99.9 % | maximum | goals: median, 99.9 % |", "|---|---|---|---|---|---|", *rows, ""]

        text += ["Playback of a video on one core without waiting for the frame rate: reading, estimator and controller.", "",
                 "| video | estimator | ms per frame | frame interval |", "|---|---|---|---|"]
        for file, size, rate in ((film(program, folder), (640, 480), 60), (ROLLERS, (2048, 1080), 15)):
            if not file.exists():
                continue
            for estimator in ("image", "groups"):
                done, seconds = played(program, folder, file, size, estimator, True)
                ms = 1e3 * seconds / done["frames"]
                text.append(f"| {size[0]} × {size[1]} px, {done['frames']} frames | `{estimator}` | {ms:.1f} | {1e3 / rate:.1f} ms at {rate} frames/s, {verdict(ms, 1e3 / rate)} |")
        if ROLLERS.exists():
            done, _ = played(program, folder, ROLLERS, (2048, 1080), "groups", False)
            text += ["", f"Playback of the video of rollers at its frame rate: {done['frames']} frames processed, {done['frames_dropped']} dropped; median latency "
                     f"{done['arrival_ms']['median']:.1f} ms to the arrival of a picture and {done['command_ms']['median']:.1f} ms from there to the command."]

        text += ["", "`scenes/bench.toml` in simulations and on the bench: settling time for each seed, and rms distance to the setpoint in the last third. "
                 "The simulations use the time step of the bench, 1/9 of a frame.", "",
                 "| | settling times, s | median, s | rms distance, px (median) |", "|---|---|---|---|"]
        for what, arguments in (("simulation, known positions", ["run", *STEP]),
                                ("simulation, rendered pictures", ["run", *STEP, "--set", "camera.sensor=frames"]),
                                ("simulation, rendered pictures, delay of one frame", ["run", *STEP, "--set", "camera.sensor=frames", "--set", "camera.delay_frames=1"]),
                                ("bench: rendered pictures in real time, coils with amplifier", ["rig", "run", "--arm"])):
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
    text += ["", f"Number of runs that were repeated because this machine exceeded a timeout of the guard: {len(LATE)}."]
    page = "\n".join(text) + "\n"
    print(page, end="")
    o.out.mkdir(parents=True, exist_ok=True)
    (o.out / "loop.md").write_text(page)
    if wrong:
        sys.exit(f"loop.py: the swarm did not settle: {', '.join(wrong)}")


if __name__ == "__main__":
    main()
