#!/usr/bin/python3
"""Records step responses of ageing drops with `faba rig step-response` on simulated benches in real time, and measures the line of eq. 4.1
and the cut-off with `faba activity`. The ground truth comes from the same drops and fields, simulated without a bench and rendered without
noise. Writes bench/results/response.md. Takes half an hour.

    bench/response.py [--program build/faba] [--drops 4] [--repeat 18] [--every 40] [--out bench/results]

Exit status 1 if the cut-off differs by more than the time between two recordings of a drop, or if the 95 % interval of the slope does not
contain the true slope.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent
SCENE = ROOT / "scenes/exposure.toml"
FIRST = 100  # s, air exposure time when a bench starts
GATHER, BEFORE, RECORD = 20, 1, 11  # s, values of [rig.step_response] in the scene
COUNT = (240, 40)  # cells of the first drop, and additional cells of each following drop


def faba(program, *arguments):
    done = subprocess.run([str(program), *map(str, arguments), "--json"], capture_output=True, text=True, cwd=ROOT)
    if done.returncode != 0:
        sys.exit(f"response.py: {' '.join(map(str, arguments))}: {done.stderr.strip()}")
    return json.loads(done.stdout)


def count(drop):
    return ["--set", f"swarm[0].count={COUNT[0] + COUNT[1] * drop}", "--seed", drop + 1]


def record(program, folder, o):
    """Records all drops in parallel, each on a separate simulated bench."""
    running = []
    for drop in range(o.drops):
        command = [program, "rig", "step-response", SCENE, "--arm", *count(drop), "--exposure", f"{FIRST} s", "--repeat", o.repeat, "--every",
                   f"{o.every} s", "--out", folder / f"drop-{drop + 1}", "--json"]
        running.append(subprocess.Popen([str(c) for c in command], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=ROOT))
    responses = []
    for drop, process in enumerate(running):
        out, err = process.communicate()
        if process.returncode != 0:
            sys.exit(f"response.py: drop {drop + 1}: {err.strip()}")
        responses.append(json.loads(out)["responses"])
    return responses


def study_of(file, responses, from_s, settings=""):
    """A study file of all drops; `responses[drop]` = [{out, exposure_s}]."""
    text = settings
    for drop, recorded in enumerate(responses):
        for r in recorded:
            text += f'[[video]]\nfile = "{r["out"]}"\nexposure = "{r["exposure_s"]} s"\nexperiment = "{drop + 1}"\ndirection = 0\nfrom = "{from_s} s"\n'
    file.write_text(text)
    return file


def truth(program, folder, responses, threshold, o):
    """The activity of the same drops with the same fields, each simulated in one run without a bench and rendered without noise."""
    before, after = SCENE.read_text().split("[controller]")
    field = '["250 uT", "0 T"]', '["-250 uT", "0 T"]', '["0 T", "0 T"]'
    text = before + f'[controller]\ntype = "manual"\nfield = {field[0]}\n'
    for i in range(o.repeat):
        for at, b in ((0, field[0]), (GATHER + BEFORE, field[1]), (GATHER + BEFORE + RECORD, field[2])):
            if i * o.every + at > 0:
                text += f'[[controller.segment]]\nat = "{i * o.every + at} s"\nfield = {b}\n'
    scene = folder / "truth-scene.toml"
    scene.write_text(text + "[record]" + after.split("[record]")[1].split("[rig")[0])
    study = f'threshold = "{threshold} px"\n'
    for drop, recorded in enumerate(responses):
        out = folder / f"true-{drop + 1}"
        faba(program, "run", scene, *count(drop), "--set", f"exposure={FIRST} s", "--set", "microscope.noise=0", "--duration",
             f"{o.repeat * o.every} s", "--out", out)
        for i, r in enumerate(recorded):
            from_s = i * o.every + GATHER + BEFORE
            study += (f'[[video]]\nfile = "{out}"\nexposure = "{r["exposure_s"]} s"\nexperiment = "{drop + 1}"\ndirection = 0\n'
                      f'from = "{from_s} s"\nto = "{from_s + RECORD} s"\n')
    file = folder / "truth.toml"
    file.write_text(study)
    return faba(program, "activity", file)


def line(j):
    low, high = j["ci95"]
    return f"slope {j['slope']:.5f} s/s ({low:.5f} to {high:.5f}), intercept {j['intercept']:.2f} s"


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--program", type=pathlib.Path, default=ROOT / "build/faba", help="the program, default build/faba")
    p.add_argument("--drops", type=int, default=4, help="number of drops, default 4")
    p.add_argument("--repeat", type=int, default=18, help="number of step responses per drop, default 18")
    p.add_argument("--every", type=float, default=40, help="time between step responses, default 40 s")
    p.add_argument("--out", type=pathlib.Path, default=HERE / "results", help="folder of the results, default bench/results")
    o = p.parse_args()
    program = o.program.resolve()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        responses = record(program, folder, o)
        measured = faba(program, "activity", study_of(folder / "study.toml", responses, 1))
        true = truth(program, folder, responses, measured["videos"][0]["threshold_px"], o)
    dropped = sum(r["frames_dropped"] for d in responses for r in d)
    frames = sum(r["frames"] for d in responses for r in d)
    low, high = measured["peak_line"]["ci95"]
    slope = low <= true["peak_line"]["slope"] <= high
    if measured["cutoff_s"] is None or true["cutoff_s"] is None:
        sys.exit(f"response.py: no cut-off in the range of air exposure times: {measured['cutoff_s']}, {true['cutoff_s']}")
    # The start of a recording differs from the schedule by about a second.
    between = max(b["exposure_s"] - a["exposure_s"] for d in responses for a, b in zip(d, d[1:]))
    cutoff = abs(measured["cutoff_s"] - true["cutoff_s"]) <= between
    text = f"""# Step responses of ageing drops, recorded unattended

Generated by `bench/response.py`: {o.drops} drops with {o.repeat} step responses each, one every {o.every:g} s, recorded in real time on
simulated benches in parallel ({frames} frames, {dropped} dropped) and measured with `faba activity`.

| | recorded on the bench | the same drops without bench and noise | |
|---|---|---|---|
| time of the maximum against air exposure time (eq. 4.1) | {line(measured["peak_line"])} | {line(true["peak_line"])} | {"met" if slope else "NOT MET"}: the 95 % interval contains the true slope |
| cut-off of the response | {measured["cutoff_s"]:.0f} s | {true["cutoff_s"]:.0f} s | {"met" if cutoff else "NOT MET"}: difference at most {between:.0f} s, the time between two recordings |

| drop | air exposure, s | swarm before the field reversal | maximum, s after the reversal | responds |
|---|---|---|---|---|
"""
    videos = iter(measured["videos"])  # in the order of the study file
    for drop, recorded in enumerate(responses):
        for r in recorded:
            v = next(videos)
            seen = f"{r['cells']:.0f} cells, centroid ({r['swarm_px'][0]:.0f}, {r['swarm_px'][1]:.0f}) px" if r["swarm_px"] else "not detected"
            peak = v["gaussian"]["peak_s"] if v["responds"] else None
            text += f"| {drop + 1} | {r['exposure_s']:.0f} | {seen} | {'' if peak is None else f'{peak - 1:.2f}'} | {'yes' if v['responds'] else 'no'} |\n"
    print(text, end="")
    o.out.mkdir(parents=True, exist_ok=True)
    (o.out / "response.md").write_text(text)
    return 0 if slope and cutoff else 1


sys.exit(main())
