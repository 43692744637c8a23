#!/usr/bin/python3
"""Fails when code knows a part by its name: a registered part's name may stand as a string in the part's own file, in
src/app/parts.cpp, and where a default is chosen. Everything else asks a part for its traits (src/core/traits.h).

check_parts.py --program build/faba --root .

Many names are ordinary words that also mean other things, such as a key of a JSON object. Those places are listed here
with what the word means there; an entry that is no longer needed is an error, too."""

import argparse
import json
import pathlib
import re
import subprocess
import sys

# Where the default of a section is chosen.
DEFAULTS = {
    "src/app/scenario/scenario.h": {"box", "uniform", "none", "fuzzy", "horn_schunck"},
    "src/app/scenario/scenario.cpp": {"mean", "image", "none", "hold"},
    "src/app/scenario/sections/field.cpp": {"uniform"},
    "src/app/scenario/sections/swarm.cpp": {"dipole", "uniform"},
    "src/rig/setup/rig_setup.cpp": {"simulated"},
}
OTHER_MEANINGS = {}


def part_names(program):
    out = subprocess.run([program, "parts", "--json"], check=True, capture_output=True, text=True).stdout
    return {name for kind in json.loads(out).values() for name in kind}


def own_file(text, name):
    """Whether a file describes the part: its schema has the name, whatever the type of its parameters."""
    return re.search(r'(?:Schema<[\w:]+>\(|_schema\(|return \{)\s*"' + re.escape(name) + '"', text) is not None


def strings_in(text):
    """Line number and content of the string literals of C++ or TypeScript, comments left out."""
    for number, line in enumerate(text.splitlines(), 1):
        code = re.sub(r"^\s*//.*$|(?<=[\s;{}])//.*$", "", line)
        for found in re.finditer(r'"((?:[^"\\]|\\.)*)"|\'([a-z_]+)\'', code):
            yield number, found[1] if found[1] is not None else found[2]


def main():
    options = argparse.ArgumentParser()
    options.add_argument("--program", required=True)
    options.add_argument("--root", type=pathlib.Path, required=True)
    o = options.parse_args()
    names = part_names(o.program)
    wrong, used = [], set()
    files = [f for pattern in ("src/**/*.cpp", "src/**/*.h", "web/src/**/*.ts", "web/src/**/*.svelte") for f in sorted(o.root.glob(pattern))]
    for file in files:
        here = str(file.relative_to(o.root))
        text = file.read_text()
        for number, word in strings_in(text):
            if word not in names or here == "src/app/parts.cpp" or own_file(text, word):
                continue
            if word in DEFAULTS.get(here, ()):
                continue
            if word in OTHER_MEANINGS.get(here, {}):
                used.add((here, word))
                continue
            wrong.append(f'{here}:{number}: "{word}" is the name of a part; ask for a trait, or say in tools/check_parts.py what it means')
    for here, words in OTHER_MEANINGS.items():
        for word in words:
            if (here, word) not in used:
                wrong.append(f'tools/check_parts.py: "{word}" no longer stands in {here}; take the entry out')
    print("\n".join(wrong) or f"{len(names)} names of parts stand in {len(files)} files only where they may")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
