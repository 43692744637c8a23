"""What the tests of the Python package share. `main()` ends with exit code 77 if a test was skipped and none failed."""

import json
import os
import pathlib
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("FABA_PROGRAM", str(ROOT / "build/faba"))
SCENES = ROOT / "scenes"
SHARED = ROOT.parent / "shared"

# A fast scene, for tests in which the physics does not matter.
SMALL = """
title = "small"
seed = 3
duration = "1 s"
[camera]
rate = "30 Hz"
[arena]
type = "drop"
radius_px = 220
[[swarm]]
count = 60
model = { type = "dipole", preset = "IT-1" }
start = { type = "disc", centre_px = [250, 240], radius_px = 25 }
[controller]
type = "proportional"
actuation = "duty"
max_output = 40
hold_frames = 1
[reference]
type = "hold"
setpoint_px = [380, 240]
"""


def faba(*arguments, code=0):
    """Runs the program and returns its JSON output."""
    done = subprocess.run([PROGRAM, *map(str, arguments), "--json"], capture_output=True, text=True, check=False)
    assert done.returncode == code, done.stderr
    return json.loads(done.stdout)


def main():
    result = unittest.main(exit=False, verbosity=2).result
    for test, reason in result.skipped:
        print(f"SKIPPED {test}: {reason}", file=sys.stderr)
    sys.exit(1 if not result.wasSuccessful() else 77 if result.skipped else 0)
