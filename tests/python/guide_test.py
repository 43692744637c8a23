"""Runs the blocks ```python of docs/guide/python.md in order, in one namespace in a temporary folder. Blocks ```python no-run are only compiled."""

import contextlib
import io
import os
import pathlib
import re
import tempfile
import unittest

from common import ROOT, main

GUIDE = ROOT / "docs/guide/python.md"


def blocks():
    """Triples (line of the page, text after "python", code)."""
    text = GUIDE.read_text()
    for m in re.finditer(r"^```python([^\n]*)\n(.*?)^```", text, re.M | re.S):
        yield text.count("\n", 0, m.start()) + 1, m[1].strip(), m[2]


class Guide(unittest.TestCase):
    def test_the_blocks_run(self):
        before = os.getcwd()
        self.addCleanup(os.chdir, before)
        with tempfile.TemporaryDirectory() as folder:
            for name in ("scenes", "rigs", "studies"):
                (pathlib.Path(folder) / name).symlink_to(ROOT / name)
            os.chdir(folder)
            space, ran = {"__name__": "__main__"}, 0
            for line, mark, code in blocks():
                compiled = compile("\n" * line + code, str(GUIDE), "exec")  # the lines of tracebacks are those of the page
                if mark == "no-run":
                    continue
                self.assertEqual(mark, "", f"{GUIDE}:{line}")
                with self.subTest(line=line), contextlib.redirect_stdout(io.StringIO()):
                    exec(compiled, space)
                    ran += 1
            os.chdir(before)
        self.assertGreater(ran, 15)

    def test_the_comments_on_the_error_are_what_it_prints(self):
        import faba

        with self.assertRaises(faba.Error) as caught:
            faba.Simulation(ROOT / "scenes/steer.toml", set={"swarm[0].model.sped": 1})
        for value in (caught.exception.where, caught.exception.what, f"# {caught.exception.code},"):
            self.assertIn(value, GUIDE.read_text())


if __name__ == "__main__":
    main()
