#!/usr/bin/python3
"""tools/check_language.py detects a planted word in each kind of text, with file and line, and reports nothing for a clean tree."""

import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "tools"))
import check_language  # noqa: E402

PROGRAM = pathlib.Path(check_language.__file__)
CLEAN = {
    "README.md": "# Faba\n\nThe default is 15 Hz.\n",
    "docs/guide/run.md": "# Run\n\nAn interrupted run can be resumed with `--resume`.\n",
    "src/core/a.cpp": '// The run is complete.\nthrow Error(input, "duration", "must be positive");\nint frame_count = 0;\n',
    "src/core/a.h": "/// Number of frames.\nint frame_count();\nbool isComplete();\n",
    "scenes/a.toml": "# A swarm in a drop.\nduration = '2 s'\n",
    "tools/a.py": '"""Prints the hash."""\n\n\ndef state_hash(value):\n    return 0 if value is None else 1  # there is no more data\n',
    "web/src/a.ts": "export const usually = 'shared';  // parts of other words are permitted: wholesale, reminded, bearing\n",
}
# Name of the case: planted files, and the start of the expected complaint.
PLANTED = {
    "a comment": ({"src/core/a.cpp": "int a;\n// Of the whole video.\n"}, 'src/core/a.cpp:2: "whole"'),
    "a docstring": ({"src/core/a.h": "/// What the user said.\nint a();\n"}, 'src/core/a.h:1: "said"'),
    "a message": ({"src/core/a.cpp": '\n\nfail("run", "is no scenario");\n'}, 'src/core/a.cpp:3: "is no"'),
    "an identifier in camelCase": ({"src/core/a.h": "bool runGoesOn();\n"}, 'src/core/a.h:1: "goes on"'),
    "a constant in CamelCase": ({"src/core/a.h": "constexpr int kTimeInAir = 1;\n"}, 'src/core/a.h:1: "time in air"'),
    "an identifier with underscores": ({"tools/a.py": "\nrun_begun = 0\n"}, 'tools/a.py:2: "begun"'),
    "a key with a prefix": ({"tools/a.py": "state_fingerprint = 0\n"}, 'tools/a.py:1: "fingerprint"'),
    "a documentation page": ({"docs/guide/run.md": "# Run\n\nThe usual value is 3.\n"}, 'docs/guide/run.md:3: "usual"'),
    "the start page": ({"README.md": "# Faba\nStarted anew.\n"}, 'README.md:2: "anew"'),
    "a TOML comment": ({"scenes/a.toml": "duration = '2 s'  # as it was foretold\n"}, 'scenes/a.toml:1: "foretold"'),
    "a script of the page": ({"web/src/a.ts": "// 'The coils rest'\n"}, 'web/src/a.ts:1: "coils rest"'),
    "words with several spaces": ({"docs/guide/run.md": "goes  on\twith the run\n"}, 'docs/guide/run.md:1: "goes on with"'),
    "upper case": ({"docs/guide/run.md": "Whole runs\n"}, 'docs/guide/run.md:1: "whole"'),
    "a Makefile": ({"Makefile": "help:  ## whatever was said\n"}, 'Makefile:1: "said"'),
}


def plant(root, files):
    for name, text in files.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text)


def complaints(files, under=(), repository=False):
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder).resolve()
        plant(root, files)
        if repository:
            subprocess.run(["git", "init", "--quiet", folder], check=True)
        return check_language.check(root, under)


def call(files, *options):
    """Exit status and output of the program."""
    with tempfile.TemporaryDirectory() as folder:
        plant(pathlib.Path(folder), files)
        done = subprocess.run([sys.executable, PROGRAM, "--root", folder, *options], capture_output=True, text=True)
        return done.returncode, done.stdout + done.stderr


def main():
    wrong = [f"a clean tree: {c}" for c in complaints(CLEAN)]
    for what, (files, start) in PLANTED.items():
        for repository in (False, True):
            found = complaints(CLEAN | files, repository=repository)
            if len(found) != 1 or not found[0].startswith(start):
                wrong.append(f"{what}: expected one complaint, {start}; found {found}")
    word = {"src/core/a.cpp": "// said\n"}
    if complaints(CLEAN | word, under=["docs", "tools"], repository=True):
        wrong.append("--under: a file outside the given folders is checked")
    if len(complaints(CLEAN | word, under=["src"], repository=True)) != 1:
        wrong.append("--under: a file in the given folder is not checked")
    if complaints(CLEAN | {".gitignore": "runs/\n", "runs/a.md": "said\n"}, repository=True):
        wrong.append("a file that git ignores is checked")
    if (got := call(CLEAN)) != (0, "check_language: ok\n"):
        wrong.append(f"a clean tree: {got}")
    code, text = call(CLEAN | word)
    if code != 1 or 'src/core/a.cpp:1: "said" is not used here; write: ' not in text:
        wrong.append(f"exit status {code}: {text}")
    if (got := call(CLEAN | word, "--count")[1].splitlines()[0].split()) != ["1", "src/core"]:
        wrong.append(f"--count: {got}")
    print("\n".join(wrong) or f"{len(PLANTED)} planted words detected")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
