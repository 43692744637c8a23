#!/usr/bin/python3
"""Computes the results of the 2016 thesis that software can reproduce, checks each value against its accepted range, and writes one page.
Results that need the videos of the thesis, which are not public, are computed by the same procedure from rendered experiments.

    tools/reproduce.py [--out runs/reproduce] [--only ITEM]... [--force] [--program build/faba]
    tools/reproduce.py --list

The page is index.html in the output folder; with --only it contains only these results. Steps that were already computed with the same
program and the same inputs are not repeated, unless --force is given. Exit status: 0 all results are in their ranges, 1 a result differs,
2 invalid arguments.
"""

import argparse
import pathlib
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

from reproduce_rows import page, read  # noqa: E402
from reproduce_rows.check import DIFFERS, Found, verdict  # noqa: E402
from reproduce_rows.faba import ROOT, Lab  # noqa: E402
from reproduce_rows.index import ROWS, wanted  # noqa: E402


def options():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--out", type=pathlib.Path, default=ROOT / "runs/reproduce", help="output folder, default runs/reproduce")
    p.add_argument("--only", action="append", default=[], metavar="ITEM", help='an item such as "Fig 4.17" or 4.17; can be repeated')
    p.add_argument("--force", action="store_true", help="repeat all steps")
    p.add_argument("--list", action="store_true", help="print the items with their titles")
    p.add_argument("--program", type=pathlib.Path, default=ROOT / "build/faba", help="the program, default build/faba")
    return p.parse_args()


class Progress:
    """The progress line on a terminal: current result, current step, estimated time left."""

    def __init__(self, rows):
        self.rows, self.at, self.on, self.computed = rows, 0, sys.stderr.isatty(), False
        self.started = self.row_started = time.monotonic()

    def step(self, name):
        self.computed = True
        self.show(f"{self.rows[self.at].item}: {name}")

    def show(self, words):
        if self.on:
            now = time.monotonic()
            done = sum(r.seconds for r in self.rows[: self.at])
            # Cached steps take no time, so the pace is not measured before a step was computed.
            pace = min(4.0, max(0.25, (self.row_started - self.started) / done)) if done > 30 and self.computed else 1
            left = max(0, self.rows[self.at].seconds * pace - (now - self.row_started)) + pace * sum(
                r.seconds for r in self.rows[self.at + 1 :]
            )
            print(f"\r\x1b[K[{self.at + 1}/{len(self.rows)}] {words}, about {_clock(left)} left", end="", file=sys.stderr, flush=True)

    def row(self, index, found=None, result=""):
        if found is None:
            self.at, self.row_started = index, time.monotonic()
            self.show(self.rows[index].item)
        else:
            print(
                f"{chr(13) + chr(27) + '[K' if self.on else ''}[{index + 1}/{len(self.rows)}] {self.rows[index].item}: {result}",
                file=sys.stderr,
                flush=True,
            )


def _clock(seconds):
    return f"{int(seconds) // 60}:{int(seconds) % 60:02d}"


def made(row, lab):
    """Computes the row. An exception is recorded in `failed`, which gives the verdict DIFFERS."""
    found = Found()
    lab.commands, lab.files = found.commands, found.files
    try:
        row.work(lab, found)
    except Exception as e:  # a failed result must not stop the others
        found.failed = f"{type(e).__name__}: {e}"
    found.commands[:] = dict.fromkeys(found.commands)
    found.files[:] = dict(found.files).items()
    return found


def refused(why):
    print(f"reproduce.py: {why}", file=sys.stderr)
    return 2


def main():
    o = options()
    if o.list:
        print("\n".join(f"{r.item:18}{r.shows}" for r in ROWS))
        return 0
    if not o.program.exists():
        return refused(f"program not found: {o.program}; run: make build")
    try:
        rows = wanted(o.only)
    except KeyError as e:
        return refused(f"unknown item {e}; --list prints the items")
    progress = Progress(rows)
    lab = Lab(o.program.resolve(), o.out.resolve(), o.force, progress.step)
    style = read.style(
        lab.run("style", "scenes/corner.toml", "record.video=false", "record.tracks=false", "--duration", "0 s").folder / "report.html"
    )
    results = []
    for i, row in enumerate(rows):
        progress.row(i)
        results.append((row, made(row, lab)))
        progress.row(i, results[-1][1], verdict(row.verdict, results[-1][1]))
    file = o.out / "index.html"
    file.write_text(page.page(results, len(ROWS), style, lab.version))
    counts = page.count(results)
    print(f"{page.summary(counts)}; duration {_clock(time.monotonic() - progress.started)} min\n{file}")
    return 1 if counts[DIFFERS] else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:  # completed steps stay in the cache
        sys.exit(130)
