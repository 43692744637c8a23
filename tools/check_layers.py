"""Fails when a file includes a folder that its layer may not see (the dependency rule of ARCHITECTURE.md), or when two
headers give different types one name, which no compiler notices and the linker makes one of."""

import pathlib
import re
import sys

MAY = {
    "core": "",
    "field": "core",
    "vision": "core",
    "sim": "core field",
    "control": "core field vision",
    "rig": "core field vision sim",
    "app": "core field vision sim control rig",
    "study": "core field vision sim control rig app",
    "server": "core app study",
    "cli": "core app study server",
    "guard": "core rig",
}
# A third-party library has one home.
HOME = {
    "opencv2/": {"vision", "rig"},
    "libav": {"vision"},
    "libsw": {"vision"},
    "tiff": {"vision"},
    "hdf5": {"core"},
    "toml++": {"core"},
    "CLI/": {"cli"},
    "lemon/": {"vision"},
    "Eigen/": {"vision", "study", "field"},
    "zlib": {"app"},
    "boost/": {"server"},
}


def main(root):
    bad = 0
    internal, headers, includes, types = set(), {}, [], {}
    for file in sorted(root.rglob("*.[hc]*")):
        here = file.relative_to(root).parts[0]
        if here not in MAY:
            print(f"{file}: the folder {here} has no place in tools/check_layers.py")
            bad = 1
            continue
        for number, line in enumerate(file.read_text().splitlines(), 1):
            defined = re.match(r"(?:struct|class|enum class) (\w+)[^;]*$", line) if file.suffix == ".h" else None
            if defined and types.setdefault(defined[1], file) != file:
                print(f"{file}:{number}: {defined[1]} is the name of another type in {types[defined[1]]}")
                bad = 1
            own = re.match(r'\s*#\s*include "(\w+)/', line)
            if own:
                name = line.split('"')[1]
                includes.append((file, name))
                if file.suffix == ".h":
                    headers.setdefault(str(file.relative_to(root)), set()).add(name)
            if own and own[1] != here and own[1] not in MAY[here].split():
                print(f"{file}:{number}: {here} must not include {own[1]}")
                bad = 1
            other = re.match(r"\s*#\s*include <([^>]+)>", line)
            for prefix, homes in HOME.items():
                if other and other[1].startswith(prefix) and here not in homes:
                    print(f"{file}:{number}: <{other[1]}> may be included by {', '.join(sorted(homes))} only")
                    bad = 1
                elif other and other[1].startswith(prefix) and file.suffix == ".h":
                    internal.add(str(file.relative_to(root)))
    # A header that shows a library's types stays within its folder, and so does what includes it.
    grown = True
    while grown:
        grown = {h for h, included in headers.items() if included & internal} - internal
        internal |= grown
    for file, own in includes:
        if own in internal and file.relative_to(root).parts[0] != own.split("/")[0]:
            print(f"{file}: {own} shows a library's types and may be included by its own folder only")
            bad = 1
    return bad


sys.exit(main(pathlib.Path(sys.argv[1])))
