#!/usr/bin/python3
"""Makes notebooks/*.ipynb from notebooks/*.py and executes them.

    tools/notebooks.py [NAME ...] [--root DIR] [--package DIR]

The sources are Python files with cells: "# %%" starts a cell with code, "# %% [markdown]" one with text in comments. The notebooks are
executed in a temporary folder with links to scenes, rigs and studies, so that they leave no files. They contain no times, counters of
the kernel or paths of this machine. Needs the packages python3-nbclient and python3-ipykernel; the module of the package
(`make python`) is expected in build/python. tests/python/notebooks_test.py compares the notebooks with the sources.
"""

import argparse
import contextlib
import json
import os
import pathlib
import re
import shutil
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
LINKED = ("scenes", "rigs", "studies")
SECONDS = 600  # at most, for a cell
METADATA = {
    "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
    "language_info": {"file_extension": ".py", "mimetype": "text/x-python", "name": "python"},
}


def cells(source):
    """Pairs (kind, text) of a Python file with cells; kind is "code" or "markdown"."""
    found = []
    for part in re.split(r"^# %%", source, flags=re.M)[1:]:
        head, _, text = part.partition("\n")
        kind = "markdown" if head.strip() == "[markdown]" else "code"
        text = text.strip("\n")
        if kind == "markdown":
            text = "\n".join(line.removeprefix("#").removeprefix(" ") for line in text.splitlines())
        found.append((kind, text))
    return found


def notebook(source):
    """A notebook without outputs, as the dict of its JSON."""
    made = []
    for number, (kind, text) in enumerate(cells(source)):
        cell = {"cell_type": kind, "id": f"cell-{number}", "metadata": {}, "source": text.splitlines(keepends=True)}
        made.append({**cell, "execution_count": None, "outputs": []} if kind == "code" else cell)
    return {"cells": made, "metadata": METADATA, "nbformat": 4, "nbformat_minor": 5}


@contextlib.contextmanager
def workplace(root):
    """A temporary folder notebooks/ beside links to the folders that the notebooks read."""
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for name in LINKED:
            (folder / name).symlink_to(root / name)
        (folder / "notebooks").mkdir()
        yield folder / "notebooks"


def execute(empty, root, package):
    """The notebook with outputs."""
    import nbclient
    import nbformat

    with workplace(root) as folder:
        book = nbformat.reads(json.dumps(empty), as_version=4)
        environment = {**os.environ, "PYTHONPATH": str(package), "IPYTHONDIR": str(folder / ".ipython"), "HOME": str(folder)}
        client = nbclient.NotebookClient(book, timeout=SECONDS, kernel_name="python3", record_timing=False, resources={"metadata": {"path": folder}})
        client.execute(env=environment)
        done = json.loads(nbformat.writes(book))
        return with_lines(cleaned(done), (str(folder), str(folder.parent), str(root)))


def cleaned(book):
    """Without metadata of this execution."""
    book["metadata"] = METADATA
    for cell in book["cells"]:
        cell["metadata"] = {}
        outputs = []
        for output in cell.get("outputs", []):
            if "metadata" in output:
                output["metadata"] = {}
            same = outputs and output["output_type"] == "stream" == outputs[-1]["output_type"] and output["name"] == outputs[-1]["name"]
            if same:  # the kernel divides a stream by time
                outputs[-1]["text"] = [*outputs[-1]["text"], *output["text"]]
            else:
                outputs.append(output)
        if cell["cell_type"] == "code":
            cell["outputs"] = outputs
    return book


def with_lines(book, folders):
    """Refuses paths of this machine; text of streams as complete lines."""
    for number, cell in enumerate(book["cells"]):
        for output in cell.get("outputs", []):
            if output["output_type"] == "stream":
                output["text"] = "".join(output["text"]).splitlines(keepends=True)
            for folder in folders:
                if folder in json.dumps(output):
                    raise SystemExit(f"notebooks: cell {number} prints the path {folder}; print a relative path")
    return book


def main():
    cli = argparse.ArgumentParser(description="Make and execute notebooks/*.ipynb from notebooks/*.py.")
    cli.add_argument("names", nargs="*", help="notebooks, such as steer; default: all")
    cli.add_argument("--root", default=ROOT, type=pathlib.Path, help="folder of the project")
    cli.add_argument("--package", default=None, type=pathlib.Path, help="folder of the package; default: build/python")
    options = cli.parse_args()
    root = options.root.resolve()
    package = (options.package or root / "build/python").resolve()
    if not shutil.which("jupyter-kernelspec") and not pathlib.Path("/usr/share/jupyter").exists():
        raise SystemExit("notebooks: no kernel of Jupyter; install it: apt-get install python3-ipykernel python3-nbclient")
    for source in sorted((root / "notebooks").glob("*.py")):
        if options.names and source.stem not in options.names:
            continue
        book = execute(notebook(source.read_text()), root, package)
        target = source.with_suffix(".ipynb")
        target.write_text(json.dumps(book, indent=1, ensure_ascii=False, sort_keys=True) + "\n")
        print(f"{target.relative_to(root)}: {target.stat().st_size // 1000} kB")


if __name__ == "__main__":
    main()
