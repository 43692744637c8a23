#!/usr/bin/python3
"""Checks the structure of src/ (ARCHITECTURE.md has the same tables in words). Fails when

- a file includes a folder that its layer may not see, or a subfolder that its own subfolder may not see,
- a folder of study that measures makes JSON of its results itself,
- files include each other in a circle (a file is the .h and .cpp of one name),
- a third-party library is included outside its home or has none, or a header that shows a library's types leaves its folder,
- two headers give different types one name, which no compiler notices and the linker makes one of,
- two .cpp files of a folder of src have a name of their own in common, which compiling several at a time forbids,
- a folder is not in the table, or has more files directly in it than a reader can take in.

check_layers.py src    prints one line per violation and exits with 1 when there is one."""

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
    "guard": "core rig",
}
# Subfolders and the siblings that each may include; "." is the folder itself. Folders that are not here have no rule
# between their subfolders.
WITHIN = {
    "core": {".": "kernels", "kernels": ".", "h5": "."},
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
        "sinks": "loop scenario run",
        "recording": "loop scenario run sinks",
        "bench": "loop scenario run sinks recording",
    },
    "study": {
        "data": "",
        "stats": "",
        "sweep": "",
        "plot": "",
        "scale": "stats",
        "drop": "",
        "flow": "data",
        "tracks": "data stats",
        "motion": "data stats tracks",
        "steering": "data stats sweep",
        "coils": "plot",
        "identify": "data stats sweep tracks motion",
        "pages": "data stats sweep plot scale drop flow tracks motion steering coils identify",
    },
}
# Folders whose results are structs: JSON is made of them in study/pages, cli and server. Files that name it for
# another reason: activity_study reads a study file and gives its JSON Schema, field_fit writes the table of a scenario's
# part, field_library makes the keys of its file.
NO_JSON = ["study/" + folder for folder in "scale drop flow tracks motion coils".split()]
MAY_JSON = ["study/motion/activity_study", "study/coils/field_fit", "study/coils/field_library"]
# What the engine is made of includes nothing else, whatever the tables above allow (CMakeLists.txt: faba_engine).
ENGINE = (
    "core core/kernels field sim control vision/image vision/foreground vision/render rig/setup rig/simulated "
    "app/loop app/scenario app/run"
).split()
# Headers that the engine may include though it does not have their sources: interfaces of parts that come on top.
ENGINE_INTERFACES = ["rig/rig.h", "rig/camera.h", "rig/coil_driver.h", "vision/flow/flow.h"]
# The folders of src, for most a single one, that may include a third-party library.
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
    "unsupported/Eigen/": {"study"},
    "nanoflann": {"field"},
    "nlopt": {"study"},
    "zlib": {"app"},
    "boost/math": {"core"},
    "boost/geometry": {"study"},
    "boost/asio": {"server"},
    "boost/beast": {"server"},
}
EVERYWHERE = ("fmt/", "nlohmann/")
# What the engine may include of them, wherever else in its folders they have a home.
ENGINE_LIBRARIES = (*EVERYWHERE, "toml++", "Eigen/", "nanoflann", "boost/math")
# Headers of the standard library and of the operating system; all others are of third parties.
SYSTEM = re.compile(
    r"[a-z_0-9]+|sys/\w+\.h|(dlfcn|errno|fcntl|immintrin|malloc|poll|pty|sched|signal|spawn|std\w+|termios|time|unistd)\.h"
)
# Folders that are compiled several files at a time (CMakeLists.txt: FABA_UNITY).
UNITY = {"field", "sim", "control", "rig", "app", "study", "server", "cli"}
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
    """The part of vision/image/kernels/x.h that WITHIN speaks of: image; "." for a file directly in its folder."""
    parts = path.split("/")
    return parts[1] if len(parts) > 2 else "."


def check_folders(tree):
    for file in sorted(tree.root.rglob("*")):
        if file.suffix in (".hpp", ".hh", ".cc", ".cxx", ".inc", ".inl"):
            yield f"{file}: sources end in {', '.join(SOURCES)}"
    count = {}
    for file in tree.files:
        count[file.parent] = count.get(file.parent, 0) + 1
        folder = tree.name(file).split("/")[0]
        if folder not in MAY:
            yield f"{file}: the folder {folder} is not in the table of tools/check_layers.py"
        elif folder in WITHIN and subfolder(tree.name(file)) not in WITHIN[folder]:
            yield f"{file}: the subfolder {subfolder(tree.name(file))} is not in the table of tools/check_layers.py"
    for folder, files in count.items():
        if files > MOST_FILES:
            yield f"{folder}: {files} files directly in one folder, at most {MOST_FILES} are allowed"


def check_includes(tree):
    for file, number, path, own in tree.includes:
        here, name = tree.name(file).split("/")[0], tree.name(file)
        there = path.split("/")[0]
        if not own and there in MAY and "/" in path:
            yield f"{file}:{number}: {path} is a header of the project and stands in quotes"
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
                yield f"{file}:{number}: a measurement gives a struct; JSON is made of it in study/pages, cli or server"


def check_circles(tree):
    """Strongly connected files, by Tarjan's algorithm."""
    edges = {}
    for file in tree.files:
        edges.setdefault(tree.name(file).rsplit(".", 1)[0], set())
    for file, _, path, own in tree.includes:
        if own:
            edges[tree.name(file).rsplit(".", 1)[0]].add(path.rsplit(".", 1)[0])
    index, low, stack, circles = {}, {}, [], []

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
            circle = stack[stack.index(node) :]
            del stack[stack.index(node) :]
            if len(circle) > 1:
                circles.append(sorted(circle))

    sys.setrecursionlimit(10000)
    for node in sorted(edges):
        if node not in index:
            visit(node)
    for circle in circles:
        yield f"{tree.root}: an include circle: {', '.join(circle)}"


def check_libraries(tree):
    shows = set()  # headers with a library's types in them
    headers = {}
    for file, number, path, own in tree.includes:
        here = tree.name(file).split("/")[0]
        if own:
            if file.suffix == ".h":
                headers.setdefault(tree.name(file), set()).add(path)
            continue
        if not SYSTEM.fullmatch(path) and not path.startswith((*HOME, *EVERYWHERE)):
            yield f"{file}:{number}: <{path}> has no home in the table of tools/check_layers.py"
        for prefix, homes in HOME.items():
            if not path.startswith(prefix):
                continue
            if here not in homes:
                yield f"{file}:{number}: <{path}> may be included by {', '.join(sorted(homes))} only"
            elif file.suffix == ".h":
                shows.add(tree.name(file))
    grown = True
    while grown:
        grown = {h for h, included in headers.items() if included & shows} - shows
        shows |= grown
    for file, number, path, own in tree.includes:
        if own and path in shows and tree.name(file).split("/")[0] != path.split("/")[0]:
            yield f"{file}:{number}: {path} shows a library's types and may be included by its own folder only"


def check_types(tree):
    types = {}
    for file in tree.files:
        if file.suffix != ".h":
            continue
        for number, line in enumerate(file.read_text().splitlines(), 1):
            defined = re.match(r"(?:struct|class|enum class) (\w+)[^;]*$", line)
            if defined and types.setdefault(defined[1], file) != file:
                yield f"{file}:{number}: {defined[1]} is the name of another type in {types[defined[1]]}"


def own_names(text):
    """Names that a .cpp file has to itself, in its anonymous namespace: of types and constants "Name", of functions
    "name(types of parameters)"."""
    for body in re.findall(r"^namespace \{\n(.*?)^\}  // namespace$", text, re.S | re.M):
        for line in body.splitlines():
            named = re.match(r"(?:struct|class|enum class) (\w+)", line) or re.match(
                r"(?:constexpr|const) [^=(]*?\b(k[A-Z]\w*)\b", line
            )
            if named:
                yield named[1]
            elif function := FUNCTION.match(line):
                yield function_key(function)


FUNCTION = re.compile(r"(?!return|else|if|for|using|typedef)(?:[\w:<>,*&]+ )+[*&]?(\w+)\(([^()]*)(?:\)|$)")


def function_key(match):
    """"quantile(std::vector<double>,double)" of "double quantile(std::vector<double> v, double p)"."""
    kinds = [re.sub(r"\s*\b\w+$", "", one.split("=")[0].strip()) for one in match[2].split(",") if one.strip()]
    return f"{match[1]}({','.join(kinds)})"


def check_unity(tree):
    """Where several files are compiled at a time, a name of one file's own would be that of another one's in the same
    folder of src, and a function of its own could take the place of one that a header declares, without a warning."""
    declared = {}
    for file in tree.files:
        if file.suffix == ".h":
            for line in file.read_text().splitlines():
                if (function := FUNCTION.match(line)) and line.rstrip().endswith((";", ",")):
                    declared[function_key(function)] = file
    own = {}
    for file in tree.files:
        folder = tree.name(file).split("/")[0]
        if file.suffix != ".cpp" or folder not in UNITY or tree.name(file) in ALONE:
            continue
        for name in own_names(file.read_text()):
            other = own.setdefault((folder, name), file)
            if other != file:
                yield f"{file}: {name} is also a name of {other}'s own; give one of them another"
            if name in declared:
                yield f"{file}: {name} is also declared in {declared[name]}; give this one another name"


def violations(root):
    tree = Tree(root)
    for check in (
        check_folders,
        check_includes,
        check_engine,
        check_json,
        check_circles,
        check_libraries,
        check_types,
        check_unity,
    ):
        yield from check(tree)


if __name__ == "__main__":
    found = list(violations(pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "src")))
    print("\n".join(found) if found else "no violation")
    sys.exit(1 if found else 0)
