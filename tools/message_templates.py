#!/usr/bin/python3
"""Prints the English templates of the messages of the program that can reach the page, as JSON.

    tools/message_templates.py [--root .] [--unresolved]

The page translates a message by its text. A message is a literal, a sum of literals and values, or fmt::format; a value is {}
in its template. The page translates values, too: a value that is itself a text of the program, such as a piece of advice, has
its own template. Messages are arguments of SINKS and of functions that pass an argument on to a sink, results of the checks
and notes of a schema, warnings of measurements, and values of HOLDERS and LISTS.

--unresolved prints the messages that are not in the sources, with their places: texts of the operating system, a library or a
file. Values of a message whose texts are not in the sources are numbers, names and keys for this program.
"""

import argparse
import collections
import itertools
import json
import pathlib
import re

from cpp_source import TEXT_TYPES, Source, Token, closing_of, split, until

# Functions of these folders return parts of reports, which have other translations; their errors are read.
REPORTS = ("src/study/pages/", "src/study/plot/")
# Messages of these folders and files appear only in a terminal: jobs of the lab run other verbs, on this machine.
TERMINAL_ONLY = ("src/python/", "src/cli/options/", "src/cli/verbs/rig/", "src/cli/verbs/doctor",
                 "src/cli/command_line", "src/cli/main", "src/cli/usage_message", "src/cli/verbs.cpp", "src/cli/progress", "src/study/calibrate/",
                 "src/study/pages/calibration", "src/study/engines/slurm", "src/study/engines/dask", "src/study/engines/parallel")
SCHEMA_CALLS = {"check", "note"}  # their argument is a function that returns a message
# Variables, members and JSON keys that have a message, and lists of messages.
HOLDERS = re.compile("what|why|trouble|error|.*reason|note|evidence|advice|warning|doing|rejection|ignored|damage|doubt")
LISTS = {"notes", "warnings"}
UNITS = {"px", "um", "mm", "cm", "mT", "uT", "nT", "deg", "Hz", "GB", "TB", "MB", "Pa", "bz", "rho"}
MOST = 24  # combinations of the parts of one message
# A function or class, its number of arguments, the index of the one that is a message or, without `words`, a part of one, and
# the only file of a part.
Sink = collections.namedtuple("Sink", "name arguments index words file")
SINKS = {Sink(name, count, index, True, "") for name, count, index in (
    ("Error", 3, 2), ("invalid_argument", 1, 0), ("Verdict", 2, 1), ("LikelyUnits", 2, 0), ("LikelyUnits", 2, 1), ("progress", 3, 0), ("tick", 3, 0))}


class Reader:
    def __init__(self, sources):
        self.sources, self.templates, self.unresolved = sources, {}, {}
        self.read, self.defined, self.sinks = set(), {}, set(SINKS)
        self.functions = {}
        for source in sources:
            for f in source.functions:
                if f.is_text:
                    self.functions.setdefault(str(f.name), []).append((source, f))

    def values(self, tokens):
        """Templates of an expression."""
        while tokens and tokens[0] == "(" and closing_of(tokens).get(0) == len(tokens) - 1:
            tokens = tokens[1:-1]
        question = split(tokens, "?")
        if len(question) > 1:
            branches = split([Token("?") if t is None else t for part in question[1:] for t in (*part, None)][:-1], ":")
            # a ? b : c ? d : e has the branches b, "c ? d" and e.
            return [v for b in branches for v in self.values(split(b, "?")[-1])]
        parts = split(tokens, "+")
        if len(parts) > 1:
            return self.joined([self.values(p) for p in parts])
        if tokens and all(t.text is not None for t in tokens):
            return ["".join(t.text for t in tokens)]
        opening = next((i for i, t in enumerate(tokens) if t in "({"), 0)
        if opening and closing_of(tokens).get(opening) == len(tokens) - 1:
            name, arguments = tokens[opening - 1], split(tokens[opening + 1:-1], ",")
            if name == "format" and arguments[0] and arguments[0][0].text is not None:
                return self.formatted("".join(t.text or "" for t in arguments[0]), arguments[1:])
            if name == "counted":
                return [f"{{}} {noun}{end}" for noun in self.values(arguments[1]) for end in ("", "s")]
            if name in ("string", "move", "optional"):
                return self.values(arguments[0])
        self.queue.append(tokens)
        return ["{}"]

    def joined(self, parts):
        """Templates of a text in parts. Alternatives of several words are texts of their own; words belong to the sentence."""
        for i, part in enumerate(parts):
            if len(part) > 1 and any(" " in v.strip(" ;,") for v in part):
                self.apart += part
                parts[i] = ["{}"]
        return ["".join(c) for c in itertools.islice(itertools.product(*parts), MOST)]

    def formatted(self, text, arguments):
        values, parts, last, at = [self.values(a) for a in arguments], [], 0, 0
        for m in re.finditer(r"\{\{|\}\}|\{(\d*)(?::(?:\{\}|[^{}])*)?\}", text):
            parts.append([text[last:m.start()]])
            last = m.end()
            if m[0] in ("{{", "}}"):
                parts.append([m[0][0]])
                continue
            index = int(m[1]) if m[1] else at
            at += 1
            parts.append(values[index] if index < len(values) else ["{}"])
        return self.joined([*parts, [text[last:]]])

    def keep(self, tokens, source, index, words=True):
        """The templates of a message; without `words` only those with a space, because other texts may be keys."""
        key = (source.name, id(tokens[0]) if tokens else index, words)
        if key in self.read:
            return
        self.read.add(key)
        self.queue, self.apart = [], []
        found = self.values(tokens)
        holes = self.queue
        place = f"{source.name}:{source.tokens[index].line}"
        for v in [*found, *self.apart]:
            v = re.sub(r"(\{\})+", "{}", v).strip(" ;,")
            if has_words(v) and (words or " " in v):
                self.templates.setdefault(v, place)
        known = [self.names(hole, source, index, words and found == ["{}"]) for hole in holes]
        if words and found == ["{}"] and not any(known) and tokens and tokens != ["{", "}"]:
            self.unresolved[place] = " ".join(t if t.text is None else f'"{t.text}"' for t in tokens)

    def names(self, hole, source, index, words):
        """Reads what a part of a message can be: parameters, variables and functions. Returns whether anything was found."""
        for f in source.function_of(index) if len(hole) == 1 else []:
            if hole[0] in f.texts and f.name.isidentifier():
                self.sinks.add(Sink(str(f.name), f.count, f.texts[hole[0]], words, "" if words else source.name))
                return True
        return any([self.define(str(t), source, hole[i + 1:i + 2] == ["("]) for i, t in enumerate(hole) if t.isidentifier()])

    def define(self, name, source, called):
        """Reads the variables of this name in a source and, if it is called, the functions of this name in all sources."""
        key = (name, source.name, called)
        if key in self.defined:
            return self.defined[key]
        self.defined[key] = False
        found = [self.variable(i, source) for i in source.places.get(name, [])]
        for s, f in self.functions.get(name, []):
            if s is source or (called and not s.name.startswith(REPORTS)):
                self.returns(f, s, False)
                found.append(True)
        self.defined[key] = any(found)
        return self.defined[key]

    def variable(self, i, source):
        """Reads the value of a variable, the texts of an array, or the array that a variable of a loop refers to."""
        t = source.tokens
        after = source.closing.get(i + 1, i) + 1 if t[i + 1] == "[" else i + 1
        if t[after] in ("=", "+=") and t[after + 1] == "{":
            inside = t[after + 2:source.closing.get(after + 1, after)]
            for is_text, group in itertools.groupby(inside, lambda x: x.text is not None):
                if is_text:
                    self.keep(list(group), source, i, False)
                for constant in [x for x in group if x.startswith("k")]:
                    self.define(str(constant), source, False)
        elif t[after] in ("=", "+="):
            self.keep(until(t, after + 1, {";", ","}), source, i, False)
        elif ":" in t[i + 1:i + 3] and t[i - 1] in (",", "&", "auto", "*"):
            return self.define(str(t[i + 1 + t[i + 1:i + 3].index(":") + 1]), source, False)
        else:
            return False
        return True

    def returns(self, f, source, words=True):
        for i in range(f.start, f.end):
            if source.tokens[i] == "return":
                self.keep(until(source.tokens, i + 1, {";"}), source, i, words)

    def scan(self, source):
        """Messages of one source, by the sinks that are known."""
        t = source.tokens
        for sink in sorted(s for s in self.sinks if s.file in ("", source.name)):
            for i in source.places.get(sink.name, []):
                arguments = source.arguments(i)
                if len(arguments) == sink.arguments and "const" not in arguments[sink.index]:
                    self.keep(arguments[sink.index], source, i, sink.words)
        for f in source.functions:
            if f.name.endswith("_note"):
                self.returns(f, source)
        for name in SCHEMA_CALLS:
            for i in source.places.get(name, []):
                named = str(t[i + 2]) if t[i + 1] == "(" and t[i + 3] == ")" else "-"
                for f in source.functions:
                    if f.name == named or i < f.start < source.closing.get(i + 1, 0):
                        self.returns(f, source)

    def scan_fields(self, source):
        """Messages that variables, lists and fields of one source have."""
        t = source.tokens
        for i, name in enumerate(t[:-3]):
            if name == "{":
                self.braces(source, i)
            elif name == "Progress" and t[i + 1].isidentifier():
                for word in until(t, i, {";"}):
                    self.keep([word] if word.text else [], source, i)
            elif HOLDERS.fullmatch(name.text or name):
                after = "".join(t[i + 1:i + 3]) if name.text else t[i + 1]
                if after.startswith((",", "]=")) if name.text else after in ("=", "+="):
                    self.keep(until(t, i + 2 + (after == "]="), {";", ","}), source, i, False)
            elif name in LISTS and t[i + 1] == "." and t[i + 2] in ("push_back", "emplace_back") and t[i + 4] != "{":
                self.keep(t[i + 4:source.closing[i + 3]], source, i)

    def braces(self, source, i):
        """A warning {aspect, what, evidence, advice, quality}, an error {code, where, what}, or a result such as {status, why}."""
        arguments = source.arguments(i - 1)
        sentences = [any(x.text and " " in x.text.strip() for x in a) for a in arguments]
        if len(arguments) < 2 or not arguments[0]:
            return
        is_aspect = arguments[0][-1] == "aspect" or (arguments[0][0].text or "-") > "a"
        if source.has_warnings and 2 < len(arguments) < 6 and sentences[1] and is_aspect:
            for a in arguments[1:4]:
                self.keep(a, source, i)
        elif (len(arguments) == 3 and arguments[0][0] in ("Errc", "code")) or (sentences[1] and source.tokens[i - 1] == "return"):
            message = arguments[min(2, len(arguments) - 1)]
            self.keep(message if message[:1] != ["{"] else [], source, i)

    def all(self):
        for source in self.sources:
            if not source.name.startswith(REPORTS):
                self.scan_fields(source)
        known = None
        while known != len(self.sinks):
            known = len(self.sinks)
            for source in self.sources:
                self.scan(source)
        return dict(sorted(self.templates.items()))


def has_words(template):
    """Whether a text has something to translate: a word that is not a unit, an option, a quoted text or a key with underscores."""
    plain = re.sub(r'--\S+|`[^`]*`|"[^"]*"|<.*|\{\}', " ", template)
    return any(len(word) > 1 and "_" not in word and word not in UNITS for word in re.findall(r"[A-Za-z_]\w*", plain))


def sources_of(root):
    files = sorted(p for p in (root / "src").rglob("*") if p.suffix in (".cpp", ".h"))
    named = {p.relative_to(root).as_posix(): p for p in files}
    return [Source(name, p.read_text()) for name, p in named.items() if not name.startswith(TERMINAL_ONLY)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parents[1])
    parser.add_argument("--unresolved", action="store_true")
    options = parser.parse_args()
    reader = Reader(sources_of(options.root))
    templates = reader.all()
    print(json.dumps(reader.unresolved if options.unresolved else templates, indent=1, ensure_ascii=False))


if __name__ == "__main__":
    main()
