#!/usr/bin/python3
"""Compares the documentation with the program; fails if they differ.

    tools/check_docs.py --program build/faba --root .

Checks:
- docs/reference/ and the table of columns in docs/formats/run-directory.md equal the output of tools/make_docs.py;
- docs/formats/cli.md has a row and a section for every verb of `faba --help`, with all its options and subcommands;
- the list of assumptions in docs/theory/README.md has every parameter whose source in docs/reference/ contains "assumed";
- every relative link in an .md file points to an existing file of the tree, and to an existing heading if it has an anchor;
- the program accepts every fenced block marked `toml scenario`, and every block marked `toml part` (an excerpt), to which
  a swarm is added if it has none;
- every command of a block marked `console checked` prints the text of the page; `...` matches any text;
- every option in a `$ build/faba VERB ...` line exists, and every scene and coil system in it exists;
- docs/formats/run-directory.md lists the columns of a series.csv;
- docs/theory/README.md lists all sections of docs/theory/ with a label, A to H, and no others;
- every label (A4, B3.4) and source tag ([S12]) cited in sources, tests, scenes, tools and pages exists in docs/theory/;
- no file of src/ has more than 400 lines.
"""

import argparse
import pathlib
import re
import subprocess
import sys
import tempfile

import make_docs
import python_verbs

MOST_LINES = 400
SKIPPED = {"build", "runs", ".git", "node_modules"}
FLOW_OPTIONS = "[FLOW OPTIONS]"  # on a page: the options of `faba flow`
EVERYWHERE = {"--help", "--json", "--quiet", "--force"}  # options that docs/formats/cli.md explains once for all verbs
# Where labels of the theory are cited, in files of these kinds.
CITING = ("src", "tests", "docs", "bench", "scenes", "rigs", "studies", "firmware", "tools", "web/src", "*.md")
CITING_KINDS = {".h", ".cpp", ".c", ".py", ".toml", ".md", ".ts", ".svelte"}
# Not labels: a byte of JPEG, the C standard.
NOT_A_LABEL = {"D9", "C99", "F9"}  # F9 is a key
PLANTS = "tests/tools/"  # contains wrong citations on purpose, for the test of this program


class Checks:
    def __init__(self, program, root):
        self.program, self.root, self.failures = program, root, []
        self.pages = sorted(p for p in root.rglob("*.md") if not SKIPPED & set(p.relative_to(root).parts))
        self.text = {p: p.read_text() for p in self.pages}

    def fail(self, place, what):
        if isinstance(place, pathlib.Path):
            place = place.relative_to(self.root)
        self.failures.append(f"{place}: {what}")

    def faba(self, *arguments, cwd):
        return subprocess.run([str(self.program), *arguments], capture_output=True, text=True, cwd=cwd)

    # --- generated pages -------------------------------------------------------------------------------------------

    def reference(self):
        folder = self.root / "docs/reference"
        wanted = make_docs.pages(self.program, self.root)
        for name in sorted(set(wanted) | {p.name for p in folder.glob("*.md")} - make_docs.BY_OTHERS):
            page = folder / name
            if not page.exists() or wanted.get(name) != page.read_text():
                self.fail(page, "differs from the descriptions in the program; run: tools/make_docs.py")
        page = self.root / make_docs.COLUMNS_PAGE
        if page in self.text and make_docs.with_columns(self.program, self.text[page]) != self.text[page]:
            self.fail(page, "the table of columns differs from the descriptions in the program; run: tools/make_docs.py")
        for file, text in python_verbs.files(self.program).items():
            functions = self.root / file
            if functions.parent.exists() and (not functions.exists() or functions.read_text() != text):
                self.fail(functions, "differs from the verbs of the program; run: tools/make_docs.py")

    def verbs(self, folder):
        page = self.root / "docs/formats/cli.md"
        table = re.search(r"^\| verb \|.*?\n\n", self.text.get(page, ""), re.M | re.S)
        listed = re.findall(r"^\| \[`([\w-]+)`\]", table[0] if table else "", re.M)
        existing = re.findall(r"^  ([a-z][\w-]*)", self.faba("--help", cwd=folder).stdout.split("\nCommands:\n")[1], re.M)
        if listed != existing:
            self.fail(page, f"the program has the verbs {', '.join(existing)}; the page lists {', '.join(listed)}")
        sections = dict(re.findall(r"^## faba ([\w-]+)\n(.*?)(?=^## |\Z)", self.text.get(page, ""), re.M | re.S))
        for verb in existing:
            text = sections.get(verb, "")
            if FLOW_OPTIONS in text:
                text += sections.get("flow", "")
            for word in sorted(self.options_of(verb, folder)):
                if not re.search(rf"(?<![\w-]){re.escape(word)}(?![\w-])", text):
                    self.fail(page, f"the section of faba {verb} does not describe {word}")

    def options_of(self, verb, folder):
        """The options of the verb, its subcommands and their options, without those in EVERYWHERE."""
        text = self.faba(*verb.split(), "--help", cwd=folder).stdout
        subcommands = re.findall(r"^  ([a-z][\w-]*)", text.partition("\nCommands:\n")[2], re.M)
        found = set(re.findall(r"^  (?:-\w,)?(--[\w-]+)", text, re.M)) - EVERYWHERE
        return found.union(subcommands, *(self.options_of(f"{verb} {name}", folder) for name in subcommands))

    def assumptions(self):
        page = self.root / "docs/theory/README.md"
        listed = re.search(r"^## What is assumed\n(.*?)(?=^## |\Z)", self.text.get(page, ""), re.M | re.S)
        for reference in sorted((self.root / "docs/reference").glob("*.md")):
            for key, source in re.findall(r"^\| `(\w+)` \|.*\| ([^|]*) \|$", self.text[reference], re.M):
                if re.search(r"\bassumed\b", source) and not (listed and f"`{key}`" in listed[1]):
                    self.fail(page, f"the list of assumptions lacks `{key}` of docs/reference/{reference.name}")

    # --- links -----------------------------------------------------------------------------------------------------

    def headings(self, page):
        """Anchors that GitHub generates from the headings outside code blocks."""
        found = set()
        for line in without_code(self.text[page]).splitlines():
            if not (m := re.match(r"#{1,6}\s+(.*?)\s*#*$", line)):
                continue
            title = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", m[1]).lower()
            slug = re.sub(r"[^\w\- ]", "", title).replace(" ", "-")
            number, name = 0, slug
            while name in found:
                number += 1
                name = f"{slug}-{number}"
            found.add(name)
        return found

    def links(self):
        for page, text in self.text.items():
            for number, line in enumerate(without_code(text, keep_lines=True).splitlines(), 1):
                for target in re.findall(r"\]\(<?([^)>\s]+)>?\)", line):
                    if re.match(r"[a-z]+:", target):
                        continue
                    name, _, anchor = target.partition("#")
                    file = (page.parent / name).resolve() if name else page
                    place = f"{page.relative_to(self.root)}:{number}"
                    if not file.is_relative_to(self.root):
                        self.fail(place, f"link {target}: outside the project")
                    elif not file.exists():
                        self.fail(place, f"link {target}: file not found")
                    elif anchor and (file not in self.text or anchor not in self.headings(file)):
                        self.fail(place, f"link {target}: heading not found")

    # --- examples --------------------------------------------------------------------------------------------------

    def blocks(self, info):
        for page, text in self.text.items():
            for m in re.finditer(r"^```" + re.escape(info) + r"\n(.*?)^```", text, re.M | re.S):
                yield f"{page.relative_to(self.root)}:{text.count(chr(10), 0, m.start()) + 1}", m[1]

    def scenarios(self, folder):
        """Runs each block for one frame. `--duration` overrides the duration of the block, so its value is checked as an exposure."""
        (pathlib.Path(folder) / "rigs").symlink_to(self.root / "rigs")
        for info in ("toml scenario", "toml part"):
            for place, block in self.blocks(info):
                scene = pathlib.Path(folder) / "block.toml"
                scene.write_text(block + ("" if "[[swarm]]" in block else "\n[[swarm]]\ncount = 20\n"))
                duration = re.search(r"^duration\s*=\s*(.+?)\s*(#.*)?$", block, re.M)
                for more in [[]] + ([["--set", f"exposure={duration[1]}"]] if duration else []):
                    r = self.faba("run", "block.toml", "--duration", "0 s", "--seed", "1", "--out", "out", "--force",
                                  "--quiet", "--set", "record.video=false", "--set", "record.tracks=false", *more,
                                  cwd=folder)
                    if r.returncode != 0:
                        self.fail(place, f"the program refuses this scenario: {r.stderr.strip()}")
                        break

    def outputs(self, folder):
        """Runs the blocks of a page in order in one folder."""
        for page in self.pages:
            work = pathlib.Path(folder) / f"outputs-{page.stem}"
            for m in re.finditer(r"^```console checked\n(.*?)^```", self.text[page], re.M | re.S):
                if not work.exists():
                    work.mkdir()
                    (work / "scenes").symlink_to(self.root / "scenes")
                    (work / "rigs").symlink_to(self.root / "rigs")
                    (work / "build").mkdir()
                    (work / "build/faba").symlink_to(self.program)
                place = f"{page.relative_to(self.root)}:{self.text[page].count(chr(10), 0, m.start()) + 1}"
                for command, expected in shell_session(m[1]):
                    r = subprocess.run(["bash", "-c", command], capture_output=True, text=True, cwd=work)
                    pattern = ".*".join(re.escape(piece) for piece in expected.split("..."))
                    if r.returncode != 0 or not re.fullmatch(pattern, r.stdout.replace("\u00a0", " ")):
                        self.fail(place, f"{command!r} now prints:\n{r.stdout}{r.stderr}")

    def commands(self, folder):
        helps = {}
        for page, text in self.text.items():
            for number, line in enumerate(text.splitlines(), 1):
                m = re.match(r"\s*\$ build/faba ((?:field|rig) [\w-]+|\w[\w-]*)(.*)", line)
                if not m:
                    continue
                verb, rest = m[1], re.sub(r"'[^']*'|\"[^\"]*\"", "''", m[2])
                place = f"{page.relative_to(self.root)}:{number}"
                if verb not in helps:
                    r = self.faba(*verb.split(), "--help", cwd=folder)
                    helps[verb] = r.stdout if r.returncode == 0 else None
                if helps[verb] is None:
                    self.fail(place, f'unknown verb "{verb}"')
                    continue
                for option in re.findall(r"(?<!\S)--[\w-]+", rest):
                    if not re.search(re.escape(option) + r"\b", helps[verb]):
                        self.fail(place, f'unknown option "{option}" of faba {verb}')
                for scene in re.findall(r"(?<!\S)(?:scenes|rigs)/\S+\.toml", rest):
                    if not (self.root / scene).exists():
                        self.fail(place, f"file not found: {scene}")

    def columns(self, folder):
        page = self.root / "docs/formats/run-directory.md"
        section = re.search(r"^## series\.csv\n(.*?)^## ", self.text.get(page, ""), re.M | re.S)
        listed = re.findall(r"^\| `(\w+)` \|", section[1] if section else "", re.M)
        scene = pathlib.Path(folder) / "columns.toml"
        scene.write_text("[[swarm]]\ncount = 2\n")
        self.faba("run", "columns.toml", "--duration", "0 s", "--seed", "1", "--out", "columns", "--quiet", cwd=folder)
        header = (pathlib.Path(folder) / "columns/series.csv").read_text().splitlines()[0]
        existing = list(dict.fromkeys(re.sub(r"current_\d+_a", "current_K_a", header).split(",")))
        if listed != existing:
            self.fail(page, f"series.csv has the columns {', '.join(existing)}; the page lists {', '.join(listed)}")

    # --- sources ---------------------------------------------------------------------------------------------------

    def lengths(self):
        for file in sorted((self.root / "src").rglob("*.[hc]*")):
            lines = len(file.read_text(errors="replace").splitlines())
            if lines > MOST_LINES:
                self.fail(file, f"{lines} lines; the maximum is {MOST_LINES}")

    # --- citations -------------------------------------------------------------------------------------------------

    def labels(self):
        """Label -> text of its section in the pages; compares the labels with those of the index."""
        sections = {}
        for page in sorted((self.root / "docs/theory").glob("*.md")):
            for m in re.finditer(r"^(#+) ([A-H]\d+)\b(.*?)(?=^#{1,3} |\Z)", self.text[page], re.M | re.S):
                sections[m[2]] = m[3]
        index = set(make_docs.theory_labels(self.root))
        for label in sorted(index ^ set(sections)):
            page = self.root / "docs/theory/README.md"
            self.fail(page, f"lists {label}, but no page has this section" if label in index else f"does not list {label}")
        return sections

    def citing(self):
        for place in CITING:
            for top in sorted(self.root.glob(place)):
                for file in [top] if top.is_file() else sorted(top.rglob("*")):
                    if file.suffix in CITING_KINDS and not SKIPPED & set(file.relative_to(self.root).parts):
                        yield file

    def citations(self):
        sections = self.labels()
        tags = (self.root / "docs/theory/sources.md").read_text()
        for file in self.citing():
            name = str(file.relative_to(self.root))
            if name.startswith(PLANTS):
                continue
            for number, line in enumerate(file.read_text(errors="replace").splitlines(), 1):
                place = f"{name}:{number}"
                cited = re.findall(r"(?:(?<=theory )([A-Z]\d{1,2})|(?<![\w#])([A-H]\d{1,2}))(?!\w)(?:\.(\d+)\b)?", line)
                for named, label, item in cited:
                    label = named or label
                    if label in NOT_A_LABEL:
                        continue
                    if label not in sections:
                        self.fail(place, f"cites {label}, which is missing in docs/theory/")
                    elif item and not re.search(rf"^{item}\. ", sections[label], re.M):
                        self.fail(place, f"cites {label}.{item}, which is missing in section {label} of docs/theory/")
                for tag in re.findall(r"\[(S\d{1,2})\]", line):
                    if not re.search(rf"\b{tag}\b", tags):
                        self.fail(place, f"cites [{tag}], which is missing in docs/theory/sources.md")


def without_code(text, keep_lines=False):
    """The text without fenced blocks and inline code."""
    blank = (lambda m: "\n" * m[0].count("\n")) if keep_lines else ""
    text = re.sub(r"^```.*?^```", blank, text, flags=re.M | re.S)
    return re.sub(r"`[^`\n]*`", lambda m: "x" if keep_lines else m[0].strip("`"), text)


def shell_session(block):
    """Pairs (command, expected output). A command starts with `$ ` and can have several lines."""
    command, expected, pairs = "", "", []
    for line in block.splitlines(keepends=True):
        if line.startswith("$ "):
            pairs += [(command, expected)] if command else []
            command, expected = line[2:], ""
        elif unfinished(command):
            command += line
        else:
            expected += line
    return pairs + [(command, expected)]


def unfinished(command):
    r = subprocess.run(["bash", "-n", "-c", command], capture_output=True, text=True)
    return r.returncode != 0 or "here-document" in r.stderr or command.endswith("\\\n")


def main():
    cli = argparse.ArgumentParser(description="Compare the documentation with the program; fail if they differ.")
    cli.add_argument("--program", default="build/faba", help="the program, default build/faba")
    cli.add_argument("--root", default=".", type=pathlib.Path, help="folder of the project, default .")
    options = cli.parse_args()
    program, root = pathlib.Path(options.program).resolve(), options.root.resolve()
    if not program.exists():
        sys.exit(f"check_docs: program not found: {program}; build it or give its path with --program")
    checks = Checks(program, root)
    with tempfile.TemporaryDirectory() as folder:
        checks.reference()
        checks.links()
        checks.scenarios(folder)
        checks.outputs(folder)
        checks.commands(folder)
        checks.columns(folder)
        checks.verbs(folder)
        checks.lengths()
        checks.assumptions()
        checks.citations()
    for failure in checks.failures:
        print(failure)
    print(f"check_docs: {len(checks.pages)} pages, {len(checks.failures)} failures")
    return 1 if checks.failures else 0


if __name__ == "__main__":
    sys.exit(main())
