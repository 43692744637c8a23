#!/usr/bin/python3
"""tools/check_parts.py detects a planted violation of each kind and reports nothing for a correct tree."""

import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "tools"))
import check_parts  # noqa: E402

NAMES = {"disc", "box"}
check_parts.CHOSEN = {"src/app/scenario.h": {"disc"}}
check_parts.OTHER_MEANINGS = (("box", "the frame of a picture", "src/server/frame.cpp"),)

CLEAN = {
    "src/app/parts.cpp": 'add("disc"); add("box");\n',
    "src/app/scenario.h": 's.part("start", "disc");\n',
    "src/server/frame.cpp": 'j["box"] = 1;\n',
    "src/sim/disc.cpp": 'return Schema<Params>("disc", "Cells on a disc");\n',
    "src/sim/other.cpp": '// a "disc" in a comment\nuse("discs");\n',
}
# Name of the case: planted files, and words of the expected message.
PLANTED = {
    "a name in another file": ({"src/sim/other.cpp": 'if (kind == "disc") return;\n'}, 'src/sim/other.cpp:1: "disc"'),
    "a name on the page": ({"web/src/a.ts": "const it = 'box';\n"}, 'web/src/a.ts:1: "box"'),
    "a name in the file of another part": ({"src/sim/disc.cpp": CLEAN["src/sim/disc.cpp"] + 'f("box");\n'}, "disc.cpp:2"),
    "a comparison of a type": ({"src/sim/other.cpp": 'if (p.type == "x") return;\n'}, "compared with a string"),
    "a comparison of a name": ({"src/sim/other.cpp": 'if (p.name() != "x") return;\n'}, "compared with a string"),
    "a comparison of a JSON value": ({"src/sim/other.cpp": 'if (j["type"] == "x") return;\n'}, "compared with a string"),
    "a comparison from the other side": ({"src/sim/other.cpp": 'if ("x" == p.type) return;\n'}, "compared with a string"),
    "a comparison on the page": ({"web/src/a.ts": "if (p.type === 'x') return;\n"}, "compared with a string"),
    "an unused entry": ({"src/server/frame.cpp": "\n"}, 'src/server/frame.cpp no longer contains "box"'),
}


def messages(files):
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name, text in files.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text)
        return list(check_parts.misused(root, NAMES))


def main():
    wrong = [f"clean tree: {m}" for m in messages(CLEAN)]
    for what, (files, words) in PLANTED.items():
        found = messages(CLEAN | files)
        if not any(words in m for m in found):
            wrong.append(f"{what}: not detected; messages: {found}")
    print("\n".join(wrong) or f"{len(PLANTED)} planted violations detected")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
