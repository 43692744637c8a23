#!/usr/bin/python3
"""tools/check_docs.py detects planted wrong citations and a missing assumption, and reports nothing for a correct tree."""

import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "tools"))
import check_docs  # noqa: E402

LETTERS = "ABCDEFGH"
CLEAN = {
    "docs/theory/README.md": "".join(f"| {x}1 | [Name](page.md#{x.lower()}1-name) |\n" for x in LETTERS)
    + "\n## What is assumed\n\n| `depth` | 3 |\n\n## Tests\n\n`other`\n",
    "docs/reference/model.md": "| `depth` | 3 | px | How deep | assumed |\n| `speed` | 3 | px | Speed that is assumed | (A1) |\n",
    "docs/theory/page.md": "".join(f"## {x}1 Name\n\n1. A law.\n2. Another one.\n\n" for x in LETTERS),
    "docs/theory/sources.md": "| S3 | A paper |\n",
    "src/sim/a.cpp": "// theory A1, B1.2 and C1-D1 [S3]; vectors F[1], B_0, 0xA7, #B3261E\n",
    "scenes/a.toml": "speed = 1  # (H1)\n",
}
# Name of the case: planted files, and words of the expected message.
PLANTED = {f"an unknown section of {x}": ({"src/sim/a.cpp": f"// as in ({x}8)\n"}, f"a.cpp:1: cites {x}8") for x in LETTERS} | {
    "an unknown letter": ({"src/sim/a.cpp": "// theory J1\n"}, "cites J1"),
    "the second label of a list": ({"tests/a.cpp": "// theory A1, H9\n"}, "tests/a.cpp:1: cites H9"),
    "the end of a range": ({"tests/a.cpp": "// theory B1-B4\n"}, "cites B4"),
    "an unknown item": ({"tests/a.cpp": "// theory B1.3\n"}, "cites B1.3"),
    "the source of a parameter": ({"src/sim/a.cpp": '.source = "H7"\n'}, "cites H7"),
    "in a page": ({"docs/guide/a.md": "See C4.\n"}, "docs/guide/a.md:1: cites C4"),
    "in a scene": ({"scenes/a.toml": "# D5\n"}, "scenes/a.toml:1: cites D5"),
    "a source that is not listed": ({"src/sim/a.cpp": "// [S4]\n"}, "cites [S4]"),
    "a section missing in the index": ({"docs/theory/page.md": CLEAN["docs/theory/page.md"] + "## H2 New\n"}, "does not list H2"),
    "an assumption that is not listed": ({"docs/reference/start.md": "| `other` | 3 | px | Width | assumed (A1) |\n"}, "lacks `other`"),
    "a section that only the index has": (
        {"docs/theory/page.md": "## A1 Name\n\n1. A law.\n2. Another one.\n"},
        "lists H1, but no page has this section",
    ),
}


def messages(files):
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder).resolve()
        for name, text in files.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text)
        checks = check_docs.Checks(None, root)
        checks.citations()
        checks.assumptions()
        return checks.failures


def main():
    wrong = [f"a clean tree: {m}" for m in messages(CLEAN)]
    for what, (files, words) in PLANTED.items():
        found = messages(CLEAN | files)
        if not any(words in m for m in found):
            wrong.append(f"{what}: no message has {words!r}: {found}")
    print("\n".join(wrong) or f"{len(PLANTED)} planted errors detected")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
