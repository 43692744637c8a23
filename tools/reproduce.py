#!/usr/bin/python3
"""Makes the results of the 2016 thesis that software can reproduce, compares each with what it must be, and writes one page. Results that
need the thesis's videos, which are not public, are shown by the same procedure on rendered experiments.

    tools/reproduce.py [--out runs/reproduce] [--only ITEM]... [--force] [--program build/faba]
    tools/reproduce.py --list

Steps that were done with the same program are kept and not done again, unless --force. The page is index.html; with --only it has these
results alone. Exits 1 when a result differs, 2 when nothing was done.
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
    p.add_argument("--out", type=pathlib.Path, default=ROOT / "runs/reproduce")
    p.add_argument("--only", action="append", default=[], metavar="ITEM", help='such as "Fig 4.17" or 4.17; may be given several times')
    p.add_argument("--force", action="store_true", help="do everything again")
    p.add_argument("--list", action="store_true", help="print the items and what they show")
    p.add_argument("--program", type=pathlib.Path, default=ROOT / "build/faba")
    return p.parse_args()


class Progress:
    """A line on a terminal: which result, which step of it, and about how long all of them still take."""

    def __init__(self, rows):
        self.rows, self.at, self.on, self.worked = rows, 0, sys.stderr.isatty(), False
        self.begun = self.row_begun = time.monotonic()

    def step(self, name):
        self.worked = True
        self.say(f"{self.rows[self.at].item}: {name}")

    def say(self, words):
        if self.on:
            now = time.monotonic()
            done = sum(r.seconds for r in self.rows[: self.at])
            pace = min(4.0, max(0.25, (self.row_begun - self.begun) / done)) if done > 30 and self.worked else 1  # kept steps take no time
            left = max(0, self.rows[self.at].seconds * pace - (now - self.row_begun)) + pace * sum(
                r.seconds for r in self.rows[self.at + 1 :]
            )
            print(f"\r\x1b[K[{self.at + 1}/{len(self.rows)}] {words}, about {_clock(left)} left", end="", file=sys.stderr, flush=True)

    def row(self, index, found=None, said=""):
        if found is None:
            self.at, self.row_begun = index, time.monotonic()
            self.say(self.rows[index].item)
        else:
            print(
                f"{chr(13) + chr(27) + '[K' if self.on else ''}[{index + 1}/{len(self.rows)}] {self.rows[index].item}: {said}",
                file=sys.stderr,
                flush=True,
            )


def _clock(seconds):
    return f"{int(seconds) // 60}:{int(seconds) % 60:02d}"


def made(row, lab):
    """The row's result; whatever goes wrong is a result too, and one that differs."""
    found = Found()
    lab.commands, lab.files = found.commands, found.files
    try:
        row.work(lab, found)
    except Exception as e:  # one result that cannot be made must not take the others with it
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
        return refused(f"{o.program} is not there; run: make build")
    try:
        rows = wanted(o.only)
    except KeyError as e:
        return refused(f"nothing is called {e}; --list has the items")
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
    print(f"{page.summary(counts)}, after {_clock(time.monotonic() - progress.begun)} min\n{file}")
    return 1 if counts[DIFFERS] else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:  # steps that are done are kept
        sys.exit(130)
