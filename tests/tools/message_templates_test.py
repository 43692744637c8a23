#!/usr/bin/python3
"""tools/message_templates.py finds the messages of small C++ sources, and reports the ones whose text it cannot know."""

import json
import pathlib
import subprocess
import sys
import tempfile

PROGRAM = pathlib.Path(__file__).parents[2] / "tools" / "message_templates.py"
# Name of the case: text of a source file, expected templates, and number of unresolved messages.
CASES = {
    "a literal in parts": ('void f() { throw Error(Errc::input, file, "is " "empty"); }', ["is empty"], 0),
    "a sum of literals and values": ('void f() { throw Error(Errc::input, file, "has " + std::to_string(n) + " frames"); }', ["has {} frames"], 0),
    "fmt::format, with formats and braces": ('void f() { throw Error(Errc::input, "a", fmt::format("{:.3g} of {{x}} in {0}", v)); }', ["{} of {x} in {}"], 0),
    "two branches": ('void f() { throw Error(Errc::input, "a", big ? "is too large" : "is too small"); }', ["is too large", "is too small"], 0),
    "a word that is chosen": ('void f() { throw Error(Errc::input, "a", fmt::format("the {} is empty", x ? "file" : "table")); }', ["the file is empty", "the table is empty"], 0),
    "a part that is chosen": ('void f() { throw Error(Errc::input, "a", fmt::format("is empty{}", x ? "; check the name" : "")); }', ["check the name", "is empty{}"], 0),
    "a count": ('void f() { throw Error(Errc::input, "a", fmt::format("has {}", counted(n, "frame"))); }', ["has {}", "{} frame", "{} frames"], 0),
    "a function that passes its argument on": (
        'void fail(const std::string& what) { throw Error(Errc::input, "a", what); }\nvoid f() { fail("is empty"); }', ["is empty"], 0),
    "a function that returns a part": (
        'std::string advice(int n) { return n ? "check the name" : ""; }\nvoid f() { throw Error(Errc::input, "a", "is empty; " + advice(1)); }',
        ["check the name", "is empty; {}"], 0),
    "a variable": ('void f() { const std::string why = "the end"; throw Error(Errc::input, "a", "stopped at " + why); }', ["stopped at {}", "the end"], 0),
    "an array": ('constexpr const char* kTexts[] = {"a study", "a scene"};\nvoid f() { throw Error(Errc::input, "a", kTexts[n]); }', ["a scene", "a study"], 0),
    "a rule of a schema": ('auto s() { return Schema<P>().check([](const P& p) -> std::string { return p.a ? "a is 0" : ""; }); }', ["a is 0"], 0),
    "a warning": ('void f(std::vector<Warning>& out) { out.push_back({"light", "the light changes", "", "use more light"}); }', ["the light changes", "use more light"], 0),
    "an answer": ('Json f() { return {{"ok", false}, {"what", "no camera is open"}}; }', ["no camera is open"], 0),
    "a comment and other texts": ('// throw Error(Errc::input, "a", "is empty");\nvoid f() { print("is empty"); }', [], 0),
    "units and options, which are not translated": ('void f() { throw Error(Errc::input, "a", fmt::format("{} px --size", v)); }', [], 0),
    "a text of a library": ('void f() { throw Error(Errc::input, "a", std::strerror(errno)); }', [], 1),
}


def printed(root, *options):
    return json.loads(subprocess.run([sys.executable, PROGRAM, "--root", root, *options], capture_output=True, text=True, check=True).stdout)


def main():
    failed = []
    for name, (source, expected, unresolved) in CASES.items():
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "src/core").mkdir(parents=True)
            (root / "src/core/a.cpp").write_text(source + "\n")
            (root / "src/cli").mkdir()
            (root / "src/cli/main.cpp").write_text('void f() { throw Error(Errc::input, "a", "only in the terminal"); }\n')
            found, unknown = printed(root), printed(root, "--unresolved")
        if sorted(found) != expected or len(unknown) != unresolved:
            failed.append(f"{name}: {found}, unresolved {unknown}; expected {expected}, unresolved {unresolved}")
    print("\n".join(failed) or f"{len(CASES)} cases passed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
