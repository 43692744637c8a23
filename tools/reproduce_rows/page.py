"""The page: a table of all results with their verdicts, then one section per result. One file without scripts and network access."""

import collections
import html
import re

from reproduce_rows.check import CORRECTED, DIFFERS, LATER, PENDING, SAME, VIDEOS, shown, verdict

ENDS = 2  # of a long list of commands, this many at the start and at the end are not folded
STYLE = """
.badge{display:inline-block;border-radius:1rem;padding:.05rem .65rem;font-size:.82rem;font-weight:600;white-space:nowrap;
color:#fff;text-decoration:none}
.same{background:#00785a}.corrected{background:#0068a3}.videos{background:#7a5c00}.pending{background:#5c6670}
.differs{background:#b3261e}
.index td,.index th{font-size:.92rem;line-height:1.35}
.index td:first-child{min-width:6.2rem}
.wide .faba-plot,.wide img{max-width:44rem}
.cards .badge{margin-bottom:.3rem;color:#fff}
section{margin-top:2.6rem}
section h2{display:flex;gap:.8rem;align-items:baseline;justify-content:space-between;margin-top:0}
img{display:block;width:100%;height:auto;border-radius:.3rem;background:#fff}
.figures{margin-top:1.2rem}.figures .wide,.figures .frames{grid-column:1/-1}
.checks td:last-child{width:4.5rem}
.checks small{display:block;color:var(--muted);font-size:.82rem;line-height:1.35}
.fails{color:#b3261e;font-weight:600}
pre{white-space:pre-wrap;overflow-wrap:anywhere}
@media screen and (prefers-color-scheme:dark){.own .grid{stroke:#363d44}.own .box{fill:#1f2429}.fails{color:#ff8a80}
.own .s-blue{stroke:#56b4e9}.own .f-blue{fill:#56b4e9}.own .s-vermillion{stroke:#e69f00}.own .f-vermillion{fill:#e69f00}
.own .s-muted{stroke:#a4adb6}.own .f-muted{fill:#a4adb6}.own .f-text{fill:#e6e9ec}.own .box.s-blue{fill:#1f2429}}
@media screen and (max-width:720px){.index .there{display:none}}
"""
CLASS = {SAME: "same", CORRECTED: "corrected", VIDEOS: "videos", LATER: "videos", PENDING: "pending", DIFFERS: "differs"}
WORDS = {
    SAME: "agrees with the thesis",
    CORRECTED: "the thesis has an error here; the reason is given",
    VIDEOS: "shown on rendered experiments with known parameters",
    LATER: "not in the thesis, on one of its experiments",
    PENDING: "not yet part of the program",
    DIFFERS: "outside the accepted range, or not computed",
}


def anchor(item):
    return re.sub(r"[^a-z0-9]+", "-", item.lower()).strip("-")


def text(words):
    """Escaped text; `words` in backticks become <code>, and a hyphen before a number becomes a minus sign."""
    parts = html.escape(words, quote=False).split("`")
    return "".join(f"<code>{w}</code>" if i % 2 else re.sub(r"(?<![\w.)])-(?=\d)", "\u2212", w) for i, w in enumerate(parts))


def badge(result):
    return f'<span class="badge {CLASS[result]}">{result}</span>'


def count(results):
    return collections.Counter(verdict(row.verdict, found) for row, found in results)


def summary(counts):
    return ", ".join(f"{counts[v]} {v}" for v in (SAME, CORRECTED, VIDEOS, LATER, PENDING, DIFFERS) if counts[v])


def _fact(name, content):
    return f'<tr><th scope="row">{name}</th><td>{content}</td></tr>\n' if content else ""


def _commands(row, found):
    if not found.commands:
        return f'<pre>tools/reproduce.py --only "{html.escape(row.item, quote=False)}"</pre>'
    lines = [html.escape(c, quote=False) for c in found.commands]
    first, last = (lines[:ENDS], lines[-ENDS:]) if len(lines) > 2 * ENDS else (lines, [])
    out = f"<pre>{chr(10).join(first)}</pre>"
    if last:  # a long list: similar commands, then those that evaluate their results
        between = lines[ENDS:-ENDS]
        out += f"<details><summary>{len(between)} more</summary><pre>{chr(10).join(between)}</pre></details>"
        out += f"<pre>{chr(10).join(last)}</pre>"
    for name, content in found.files:
        out += f"<details><summary>{html.escape(name)}</summary><pre>{html.escape(content, quote=False)}</pre></details>"
    return out


def _checks(found):
    if not found.checks:
        return ""
    rows = ""
    for c in found.checks:
        value = shown(c.value)
        unit = f" {html.escape(c.unit)}" if c.unit and not isinstance(c.value, bool) else ""
        mark = "pass" if c.ok else '<span class="fails">fail</span>'
        rows += (
            f"<tr><td>{text(c.what)}<small>{text(c.why)}</small></td><td>{value}{unit}</td>"
            f"<td>{html.escape(c.accepted())}</td><td>{mark}</td></tr>\n"
        )
    return (
        '<table class="checks"><thead><tr><th>check</th><th>value</th><th>accepted</th><th></th></tr></thead>\n'
        f"<tbody>{rows}</tbody></table>\n"
    )


def section(row, found):
    result = verdict(row.verdict, found)
    words = text(row.reason)
    if found.failed:
        words = f'<span class="fails">Computation failed:</span> {html.escape(found.failed)}'
    elif result == DIFFERS:
        failed = [c.what for c in found.checks if not c.ok]
        words = '<span class="fails">A check fails:</span> ' + text("; ".join(failed) if failed else "there are no checks") + ". " + words
    facts = (
        _fact("In the thesis", text(row.thesis))
        + _fact("Here", text(found.value))
        + _fact("Assumptions", text(found.chosen))
        + _fact("Computed without the program", text(found.beside))
        + _fact("Commands", _commands(row, found))
        + _fact("Verdict", f"{badge(result)} {words}")
    )
    notes = "".join(f'<p class="details">{text(n)}</p>\n' for n in found.note)
    figures = f'<div class="figures">\n{"".join(found.pictures)}</div>\n' if found.pictures else ""
    return (
        f'<section id="{anchor(row.item)}">\n<h2><span>{html.escape(row.item)}. {text(row.shows)}</span>{badge(result)}</h2>\n'
        f'<table class="facts"><tbody>{facts}</tbody></table>\n{notes}{_checks(found)}{figures}</section>\n'
    )


def extent(results, of):
    """A sentence with the number of results on the page and the number of each verdict."""
    counts = count(results)
    many = f"All {of}" if len(results) == of else f"{len(results)} of the {of}"
    groups = (
        (counts[SAME] + counts[CORRECTED], "reproduced, with every value in its accepted range"),
        (counts[VIDEOS], "shown by the same procedure on rendered experiments, because the videos of the thesis are not public"),
        (counts[LATER], "on an experiment of the thesis, with parts that it does not have"),
        (counts[PENDING], "not computed yet"),
        (counts[DIFFERS], "outside the accepted range, or not computed"),
    )
    return f"{many} results of the 2016 thesis that software can reproduce: " + "; ".join(f"{n} {words}" for n, words in groups if n) + "."


def calls_the_program(found):
    return any(c.startswith("build/faba ") for c in found.commands)


def origin(results, version):
    """A sentence about the source of the values on the page."""
    runs = sum(calls_the_program(found) for _, found in results)
    beside = [row.item for row, found in results if not calls_the_program(found)]
    return (
        f"{runs} of the {len(results)} results on this page come from runs of {html.escape(version)}"
        + (f"; computed without it: {html.escape(', '.join(beside))}" if beside else "")
        + ". <code>tools/reproduce_rows</code> computes means, confidence intervals and reference values from them; a result for which it"
        " computes more has an entry “Computed without the program”."
    )


def page(results, of, style, version):
    counts = count(results)
    differing = [row.item for row, found in results if verdict(row.verdict, found) == DIFFERS]
    cards = "".join(
        f"<div><dt>{badge(v)}</dt><dd><b>{counts[v]}</b><span>{WORDS[v]}</span></dd></div>\n"
        for v in (SAME, CORRECTED, VIDEOS, LATER, PENDING, DIFFERS)
        if counts[v]
    )
    warning = (
        (
            f'<p class="warning"><b>{len(differing)} differ:</b> '
            + ", ".join(f'<a href="#{anchor(i)}">{html.escape(i)}</a>' for i in differing)
            + ".</p>\n"
        )
        if differing
        else ""
    )
    rows = ""
    for row, found in results:
        result = verdict(row.verdict, found)
        rows += (
            f'<tr><td><a href="#{anchor(row.item)}">{html.escape(row.item)}</a></td><td>{text(row.shows)}</td>'
            f'<td class="there">{text(row.thesis)}</td><td>{text(found.value)}</td>'
            f'<td><a href="#{anchor(row.item)}">{badge(result)}</a></td></tr>\n'
        )
    body = (
        f'<h1>Reproduction of the 2016 thesis</h1>\n<p class="lead">{extent(results, of)}</p>\n<p class="details">L. F. M. Diniz,'
        " <i>Experimental evaluation and computational modeling of the Magnetofaba itaipuensis bacteria</i>, UFMG 2016. Every verdict"
        f" is computed: a result with a value outside its accepted range is marked {DIFFERS}. {origin(results, version)} Run the commands"
        f' in the folder of the project.</p>\n<dl class="cards">{cards}</dl>\n{warning}<h2 id="summary">Results</h2>\n'
        '<table class="index"><thead><tr><th>item</th><th>content</th><th class="there">in the'
        f" thesis</th><th>here</th><th>verdict</th></tr></thead>\n<tbody>{rows}</tbody></table>\n"
        + "".join(section(row, found) for row, found in results)
    )
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8" />\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1" />\n<title>Reproduction of the thesis</title>\n'
        f"<style>{style}{STYLE}</style>\n</head>\n<body>\n<main>\n{body}</main>\n</body>\n</html>\n"
    )
