#!/usr/bin/python3
"""Checks that all places that state the version of Faba agree: CMakeLists.txt, CITATION.cff, the newest release in CHANGELOG.md and in the AppStream
data, the program, and the RO-Crate of a run.

    tools/check_release.py [--root .] [--program build/faba]

Prints what differs; exit code 1 if anything does.
"""

import argparse
import json
import pathlib
import re
import subprocess
import sys
import tempfile


def first(pattern, file):
    found = re.search(pattern, file.read_text(), re.M)
    return found[1] if found else "none"


def stated_versions(root):
    """The version and date that each file states; the date is empty where a file has none."""
    log = re.search(r"^## (\d\S*) - (\S+)$", (root / "CHANGELOG.md").read_text(), re.M)
    metainfo = re.search(r'<release version="([^"]+)" date="([^"]+)"', (root / "packaging/desktop/io.faba.lab.metainfo.xml").read_text())
    return {"CMakeLists.txt": (first(r"^project\(faba VERSION (\S+)", root / "CMakeLists.txt"), ""),
            "CITATION.cff": (first(r"^version: (\S+)", root / "CITATION.cff"), first(r"^date-released: '?([\d-]+)", root / "CITATION.cff")),
            "CHANGELOG.md": log.groups() if log else ("none", "none"),
            "io.faba.lab.metainfo.xml": metainfo.groups() if metainfo else ("none", "none")}


def program_versions(program):
    version = subprocess.run([program, "--version"], check=True, capture_output=True, text=True).stdout.split()[1]
    with tempfile.TemporaryDirectory() as folder:
        run = pathlib.Path(folder) / "run"
        subprocess.run([program, "run", "steer", "--duration", "0.2 s", "--seed", "1", "--out", run, "--quiet"], check=True)
        crate = json.loads((run / "ro-crate-metadata.json").read_text())
    software = next(e for e in crate["@graph"] if e.get("@type") == "SoftwareApplication")
    return {"faba --version": (version, ""), "ro-crate-metadata.json": (software["version"], "")}


def main():
    cli = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    cli.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent.parent)
    cli.add_argument("--program", type=pathlib.Path, help="also ask this program and read the RO-Crate of a short run")
    o = cli.parse_args()
    stated = stated_versions(o.root)
    if o.program:
        stated |= program_versions(o.program.resolve())
    version, problems = stated["CMakeLists.txt"][0], []
    date = stated["CHANGELOG.md"][1]
    for where, (number, when) in stated.items():
        if number != version:
            problems.append(f"{where} states the version {number}, CMakeLists.txt {version}")
        if when and when != date:
            problems.append(f"{where} states the date {when}, CHANGELOG.md {date}")
    for problem in problems:
        print(problem)
    sys.exit(1 if problems else 0)


if __name__ == "__main__":
    main()
