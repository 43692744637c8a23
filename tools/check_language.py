#!/usr/bin/python3
"""Reports words that Faba does not use, with the term to use instead; fails if there are any.

    tools/check_language.py --root . [--under src/cli ...] [--count]

Faba is written in plain technical English, with the standard terms of the field and one term per concept (CONTRIBUTING.md,
"Language"). WORDS is the list of words that are not used; add every word that a reader stumbles over. The program reads
comments, messages, identifiers (`goes_on` and `kGoesOn` are read as "goes on"), pages and documentation.
"""

import argparse
import functools
import pathlib
import re
import subprocess
import sys

# Words that are not used, as regular expressions for lower-case text, and the term to use instead.
WORDS = {
    # resume, complete, truncate
    r"(go|goes|going|went|gone) on with": "resume; continue",
    r"(go|goes) on": "continue",
    r"wholly|whole": "complete; entire; all of; integer",
    r"cut back": "truncate",
    r"anew": "again; from scratch",
    r"begun|begin anew": "started",
    # coils and the guard
    r"(come|comes|came|coming|told|put|puts) to rest": "is de-energised; \"coils off\" in the user interface",
    r"coils (rest|rests|rested)": "are de-energised",
    r"signs? of life": "heartbeat",
    r"(program|client) is gone": "client disconnected",
    r"the decision took": "control cycle overran",
    r"(had|has had) (its|as much) heat": "thermal limit exceeded",
    r"sits? still|stand still|stands still|stood still": "does not move; is not running; hangs",
    # statements
    r"foretell|foretells|foretelling|foretold": "predict",
    r"said|unsaid": "given; specified; reported; stated",
    r"told": "reported; given; configured; detected",
    r"says? so": "reports it; warns",
    r"bears?": "permits; withstands",
    r"heeds?|heeded": "follows; obeys",
    r"reckons?|reckoned|reckoning": "computes; uses",
    r"foreseen|beheld|hitherto|thereof|whence|whereby": "a plain word",
    r"nothing is known of": "unknown; not documented",
    r"never (been )?tried": "not tested",
    r"on the word of": "according to; not verified",
    r"for its own sake|of its own accord": "automatically",
    r"own values?": "override; custom value",
    r"usual": "default; typical",
    r"by chance": "at random",
    r"how far apart": "distance; nearest-neighbour distance",
    # numbers
    r"shares? of": "fraction of",
    r"fingerprints?": "hash; state hash",
    r"coils turn round|field turns round|turns? round": "field reversal; is reversed",
    r"times? in air": "air exposure time",
    r"those that respond": "responsive fraction",
    r"(a|each|one|the|several|first|every) drive": "field segment",
    r"drives (were|are) found": "field segments were detected",
    # messages
    r"(?<!there )is no (?!longer|more|less|greater|larger|slower|faster|better|worse|need)": "is not a ...; unknown ...",
    r"are no (?=files|numbers|pictures|videos)": "are not ...",
    r"(?<!\.)is none(?! of the above)": "not found; must be one of",  # not the function .is_none()
    r"there is nothing here": "not found",
    r"nothing to do": "no jobs; already complete",
    r"texts? in quotes": "string",
    r"letters beyond": "non-ASCII characters",
    r"of another kind": "has the wrong type",
    r"needs a new beginning": "restart required",
    # code that speaks, knows and wants
    r"whoever|nobody": "a named subject: no process, no cell, the user",
    r"speaks? of": "describes; refers to",
    r"believes?": "assumes",
    r"wants": "requires; needs",
    r"hears?": "receives; reads",
    r"tells? (it|that|how|what|which|whether|when|where)": "reports; states; determines",
    r"gives? back|gave back|given back": "returns; recovers",
    r"turned away": "rejected",
    r"(looks|looked) at": "checks; reads; inspects",
    # quantities of a run
    r"tracking error": "cross-track error",
    r"spread of (a|the) swarm": "dispersion",
    # literary connectives
    r"sooner": "earlier; faster",
    r"the very": "exactly the; the same",
    r"so many": "this number of",
    r"to be had": "available; can be measured",
    r"what comes of": "the result of",
    r"as one (writes|would)": "typically",
    r"brings? about": "causes",
    r"makes? up for": "compensates",
    r"upon|amid|in vain": "a plain word",
    r"that is all there is|and nothing else|nothing but": "only",
    r"as it were|so to speak|to and fro": "back and forth",
    r"ere|lest|albeit|thus far|henceforth": "a plain word",
}
# Lines that may have such a word: old keys that are still read, and this list: (file, regular expression of the line).
ALLOWED = [
    ("tools/check_language.py", r""),
    ("tests/tools/check_language_test.py", r""),
    ("CHANGELOG.md", r"`(drive|foretold|foretold90|fingerprint|rested|rests|share_of_range)`"),
    ("src/study/sweep/study_directory.cpp", r'"fingerprint"'),
    ("src/study/identify/identify_study.cpp", r'"drive"'),
    # Measured with an earlier version of the scripts in bench/; the next measurement replaces these lines.
    ("bench/results/agents.md", r"unless said"),
    ("bench/results/loop.md", r"stood still"),
    ("bench/results/recovery.md", r"is said to"),
]
# The files that are checked: sources, tests, tools, pages and documentation.
PLACES = ("*.md", "docs", "src", "tests", "tools", "bench", "web/src", "web/tests", "scenes", "rigs", "studies", "firmware",
          "cmake", "*.txt", "Makefile")
KINDS = {".md", ".h", ".cpp", ".c", ".ino", ".py", ".toml", ".ts", ".mjs", ".svelte", ".sh", ".cmake", ".txt", ""}

CAMEL = re.compile(r"(?<=[a-z0-9])(?=[A-Z])")
# One word boundary for all, so that most positions of a text are rejected at once.
PATTERN = re.compile(r"\b(?:" + "|".join(rf"(?P<w{i}>(?:{word})\b)" if word[-1] != ")" else rf"(?P<w{i}>{word})"
                                         for i, word in enumerate(WORDS)) + ")")
INSTEAD = list(WORDS.values())


def plain(line):
    """The line in lower case with identifiers split into words."""
    return re.sub(r"\s+", " ", CAMEL.sub(" ", line).replace("_", " ")).lower()


@functools.lru_cache(None)
def findings(line):
    """Pairs (word, term to use instead) for each word of the line that is not used."""
    seen = {}
    line = re.sub(r"\bis None\b", "", line)  # Python
    for text in {re.sub(r"\s+", " ", line.lower()), plain(line)}:
        for m in PATTERN.finditer(text):
            seen[m.group().strip()] = INSTEAD[int(m.lastgroup[1:])]
    return seen.items()


def files(root, under):
    listed = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard", "--", *(under or PLACES)],
                            cwd=root, capture_output=True, text=True)
    if listed.returncode:  # not a repository, as in an unpacked archive
        return sorted(p for p in root.rglob("*") if p.is_file())
    return [root / name for name in listed.stdout.splitlines()]


def allowed(name, line):
    return any(name == file and re.search(pattern, line) for file, pattern in ALLOWED)


def check(root, under=()):
    """The complaints "file:line: ...", one string each."""
    complaints = []
    for path in files(root, under):
        if path.suffix not in KINDS or not path.is_file():
            continue
        name = str(path.relative_to(root))
        for number, line in enumerate(path.read_text(errors="replace").splitlines(), 1):
            if allowed(name, line):
                continue
            complaints += [f'{name}:{number}: "{word}" is not used here; write: {instead}'
                           for word, instead in findings(line)]
    return complaints


def main():
    p = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    p.add_argument("--root", type=pathlib.Path, default=pathlib.Path("."), help="folder of the project, default .")
    p.add_argument("--under", nargs="*", default=[], help="check only these files and folders")
    p.add_argument("--count", action="store_true", help="print only the number of complaints per folder")
    a = p.parse_args()
    complaints = check(a.root.resolve(), a.under)
    if a.count:
        folders = {}
        for c in complaints:
            folder = "/".join(c.split(":")[0].split("/")[:2])
            folders[folder] = folders.get(folder, 0) + 1
        print("\n".join(f"{n:5} {folder}" for folder, n in sorted(folders.items())))
    elif complaints:
        print("\n".join(complaints))
    print(f"check_language: {len(complaints)} words that are not used" if complaints else "check_language: ok",
          file=sys.stderr)
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
