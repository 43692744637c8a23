#!/usr/bin/python3
"""The program for arm64, run with qemu-aarch64, against the program of this machine: the same state hash, series.csv byte for byte,
and the same values in tracks.h5; a simulated bench with the guard; the Python module. A check that cannot run here is printed as SKIPPED, and the exit code is
then 77.

    arm64_test.py --program build/arm64/faba --sysroot build/arm64/sysroot --reference build/faba --root ."""

import argparse
import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time
import unittest

try:
    import h5py
except ImportError:
    h5py = None

HERE = None  # command line

# Positions of all cells, and rendered pictures that the image estimator sees.
RUNS = {
    "steer": ["scenes/steer.toml"],
    "frames": ["scenes/bench.toml", "--set", "camera.sensor=frames", "--duration", "3 s"],
    "drop": ["scenes/drop.toml", "--duration", "4 s"],
}


def emulator():
    return [str(HERE.root / "tools/emulate_arm64.sh"), str(HERE.sysroot)]


def values(file):
    """Datasets of numbers in an HDF5 file, as bytes. The file itself depends on the times at which its parts were written to disk."""
    found = {}
    with h5py.File(file) as h5:
        def add(name, item):
            if isinstance(item, h5py.Dataset) and item.dtype.kind in "biuf":
                found[name] = item[()].tobytes()

        h5.visititems(add)
    return found


def run(command, **options):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, **options)
    if done.returncode != 0:
        raise AssertionError(f"exit code {done.returncode}: {command}\n{done.stdout}{done.stderr}")
    return done.stdout


class Arm64(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="faba-arm64-")
        cls.path = pathlib.Path(cls.folder.name)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def on_arm64(self, *arguments):
        """Output of the arm64 program. It starts no other program here, so qemu-aarch64 needs no help of the kernel."""
        return run(["qemu-aarch64", "-L", HERE.sysroot, HERE.program, *arguments], cwd=HERE.root)

    def with_processes(self, *command, **options):
        """Output of an arm64 program that starts others."""
        able = subprocess.run([*emulator(), "true"], capture_output=True, text=True)
        if able.returncode == 77:
            self.skipTest(able.stderr.strip())
        return run([*emulator(), *command], cwd=HERE.root, **options)

    def test_the_program_is_for_arm64(self):
        header = HERE.program.read_bytes()[:20]
        self.assertEqual(header[18:20], b"\xb7\x00", "machine of the ELF header")
        self.assertEqual(json.loads(self.on_arm64("doctor", "--json"))["vector_unit"], "NEON")

    def test_runs_have_the_same_bytes(self):
        for name, arguments in RUNS.items():
            with self.subTest(name):
                here, there = self.path / f"{name}-here", self.path / f"{name}-arm64"
                start = time.monotonic()
                expected = json.loads(run([HERE.reference, "run", *arguments, "--seed", "1", "--json", "--out", here], cwd=HERE.root))
                middle = time.monotonic()
                found = json.loads(self.on_arm64("run", *arguments, "--seed", "1", "--json", "--out", there))
                took = time.monotonic() - middle
                self.assertEqual(found["state_hash"], expected["state_hash"])
                rows = (here / "series.csv").read_bytes()
                self.assertGreater(len(rows), 1000)
                self.assertTrue((there / "series.csv").read_bytes() == rows, "series.csv differs")
                print(f"{name}: state hash {found['state_hash']}, equal series.csv of {len(rows)} bytes; {middle - start:.1f} s here, "
                      f"{took:.1f} s under emulation", flush=True)
                if h5py is None:
                    self.skipTest("python3-h5py is not installed: tracks.h5 is not compared")
                expected_tracks, tracks = values(here / "tracks.h5"), values(there / "tracks.h5")
                self.assertGreater(len(expected_tracks), 3)
                self.assertEqual(tracks.keys(), expected_tracks.keys())
                for key in tracks:
                    self.assertTrue(tracks[key] == expected_tracks[key], f"{key} of tracks.h5 differs")

    def test_a_simulated_bench_runs(self):
        out = self.path / "bench"
        small = {"camera.rate": "2 Hz", "swarm[0].count": "30", "arena.view_px": "[128, 96]", "arena.radius_px": "40",
                 "arena.centre_px": "[64, 48]", "swarm[0].start": "{type = 'disc', centre_px = [46, 48], radius_px = 6}",
                 "reference.setpoint_px": "[80, 48]"}  # the emulator is slow
        changes = [word for key, value in small.items() for word in ("--set", f"{key}={value}")]
        try:
            self.with_processes(HERE.program, "rig", "run", "scenes/bench.toml", "--arm", "--quiet", "--duration", "12 s", "--out", out,
                                *changes)
        except AssertionError as e:
            if "too slow for the frame rate" not in str(e) and "control cycle overran" not in str(e):
                raise
            self.skipTest("this machine is too slow for a bench under emulation: " + str(e).strip().splitlines()[-1])
        self.assertFalse((out / "incomplete").exists())
        with open(out / "series.csv") as file:
            rows = list(csv.DictReader(file))
        distances = [float(row["distance_px"]) for row in rows]
        print(f"bench: {len(rows)} frames, distance {distances[0]:.0f} px at the start, {distances[-1]:.0f} px at the end", flush=True)
        self.assertGreater(len(rows), 20)

    def test_the_python_module(self):
        module = HERE.program.parent / "python"
        if not list(module.glob("faba/_faba*.so")):
            self.skipTest(f"{module} has no Python module")
        program = ("import faba, platform\nsim = faba.Simulation('scenes/corner.toml', seed=1)\n"
                   "for _ in range(90): sim.turn()\nprint(platform.machine(), sim.state_hash)")
        out = self.with_processes(HERE.sysroot / "usr/bin/python3", "-c", program, env={**os.environ, "PYTHONPATH": str(module)})
        machine, found = out.split()
        self.assertEqual(machine, "aarch64")
        self.assertEqual(found, "4b5a0bbcb7afa31f", "golden hash of corner after 90 frames (tests/golden/hashes.h)")


def main():
    global HERE
    parser = argparse.ArgumentParser(description=__doc__)
    for name in ("program", "sysroot", "reference", "root"):
        parser.add_argument(f"--{name}", type=lambda text: pathlib.Path(text).resolve(), required=True)
    HERE = parser.parse_args()
    if not HERE.reference.exists():
        print(f"SKIPPED: {HERE.reference} does not exist; `make build` builds the program to compare with")
        sys.exit(77)
    result = unittest.main(argv=[sys.argv[0]], exit=False, verbosity=2).result
    sys.exit(1 if not result.wasSuccessful() else 77 if result.skipped else 0)


if __name__ == "__main__":
    main()
