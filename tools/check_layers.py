#!/usr/bin/python3
"""Checks the structure of src/ (ARCHITECTURE.md describes the same tables). Reports

- an include of a folder or of a subfolder that the tables below do not permit,
- a folder of measurements in src/study that creates JSON,
- include cycles (the .h and .cpp of one name count as one file),
- a third-party library that is included in a folder that may not include it or that is missing in the table, and a
  header that exposes types of a library and is included by another folder,
- two headers that define types with the same name: no compiler reports this, and the linker merges them,
- two .cpp files of a folder of src that define the same local name, which is an error in a unity build,
- a folder that is missing in the table, or that has more than MOST_FILES files directly in it.

check_layers.py src    prints one line per violation; exit status 1 if there are any."""

import pathlib
import re
import sys

# Folders of src and the folders that each may include.
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
    "python": "core field vision sim control rig app study",
    "guard": "core rig",
    "demo": "core app server",
}
# Subfolders and the sibling subfolders that each may include; "." is the folder itself. In folders that are not listed,
# all subfolders may include each other.
WITHIN = {
    "core": {".": "kernels random", "kernels": ". random", "random": ".", "threads": ".", "h5": ". threads", "process": "."},
    "vision": {
        "image": "",
        "files": "image",
        "flow": "image",
        "drop": "image",
        "ruler": "image",
        "foreground": "image",
        "render": "image",
        "cells": "image files foreground render",
        "draw": "image files flow drop ruler",
    },
    "rig": {
        ".": "",
        "setup": ".",
        "simulated": ".",
        "guard": ". setup",
        "bench": ". setup guard",
        "drivers": ". bench",
        "modules": ".",
    },
    "app": {
        ".": "scenario files",
        "loop": "",
        "scenario": "loop",
        "run": "loop scenario",
        "files": "scenario",
        "sinks": "loop scenario run files",
        "recording": "loop scenario run sinks",
        "bench": "loop scenario run sinks recording",
    },
    "study": {
        "data": "",
        "experiment": "data",
        "stats": "",
        "quality": "",
        "sweep": "",
        "engines": "sweep",
        "plot": "",
        "scale": "stats quality",
        "drop": "data quality",
        "flow": "data quality",
        "tracks": "data stats quality",
        "motion": "data experiment stats tracks quality",
        "uturn": "data stats tracks quality",
        "optics": "quality drop tracks motion",
        "steering": "data stats sweep",
        "coils": "plot quality",
        "identify": "data stats sweep tracks motion quality",
        "calibrate": "stats sweep quality identify",
        "pages": "data experiment stats quality sweep plot scale drop flow tracks motion uturn steering coils identify calibrate optics",
    },
}
# Folders whose results are structs; study/pages, cli and server convert them to JSON. Files that use JSON for another
# purpose: activity_study and moment_study read a study file and have its JSON Schema, field_fit writes the table of a part of a scenario,
# field_library writes the keys of its file.
NO_JSON = ["study/" + folder for folder in "scale drop flow tracks motion uturn coils optics".split()]
MAY_JSON = ["study/motion/activity_study", "study/uturn/moment_study", "study/coils/field_fit", "study/coils/field_library"]
# Folders of the engine include only each other, even if the tables above permit more (CMakeLists.txt: faba_engine).
ENGINE = (
    "core core/kernels core/random core/threads field sim control vision/image vision/foreground vision/render rig/setup rig/simulated "
    "app/loop app/scenario app/run"
).split()
# Interfaces that the engine may include although their implementations are not part of it.
ENGINE_INTERFACES = ["rig/rig.h", "rig/camera.h", "rig/coil_driver.h", "vision/flow/flow.h"]
# Third-party libraries and the folders of src that may include them.
HOME = {
    "opencv2/": {"vision", "rig"},
    "libav": {"vision"},
    "libsw": {"vision"},
    "tiff": {"vision"},
    "hdf5": {"core"},
    "libdeflate": {"core"},
    "toml++": {"core"},
    "CLI/": {"cli"},
    "pybind11/": {"python"},
    "lemon/": {"vision"},
    "Eigen/": {"vision", "study", "field", "control"},
    "unsupported/Eigen/": {"study"},
    "nanoflann": {"field"},
    "nlopt": {"study"},
    "zlib": {"app", "study"},
    "openssl/": {"study"},
    "boost/math": {"core"},
    "boost/geometry": {"study"},
    "boost/asio": {"server"},
    "boost/beast": {"server"},
}
EVERYWHERE = ("fmt/", "nlohmann/")
# Third-party libraries that the engine may include.
ENGINE_LIBRARIES = (*EVERYWHERE, "toml++", "Eigen/", "nanoflann", "boost/math")
# Headers of the standard library and of the operating system; all others belong to third-party libraries.
SYSTEM = re.compile(
    r"[a-z_0-9]+|sys/\w+\.h|(dlfcn|emscripten|errno|fcntl|immintrin|malloc|poll|pty|sched|signal|spawn|std\w+|termios|time|unistd)\.h"
)
# Folders with a unity build (CMakeLists.txt: FABA_UNITY), and their files that are compiled separately.
UNITY = {"field", "vision", "sim", "control", "rig", "app", "study", "server", "cli", "python"}
ALONE = {"sim/agents/adapted.cpp", "sim/agents/basic.cpp", "sim/agents/dipole.cpp", "field/uniform.cpp", "app/parts.cpp"}
SOURCES = (".h", ".cpp", ".c")
MOST_FILES = 40


class Tree:
    """The source files below a folder, and what they include."""

    def __init__(self, root):
        self.root = root
        self.files = [f for f in sorted(root.rglob("*")) if f.suffix in SOURCES]
        self.includes = []  # (file, line number, included path as written, whether in quotes)
        for file in self.files:
            for number, line in enumerate(file.read_text().splitlines(), 1):
                found = re.match(r'\s*#\s*include\s*([<"])([^>"]+)[>"]', line)
                if found:
                    self.includes.append((file, number, found[2], found[1] == '"'))

    def name(self, file):
        return str(file.relative_to(self.root))


def subfolder(path):
    """The key of WITHIN for a path: "image" for vision/image/kernels/x.h, "." for a file directly in its folder."""
    parts = path.split("/")
    return parts[1] if len(parts) > 2 else "."


def check_folders(tree):
    for file in sorted(tree.root.rglob("*")):
        if file.suffix in (".hpp", ".hh", ".cc", ".cxx", ".inc", ".inl"):
            yield f"{file}: unknown suffix; sources end in {', '.join(SOURCES)}"
    count = {}
    for file in tree.files:
        count[file.parent] = count.get(file.parent, 0) + 1
        folder = tree.name(file).split("/")[0]
        if folder not in MAY:
            yield f"{file}: the folder {folder} is missing in the table of tools/check_layers.py"
        elif folder in WITHIN and subfolder(tree.name(file)) not in WITHIN[folder]:
            yield f"{file}: the subfolder {subfolder(tree.name(file))} is missing in the table of tools/check_layers.py"
    for folder, files in count.items():
        if files > MOST_FILES:
            yield f"{folder}: {files} files directly in this folder; the maximum is {MOST_FILES}"


def check_includes(tree):
    for file, number, path, own in tree.includes:
        here, name = tree.name(file).split("/")[0], tree.name(file)
        there = path.split("/")[0]
        if not own and there in MAY and "/" in path:
            yield f"{file}:{number}: {path} is a header of the project; include it in quotes"
        if not own or there not in MAY or here not in MAY:
            continue
        if here != there and there not in MAY[here].split():
            yield f"{file}:{number}: {here} must not include {there}"
        if here == there and here in WITHIN:
            a, b = subfolder(name), subfolder(path)
            if a != b and a in WITHIN[here] and b not in WITHIN[here][a].split():
                yield f"{file}:{number}: {here}/{a} must not include {here}/{b}"


def in_engine(path):
    return any(path.startswith(folder + "/") and "/h5/" not in path for folder in ENGINE)


def check_engine(tree):
    for file, number, path, own in tree.includes:
        if own and in_engine(tree.name(file)) and not in_engine(path) and path not in ENGINE_INTERFACES:
            yield f"{file}:{number}: is part of the engine and must not include {path}"
        if not own and in_engine(tree.name(file)) and not SYSTEM.fullmatch(path) and not path.startswith(ENGINE_LIBRARIES):
            yield f"{file}:{number}: is part of the engine and must not include <{path}>"


def check_json(tree):
    for file in tree.files:
        name = tree.name(file)
        if name.rsplit("/", 1)[0] not in NO_JSON or name.rsplit(".", 1)[0] in MAY_JSON:
            continue
        for number, line in enumerate(file.read_text().splitlines(), 1):
            if re.search(r"\bJson\b|\bnlohmann\b", line.split("//")[0]):
                yield f"{file}:{number}: a measurement returns a struct; convert it to JSON in study/pages, cli or server"


def check_cycles(tree):
    """Reports strongly connected components of the include graph (Tarjan's algorithm)."""
    edges = {}
    for file in tree.files:
        edges.setdefault(tree.name(file).rsplit(".", 1)[0], set())
    for file, _, path, own in tree.includes:
        if own:
            edges[tree.name(file).rsplit(".", 1)[0]].add(path.rsplit(".", 1)[0])
    index, low, stack, cycles = {}, {}, [], []

    def visit(node):
        index[node] = low[node] = len(index)
        stack.append(node)
        for other in sorted(edges[node]):
            if other not in edges or other == node:
                continue
            if other not in index:
                visit(other)
            if other in stack:
                low[node] = min(low[node], low[other])
        if low[node] == index[node]:
            cycle = stack[stack.index(node) :]
            del stack[stack.index(node) :]
            if len(cycle) > 1:
                cycles.append(sorted(cycle))

    sys.setrecursionlimit(10000)
    for node in sorted(edges):
        if node not in index:
            visit(node)
    for cycle in cycles:
        yield f"{tree.root}: include cycle: {', '.join(cycle)}"


def check_libraries(tree):
    exposing = set()  # headers that contain types of a library
    headers = {}
    for file, number, path, own in tree.includes:
        here = tree.name(file).split("/")[0]
        if own:
            if file.suffix == ".h":
                headers.setdefault(tree.name(file), set()).add(path)
            continue
        if not SYSTEM.fullmatch(path) and not path.startswith((*HOME, *EVERYWHERE)):
            yield f"{file}:{number}: <{path}> is missing in the table of tools/check_layers.py"
        for prefix, homes in HOME.items():
            if not path.startswith(prefix):
                continue
            if here not in homes:
                yield f"{file}:{number}: <{path}> may be included only by {', '.join(sorted(homes))}"
            elif file.suffix == ".h":
                exposing.add(tree.name(file))
    added = True
    while added:
        added = {h for h, included in headers.items() if included & exposing} - exposing
        exposing |= added
    for file, number, path, own in tree.includes:
        if own and path in exposing and tree.name(file).split("/")[0] != path.split("/")[0]:
            yield f"{file}:{number}: {path} exposes types of a library and may be included only by its own folder"


def check_types(tree):
    types = {}
    for file in tree.files:
        if file.suffix != ".h":
            continue
        for number, line in enumerate(file.read_text().splitlines(), 1):
            defined = re.match(r"(?:struct|class|enum class) (\w+)[^;]*$", line)
            if defined and types.setdefault(defined[1], file) != file:
                yield f"{file}:{number}: {defined[1]} is also the name of a type in {types[defined[1]]}; rename one of them"


def local_names(text):
    """Names in the anonymous namespaces of a .cpp file: "Name" of types and constants, "name(parameter types)" of functions."""
    for body in re.findall(r"^namespace \{\n(.*?)^\}  // namespace$", text, re.S | re.M):
        for line in body.splitlines():
            if named := re.match(r"(?:struct|class|enum class) (\w+)", line):
                yield named[1]
            elif re.match(r"const(?:expr)? ", line):  # one or several constants
                yield from re.findall(r"\b(k[A-Z]\w*)\b(?=(?:\[\w*\])? *[={])", line)
            elif function := FUNCTION.match(line):
                yield function_key(function)


FUNCTION = re.compile(r"(?!return|else|if|for|using|typedef)(?:[\w:<>,*&]+ )+[*&]?(\w+)\(([^()]*)(?:\)|$)")


def function_key(match):
    """"quantile(std::vector<double>,double)" of "double quantile(std::vector<double> v, double p)"."""
    kinds = [re.sub(r"\s*\b\w+$", "", one.split("=")[0].strip()) for one in match[2].split(",") if one.strip()]
    return f"{match[1]}({','.join(kinds)})"


def check_unity(tree):
    """In a unity build, a local name of one file collides with that of another file of the same folder of src, and a local
    function can hide one that a header declares, without a warning."""
    declared = {}
    for file in tree.files:
        if file.suffix == ".h":
            for line in file.read_text().splitlines():
                if (function := FUNCTION.match(line)) and line.rstrip().endswith((";", ",")):
                    declared[function_key(function)] = file
    local = {}
    for file in tree.files:
        folder = tree.name(file).split("/")[0]
        if file.suffix != ".cpp" or folder not in UNITY or tree.name(file) in ALONE or "/kernels/" in tree.name(file):
            continue
        for name in local_names(file.read_text()):
            other = local.setdefault((folder, name), file)
            if other != file:
                yield f"{file}: {name} is also defined in {other}; rename one of them"
            if name in declared:
                yield f"{file}: {name} is also declared in {declared[name]}; rename this one"


def violations(root):
    tree = Tree(root)
    for check in (
        check_folders,
        check_includes,
        check_engine,
        check_json,
        check_cycles,
        check_libraries,
        check_types,
        check_unity,
    ):
        yield from check(tree)


if __name__ == "__main__":
    found = list(violations(pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "src")))
    print("\n".join(found) if found else "no violations")
    sys.exit(1 if found else 0)
