#!/usr/bin/python3
"""Writes the documentation as HTML that needs no network and no server, by pandoc.

    packaging/html_pages.py ROOT OUT

Pages of docs/ keep their folders; documents of the source tree that they link to are in OUT/project. Links to source files, which are not part
of an installation, become text. Formulas are MathML. Fails if a page links to a page or a picture that does not exist.
"""

import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

PROJECT_PAGES = ("README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "CHANGELOG.md", "web/protocol.md")
PICTURES = {".svg", ".png", ".jpg", ".gif"}
# Their commands are those of the source folder; other pages call the installed program.
SOURCE_PAGES = {"install.md", "arm64.md", "add-a-model.md", "add-a-controller.md", "add-an-estimator.md", "add-a-coil.md", "add-a-verb.md"}
COPIED = PICTURES | {".html", ".bib", ".csv"}

TEMPLATE = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>$pagetitle$</title>
<link rel="stylesheet" href="$root$style.css">
</head>
<body>
<nav><a href="$root$index.html">Faba documentation</a>: run the commands of these pages in a folder that <code>faba init</code> has made. Commands with <code>make</code> need the source of Faba.</nav>
<main>
$body$
</main>
</body>
</html>
"""

STYLE = """:root { color-scheme: light dark; --link: #0a58b5; --line: #8886; --code: #8881; }
@media (prefers-color-scheme: dark) { :root { --link: #8ab8ff; } }
body { font: 16px/1.55 system-ui, sans-serif; margin: 0 auto; max-width: 60rem; padding: 0 1rem 4rem; }
nav { border-bottom: 1px solid var(--line); padding: .8rem 0; }
a { color: var(--link); }
code, pre { background: var(--code); border-radius: 4px; font: .92em/1.45 ui-monospace, monospace; }
code { padding: .1em .25em; }
pre { overflow-x: auto; padding: .7rem .9rem; }
pre code { background: none; padding: 0; }
table { border-collapse: collapse; display: block; margin: 1rem 0; overflow-x: auto; }
th, td { border: 1px solid var(--line); padding: .3rem .6rem; text-align: left; vertical-align: top; }
img { max-width: 100%; }
math[display="block"] { margin: .8rem 0; overflow-x: auto; }
"""


def target_of(page):
    """Where a document of the source tree is in the documentation."""
    if page.parts[0] == "docs":
        inside = pathlib.Path(*page.parts[1:])
        return (inside.parent / ("index" if inside.name == "README.md" else inside.stem)).with_suffix(".html") if page.suffix == ".md" else inside
    return pathlib.Path("project") / page.with_suffix(".html").name


def github_math(text):
    """Formulas of GitHub's Markdown as those of pandoc."""
    text = re.sub(r"```math\n(.*?)```", lambda m: f"$$\n{m[1]}$$", text, flags=re.S)
    return re.sub(r"\$`(.+?)`\$", lambda m: f"${m[1].strip()}$", text, flags=re.S)


class Documentation:
    def __init__(self, root, out):
        self.root, self.out = root, out
        self.pages = sorted([p.relative_to(root) for p in (root / "docs").rglob("*.md")] + [pathlib.Path(p) for p in PROJECT_PAGES])
        self.files = sorted(p.relative_to(root) for p in (root / "docs").rglob("*") if p.suffix in COPIED)
        self.problems = []

    def link(self, page, target):
        """The link of a page as it is in the documentation, or None if its target is not a part of it."""
        if re.match(r"[a-z]+:|#", target):
            return target
        path, hash_, anchor = target.partition("#")
        goal = pathlib.Path(os.path.normpath(page.parent / path))
        if goal in self.pages or goal in self.files:
            here = target_of(page).parent
            return os.path.relpath(target_of(goal), here) + hash_ + anchor
        if not (self.root / goal).exists():
            self.problems.append(f"{page}: {target} does not exist")
        return None

    def of_installed(self, page):
        """The text of a page, with the installed program instead of that of the source folder."""
        text = (self.root / page).read_text()
        if page.parts[0] != "docs" or page.name in SOURCE_PAGES:
            return text
        return re.sub(r"(?<![\w/.])(\.\./|\./)?build/faba(?![\w-])", "faba", text)

    def with_links(self, page, text):
        def replaced(match):
            target = self.link(page, match[3])
            return f"{match[1]}[{match[2]}]({target})" if target else match[2]
        # Links may have code as their text, so that they are replaced in the text outside fenced blocks.
        parts = re.split(r"(```.*?```)", text, flags=re.S)
        return "".join(part if i % 2 else re.sub(r"(!?)\[((?:[^\[\]]|\[[^\[\]]*\])*)\]\(([^()\s]+)\)", replaced, part) for i, part in enumerate(parts))

    def write(self, page):
        text = github_math(self.with_links(page, self.of_installed(page)))
        title = next((line[2:] for line in text.split("\n") if line.startswith("# ")), page.stem)
        target = self.out / target_of(page)
        target.parent.mkdir(parents=True, exist_ok=True)
        up = os.path.relpath(self.out, target.parent)
        done = subprocess.run(["pandoc", "--from=gfm+tex_math_dollars", "--to=html5", "--mathml", f"--template={self.out / 'template.html'}",
                               "--metadata", f"pagetitle={title}", "--variable", f"root={'' if up == '.' else up + '/'}", "--output", str(target)],
                              input=text, text=True, capture_output=True)
        if done.returncode or done.stderr:
            self.problems.append(f"{page}: {done.stderr.strip()}")

    def build(self):
        self.out.mkdir(parents=True, exist_ok=True)
        (self.out / "style.css").write_text(STYLE)
        (self.out / "template.html").write_text(TEMPLATE)
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            list(pool.map(self.write, self.pages))
        (self.out / "template.html").unlink()
        for file in self.files:
            target = self.out / target_of(file)
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(self.root / file, target)
        return self.problems


def main():
    cli = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    cli.add_argument("root", type=pathlib.Path)
    cli.add_argument("out", type=pathlib.Path)
    o = cli.parse_args()
    problems = Documentation(o.root.resolve(), o.out.resolve()).build()
    for problem in problems:
        print(problem, file=sys.stderr)
    sys.exit(1 if problems else 0)


if __name__ == "__main__":
    main()
