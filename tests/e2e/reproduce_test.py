#!/usr/bin/python3
"""Tests tools/reproduce.py: items of the index of the thesis, completeness of the page, caching of steps, detection of a wrong value.

    reproduce_test.py --program build/faba --root .
"""

import argparse
import math
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as xml

p = argparse.ArgumentParser()
p.add_argument("--program", type=pathlib.Path, required=True)
p.add_argument("--root", type=pathlib.Path, required=True)
O, REST = p.parse_known_args()
PROGRAM, ROOT = O.program.resolve(), O.root.resolve()
INDEX = ROOT.parent / "shared/THESIS_INDEX.md"
sys.path.insert(0, str(ROOT / "tools"))

import reproduce  # noqa: E402
from reproduce_rows import check, flow, index, page, structure  # noqa: E402
from reproduce_rows.faba import Lab  # noqa: E402

# Results that the thesis states in its text, and its future work; the index lists figures, tables and equations.
TEXT_ONLY = ("4.1.1", "beyond")
QUICK = ("Fig 3.10", "Fig 3.12", "Table 4.1", "Fig 3.20", "Fig B.3", "B.6, B.7", "B.8")


def call(*words):
    return subprocess.run(
        [sys.executable, str(ROOT / "tools/reproduce.py"), "--program", str(PROGRAM), *words], capture_output=True, text=True
    )


class List(unittest.TestCase):
    @unittest.skipUnless(INDEX.exists(), f"file not found: {INDEX}")
    def test_lists_all_items_in_the_order_of_the_thesis(self):
        items = [line.split("|")[1].strip() for line in INDEX.read_text().splitlines() if line.startswith("| ")][1:]
        listed = [line[:18].strip() for line in call("--list").stdout.splitlines()]
        self.assertEqual([i for i in listed if i not in TEXT_ONLY], items)
        self.assertLessEqual(set(TEXT_ONLY), set(listed))

    def test_an_item_is_found_by_its_number(self):
        self.assertEqual([r.item for r in index.wanted(["4.13"])], ["Eq 4.1, Fig 4.13"])
        self.assertNotEqual(call("--only", "Fig 9.99").returncode, 0)


class Figures(unittest.TestCase):
    def test_each_heading_exists_in_the_reports_of_the_program(self):
        pages = "\n".join(p.read_text() for p in (ROOT / "src/study/pages").rglob("*.cpp"))
        named_after_videos = {"1-100", "dead"}
        headings = set()
        for p in (ROOT / "tools/reproduce_rows").glob("*.py"):
            headings |= set(re.findall(r'read\.figure\((?:\w+|[\w.]+ / "[\w.]+"), "([^"]+)"', p.read_text()))
        self.assertGreater(len(headings), 10)
        for heading in headings - named_after_videos:
            self.assertRegex(pages, rf'(["]|<h3>){re.escape(heading)}', heading)


class Page(unittest.TestCase):
    def test_quick_results(self):
        with tempfile.TemporaryDirectory() as folder:
            words = ["--out", folder] + [w for item in QUICK for w in ("--only", item)]
            done = call(*words)
            self.assertEqual(done.returncode, 0, done.stderr + done.stdout)
            text = (pathlib.Path(folder) / "index.html").read_text()
            root = xml.fromstring(text)
            ids = [e.get("id") for e in root.iter() if e.get("id")]
            self.assertEqual(len(ids), len(set(ids)))
            for a in root.iter("a"):
                self.assertIn(a.get("href").removeprefix("#"), ids)
            sections = {s.get("id"): "".join(s.itertext()) for s in root.iter("section")}
            self.assertEqual(list(sections), [page.anchor(r.item) for r in index.ROWS if r.item in QUICK])
            for item in QUICK:
                row = next(r for r in index.ROWS if r.item == item)
                self.assertIn(row.verdict, sections[page.anchor(item)])
            self.assertIn(f"{len(QUICK)} of the {len(index.ROWS)} results of the 2016 thesis", text)
            self.assertIn(f"{len(QUICK) - 1} of the {len(QUICK)} results on this page come from runs of", text)
            self.assertIn("computed without it: Fig B.3.", text)
            self.assertIn("Computed without the program", sections[page.anchor("Fig B.3")])
            self.assertNotIn('src="http', text)
            self.assertNotIn("<script", text)
            # A second call uses the cached steps.
            steps = {p: p.stat().st_mtime_ns for p in (pathlib.Path(folder) / "steps").iterdir()}
            self.assertGreater(len(steps), 10)
            self.assertEqual(call(*words).returncode, 0)
            self.assertEqual({p: p.stat().st_mtime_ns for p in (pathlib.Path(folder) / "steps").iterdir()}, steps)


class Layers(unittest.TestCase):
    ROW = next(r for r in index.ROWS if r.item == "Fig 3.10")

    def verdict_with(self, name, value):
        right = getattr(structure, name)
        setattr(structure, name, value)
        try:
            with tempfile.TemporaryDirectory() as folder:
                found = reproduce.made(self.ROW, Lab(PROGRAM, pathlib.Path(folder), False, lambda step: None))
        finally:
            setattr(structure, name, right)
        return check.verdict(self.ROW.verdict, found), [c.what for c in found.checks if not c.ok]

    def test_a_cycle_in_the_table_is_detected(self):
        table = structure.layers()
        wrong = self.verdict_with("layers", lambda: table | {"core": ["sim"]})
        self.assertEqual(wrong[0], check.DIFFERS)
        self.assertIn("include cycle", wrong[1][0])

    def test_a_violation_in_the_sources_is_detected(self):
        wrong = self.verdict_with("violations", lambda lab: ["src/core/a.h:1: core must not include sim"])
        self.assertEqual(wrong, (check.DIFFERS, ["Violations of the layers in the sources"]))


class Verdict(unittest.TestCase):
    def found(self, *values):
        f = check.Found()
        for v in values:
            f.within("a value", v, 1, 2, "range of the test")
        return f

    def test_a_value_must_lie_in_its_range(self):
        self.assertEqual(check.verdict(check.SAME, self.found(1, 1.5, 2)), check.SAME)
        for wrong in (0.999, 2.001, math.nan, math.inf, None, True):
            self.assertEqual(check.verdict(check.SAME, self.found(1.5, wrong)), check.DIFFERS, wrong)

    def test_no_checks_and_failed_computations_differ(self):
        self.assertEqual(check.verdict(check.CORRECTED, check.Found()), check.DIFFERS)
        f = self.found(1.5)
        f.failed = "no such file"
        self.assertEqual(check.verdict(check.CORRECTED, f), check.DIFFERS)
        self.assertEqual(check.verdict(check.PENDING, check.Found()), check.PENDING)

    def test_a_wrong_result_is_detected(self):
        """The distance of appendix B.8 against a table with one digit wrong."""
        row, right = next(r for r in index.ROWS if r.item == "B.8"), flow.TABLE[(3, 0.9)]
        with tempfile.TemporaryDirectory() as folder:
            lab = Lab(PROGRAM, pathlib.Path(folder), False, lambda name: None)
            self.assertEqual(check.verdict(row.verdict, reproduce.made(row, lab)), check.SAME)
            flow.TABLE[(3, 0.9)] = right + 1e-11
            try:
                found = reproduce.made(row, lab)
            finally:
                flow.TABLE[(3, 0.9)] = right
        self.assertEqual(check.verdict(row.verdict, found), check.DIFFERS)
        text = page.page([(row, found)], 1, "", "")
        self.assertIn("1 differ", text)
        self.assertIn("A check fails", text)


if __name__ == "__main__":
    result = unittest.main(argv=[sys.argv[0], *REST], exit=False).result
    sys.exit(1 if not result.wasSuccessful() else 77 if result.skipped else 0)  # 77: ctest lists it as skipped
