#!/usr/bin/python3
"""Runs clang-tidy over all of src. Prints the findings; exit code 1 if there is one.

    tools/lint.py build/lint [--jobs N]

The folder has the compile_commands.json of a unity build, in which the headers are read once for ten files.
"""

import argparse
import concurrent.futures
import json
import os
import pathlib
import re
import subprocess
import sys
import time


def units(build):
    """The translation units of the program; a unity file includes ten files of src."""
    entries = json.loads((build / "compile_commands.json").read_text())
    files = {pathlib.Path(e["file"]) for e in entries}
    return sorted(f for f in files if f.suffix in (".cpp", ".cxx") and f.name != "program_version.cpp" and "bench" not in f.relative_to(build.parent.parent).parts)


def findings(build, file):
    """The output of clang-tidy for a unit, if it is not clean."""
    # GCC's options are in the commands; a unity file includes .cpp files on purpose.
    words = ["clang-tidy", "--quiet", "-p", str(build), "--extra-arg=-Wno-unknown-warning-option"]
    if file.suffix == ".cxx":
        words.append("--checks=-bugprone-suspicious-include")
    done = subprocess.run([*words, str(file)], capture_output=True, text=True)
    return done.stdout if done.returncode or re.search(r"(warning|error):", done.stdout) else ""


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("build", type=pathlib.Path, help="folder with compile_commands.json")
    a.add_argument("--jobs", type=int, default=os.cpu_count(), help="number of processes, default: all cores")
    o = a.parse_args()
    build = o.build.resolve()
    files = units(build)
    if not files:
        sys.exit(f"lint.py: {build}/compile_commands.json has no file of src")
    started, wrong = time.monotonic(), 0
    with concurrent.futures.ThreadPoolExecutor(o.jobs) as pool:
        results = {pool.submit(findings, build, f): f for f in files}
        for n, one in enumerate(concurrent.futures.as_completed(results), 1):
            if text := one.result():
                wrong += 1
                print(text, flush=True)
            left = (time.monotonic() - started) / n * (len(files) - n)
            if sys.stderr.isatty():
                print(f"\rclang-tidy: {n} of {len(files)}, about {left / 60:.0f} min left ", end="", file=sys.stderr, flush=True)
    minutes = (time.monotonic() - started) / 60
    print(f"clang-tidy: {len(files)} translation units, {wrong} with findings; {minutes:.0f} min")
    sys.exit(wrong > 0)


if __name__ == "__main__":
    main()
