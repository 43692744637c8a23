"""The notebooks run: notebooks/*.py as Python files, and the .ipynb, which have the same cells, in the kernel of Jupyter."""

import importlib.util
import json
import os
import pathlib
import subprocess
import sys
import unittest

from common import ROOT, main

import faba

sys.path.insert(0, str(ROOT / "tools"))
import notebooks  # noqa: E402

SOURCES = sorted((ROOT / "notebooks").glob("*.py"))
PACKAGE = pathlib.Path(faba.__file__).resolve().parent.parent


def stored(source):
    return json.loads(source.with_suffix(".ipynb").read_text())


def printed(book):
    """The text that each cell of a notebook prints."""
    return ["".join("".join(o["text"]) for o in cell.get("outputs", []) if o["output_type"] == "stream") for cell in book["cells"]]


def figures(book):
    return sum("image/png" in o.get("data", {}) for cell in book["cells"] for o in cell.get("outputs", []))


class Notebooks(unittest.TestCase):
    def test_the_notebooks_have_the_cells_of_the_sources(self):
        self.assertEqual([s.stem for s in SOURCES], ["coils", "controller", "measure", "steer"])
        for source in SOURCES:
            with self.subTest(notebook=source.stem):
                wanted = notebooks.notebook(source.read_text())["cells"]
                cells = [(c["cell_type"], "".join(c["source"])) for c in stored(source)["cells"]]
                self.assertEqual(cells, [(c["cell_type"], "".join(c["source"])) for c in wanted], "run: tools/notebooks.py")

    def test_the_stored_outputs_have_no_error_and_nothing_of_a_machine(self):
        for source in SOURCES:
            with self.subTest(notebook=source.stem):
                book = stored(source)
                outputs = [o for cell in book["cells"] for o in cell.get("outputs", [])]
                self.assertGreater(len(outputs), 5)
                self.assertGreaterEqual(figures(book), 2)
                for output in outputs:
                    self.assertNotEqual(output["output_type"], "error")
                    self.assertNotEqual(output.get("name"), "stderr", output)
                self.assertNotRegex("".join(printed(book)), r"/(tmp|home|work|root|usr)/|\b20\d\d-\d\d-\d\d\b")
                self.assertEqual(book["metadata"], notebooks.METADATA)

    def test_the_sources_print_what_the_notebooks_contain(self):
        for source in SOURCES:
            with self.subTest(notebook=source.stem), notebooks.workplace(ROOT) as folder:
                environment = {**os.environ, "MPLBACKEND": "Agg"}
                done = subprocess.run([sys.executable, "-W", "ignore", source], capture_output=True, text=True, check=False, cwd=folder, env=environment)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertEqual(done.stdout, "".join(printed(stored(source))))

    @unittest.skipIf(importlib.util.find_spec("nbclient") is None or importlib.util.find_spec("ipykernel") is None,
                     "nbclient and ipykernel are not installed: make python")
    def test_the_notebooks_run_in_the_kernel(self):
        for source in SOURCES:
            with self.subTest(notebook=source.stem):
                book = notebooks.execute(stored(source), ROOT, PACKAGE)
                self.assertEqual(printed(book), printed(stored(source)))
                self.assertEqual(figures(book), figures(stored(source)))

    def test_cells_of_a_source(self):
        text = "# %% [markdown]\n# # Title\n#\n# text\n\n# %%\na = 1\n\n\n# %%\nb = 2\n"
        self.assertEqual(notebooks.cells(text), [("markdown", "# Title\n\ntext"), ("code", "a = 1"), ("code", "b = 2")])


if __name__ == "__main__":
    main()
