#!/usr/bin/python3
"""Tests whether the measuring verbs know when they are wrong: calls each on suitable and unsuitable material with known truth.

Material is rendered by the program or with numpy; its parameters are sampled at random. Each verb has at least 10 cases of suitable material
and at least 20 cases of at least 8 kinds of unsuitable material. Prints a verdict for both goals of each verb, and writes the table to
bench/results/quality.md. bench/quality/ contains a file for each verb, with its cases, and the definition of a wrong answer.

    bench/quality.py [--program build/faba] [--only VERB...] [--kind KIND...] [--seeds 1] [--held-out] [--jobs 2] [--out bench/results]

Thresholds of the program are chosen on the development seeds (the default) and reported on other seeds, with --held-out. Material and results
are kept in build/quality (--keep) by their contents, so that a second call resumes; a changed program or case is measured again. Exit status 1
if a goal is not met. --reduced runs a few cases of the fast verbs, for the test suite: none may be wrong and good.
"""

import argparse
import concurrent.futures
import hashlib
import json
import pathlib
import shutil
import sys
import tempfile
import zlib

import numpy

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
from quality import VERBS, material, table  # noqa: E402

REDUCED = {"drop": ("suitable", "no drop", "short arc"), "scale": ("suitable", "wrong tick", "table: outlier"),
           "flow": ("suitable", "too fast", "stripes"), "field fit": ("suitable", "wrong sign")}


def file_digest(*files):
    h = hashlib.sha256()
    for f in files:
        h.update(f.read_bytes())
    return h.hexdigest()[:16]


class Cases:
    """Measures cases and keeps their results."""

    def __init__(self, program, keep):
        self.kit = material.Kit(program, keep / "material")
        self.keep = keep / "results"
        self.keep.mkdir(parents=True, exist_ok=True)
        self.program = file_digest(program)

    def measure(self, verb, kind, number, seed):
        module = VERBS[verb]
        files = [HERE / "quality/material.py", HERE / "quality/outcome.py", pathlib.Path(module.__file__)]
        key = material.digest(self.program, file_digest(*files), verb, kind, number, seed)
        stored = self.keep / f"{key}.json"
        if stored.exists():
            return json.loads(stored.read_text())
        rng = numpy.random.default_rng([zlib.crc32(f"{verb} {kind}".encode()), number, seed])
        found = module.KINDS[kind][0](self.kit, rng, number)
        found |= {"kind": kind, "name": f"{kind} {number}, seed {seed}"}
        stored.with_suffix(".tmp").write_text(json.dumps(found))
        stored.with_suffix(".tmp").rename(stored)
        return found


def all_cases(verbs, kinds, seeds):
    for verb in verbs:
        for kind, (_, count) in VERBS[verb].KINDS.items():
            if not kinds or kind in kinds:
                for seed in seeds:
                    for number in range(count):
                        yield verb, kind, number, seed


def reduced(program):
    with tempfile.TemporaryDirectory() as folder:
        cases = Cases(program, pathlib.Path(folder))
        rows = [(verb, cases.measure(verb, kind, 1, 1)) for verb, kinds in REDUCED.items() for kind in kinds]
    bad = [(v, r) for v, r in rows if table.is_confident_error(r) or (r["kind"] == "suitable" and r["quality"] != "good")]
    for verb, r in rows:
        print(f"{verb}: {r['name']}: {r['quality']}{', wrong' if r['wrong'] else ''}: truth {r['truth']}, answer {r['stated']} ({r['interval']})")
    return 1 if bad or len(rows) < 10 else 0


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("--program", type=pathlib.Path, default=HERE.parent / "build/faba", help="the program, default build/faba")
    a.add_argument("--only", nargs="+", choices=list(VERBS), help="only these verbs; writes a table only with --out")
    a.add_argument("--kind", nargs="+", help="only these kinds of material; writes no table")
    a.add_argument("--seeds", type=int, default=1, help="number of seeds, default 1")
    a.add_argument("--held-out", action="store_true", help="seeds on which no threshold was chosen")
    a.add_argument("--jobs", type=int, default=2, help="number of cases at the same time, default 2")
    a.add_argument("--keep", type=pathlib.Path, default=HERE.parent / "build/quality", help="folder of material and results")
    a.add_argument("--clear", action="store_true", help="delete this folder first")
    a.add_argument("--verbose", action="store_true", help="print every case")
    a.add_argument("--out", type=pathlib.Path, help="folder of the table, default bench/results")
    a.add_argument("--reduced", action="store_true", help="a few cases, for the test suite")
    o = a.parse_args()
    program = o.program.resolve()
    if o.reduced:
        return reduced(program)
    if o.clear:
        shutil.rmtree(o.keep, ignore_errors=True)
    cases = Cases(program, o.keep.resolve())
    seeds = [(1000 if o.held_out else 1) + k for k in range(o.seeds)]
    verbs = o.only or list(VERBS)
    results = {verb: [] for verb in verbs}
    with concurrent.futures.ThreadPoolExecutor(o.jobs) as pool:
        todo = list(all_cases(verbs, o.kind, seeds))
        for (verb, *_), row in zip(todo, pool.map(lambda c: cases.measure(*c), todo)):
            results[verb].append(row)
            if o.verbose or table.is_confident_error(row) or (row["kind"] == "suitable" and row["quality"] != "good"):
                print(f"{verb}: {row['name']}: {row['quality']}{', wrong' if row['wrong'] else ''}: truth {row['truth']}, answer {row['stated']} "
                      f"({row['interval']}) {' '.join(row['aspects'])}", flush=True)
    for verb, rows in results.items():
        print("\n".join([f"\n{verb}"] + table.verdict(rows)))
    out = o.out or (None if o.only else HERE / "results")
    if out and not o.kind:
        out.mkdir(parents=True, exist_ok=True)
        (out / "quality.md").write_text(table.page(results, {v: x.INTERVAL for v, x in VERBS.items()}, o.held_out, o.seeds))
    return 0 if table.met(results) else 1


if __name__ == "__main__":
    sys.exit(main())
