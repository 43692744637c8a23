#!/usr/bin/python3
"""tools/check_layers.py detects a planted violation of each kind and reports nothing for a correct tree."""

import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "tools"))
import check_layers  # noqa: E402

CLEAN = {
    "core/vec.h": "struct Vec {\n};\n",
    "vision/image/image.h": '#include "core/vec.h"\n',
    "vision/files/picture.cpp": '#include "vision/image/image.h"\n#include <libavutil/frame.h>\n',
    "app/scenario/scenario.cpp": '#include "core/vec.h"\n#include "rig/camera.h"\n',
    "rig/camera.h": "",
}
# Name of the case: planted files, and words of the expected line.
PLANTED = {
    "a folder of a higher layer": ({"core/a.cpp": '#include "field/b.h"\n'}, "core must not include field"),
    "a folder of the same layer": ({"sim/a.cpp": '#include "control/b.h"\n'}, "sim must not include control"),
    "a sibling subfolder": (
        {"vision/image/a.cpp": '#include "vision/files/b.h"\n'},
        "vision/image must not include vision/files",
    ),
    "HDF5 in the engine": ({"field/a.cpp": '#include "core/h5/h5.h"\n'}, "part of the engine and must not include"),
    "videos in the engine": (
        {"control/a.cpp": '#include "vision/cells/tracker.h"\n'},
        "part of the engine and must not include",
    ),
    "a library in the engine": (
        {"vision/image/a.cpp": "#include <opencv2/core.hpp>\n"},
        "part of the engine and must not include <opencv2/core.hpp>",
    ),
    "a header of the project in angle brackets": ({"sim/a.cpp": "#include <control/b.h>\n"}, "include it in quotes"),
    "an include without a space": ({"sim/a.cpp": '#include"control/b.h"\n'}, "sim must not include control"),
    "an unknown file suffix": ({"core/a.hpp": ""}, "unknown suffix"),
    "a measurement that returns JSON": (
        {"study/drop/a.h": "nlohmann::ordered_json measure();\n"},
        "a measurement returns a struct",
    ),
    "a cycle of two": (
        {"core/a.h": "", "core/a.cpp": '#include "core/b.h"\n', "core/b.h": '#include "core/a.h"\n'},
        "include cycle: core/a, core/b",
    ),
    "a cycle of three": (
        {f"core/{a}.h": f'#include "core/{b}.h"\n' for a, b in ("xy", "yz", "zx")},
        "include cycle: core/x, core/y, core/z",
    ),
    "a library in a folder that may not include it": ({"study/a.cpp": "#include <opencv2/core.hpp>\n"}, "may be included only by"),
    "an unknown library": ({"study/a.cpp": "#include <spdlog/spdlog.h>\n"}, "<spdlog/spdlog.h> is missing in the table"),
    "a library's types in another folder": (
        {"server/a.h": "#include <boost/asio/ip/tcp.hpp>\n", "cli/b.cpp": '#include "server/a.h"\n'},
        "exposes types of a library",
    ),
    "two types with the same name": ({"vision/drop/a.h": "struct Vec {\n};\n"}, "is also the name of a type in"),
    "two local types with the same name": (
        {f"study/plot/{n}.cpp": "namespace {\nstruct Mine {\n};\n}  // namespace\n" for n in "ab"},
        "is also defined in",
    ),
    "two local constants with the same name, the second of their lists": (
        {f"study/plot/{n}.cpp": f"namespace {{\nconst int k{n.upper()}{{1}}, kMine{{2}};\n}}  // namespace\n" for n in "ab"},
        "kMine is also defined in",
    ),
    "a function that a header declares": (
        {
            "study/stats/a.h": "double quantile(std::vector<double> values, double p);\n",
            "study/plot/b.cpp": "namespace {\ndouble quantile(std::vector<double> v, double q) {\n}\n}  // namespace\n",
        },
        "is also declared in",
    ),
    "an unknown folder": ({"utils/a.cpp": ""}, "is missing in the table"),
    "an unknown subfolder": ({"vision/misc/a.cpp": ""}, "is missing in the table"),
    "a folder with too many files": ({f"core/f{i}.cpp": "" for i in range(41)}, "files directly in this folder"),
}


def found_in(files):
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name, text in files.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text)
        return list(check_layers.violations(root))


wrong = [f"a clean tree: {v}" for v in found_in(CLEAN)]
for what, (files, words) in PLANTED.items():
    lines = found_in(CLEAN | files)
    if not any(words in line for line in lines):
        wrong.append(f"{what}: not detected; lines: {lines}")
print("\n".join(wrong) or f"{len(PLANTED)} planted violations detected")
sys.exit(1 if wrong else 0)
