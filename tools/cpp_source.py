"""The tokens, brackets, calls and functions of a C++ file, for tools that read the sources of the program."""

import re

TEXT_TYPES = {"string", "char", "string_view"}
NOT_FUNCTIONS = {"if", "for", "while", "switch", "catch", "return", "sizeof", "decltype"}
TOKEN = re.compile(r'//[^\n]*|/\*.*?\*/|^\s*#(?:[^\n]*\\\n)*[^\n]*|R"\((?P<raw>.*?)\)"|"(?P<text>(?:\\.|[^"\\\n])*)"|\'(?:\\.|[^\'\\])+\''
                   r'|[A-Za-z_]\w*|\d[\w.\']*|::|->|\+=|[=!<>]=|&&|\|\||\S', re.S | re.M)
PAIRS = {"(": ")", "[": "]", "{": "}"}


class Token(str):
    """A token of C++; `text` is the value of a string literal, otherwise None."""

    text, line = None, 0


def unescaped(literal):
    text = re.sub(r"\\u([0-9a-fA-F]{4})", lambda e: chr(int(e[1], 16)), literal)
    return re.sub(r"\\(.)", lambda e: {"n": " ", "t": "\t", "r": " "}.get(e[1], e[1]), text)


def tokens_of(source):
    tokens, at, line = [], 0, 1
    for m in TOKEN.finditer(source):
        if m[0].startswith(("//", "/*")) or m[0].lstrip().startswith("#"):
            continue
        t = Token(m[0] if m[0][0] not in "\"'" and m["raw"] is None else '""')
        t.text = m["raw"] if m["raw"] is not None else unescaped(m["text"]) if m["text"] is not None else None
        line += source.count("\n", at, m.start())
        at = m.start()
        t.line = line
        tokens.append(t)
    return tokens


def closing_of(tokens):
    """Index of the closing bracket of each opening one."""
    closing, stack = {}, []
    for i, t in enumerate(tokens):
        if t in PAIRS:
            stack.append(i)
        elif t in PAIRS.values() and stack:
            closing[stack.pop()] = i
    return closing


def split(tokens, separator):
    """Parts between separators that are outside of all brackets."""
    parts, depth = [[]], 0
    for t in tokens:
        depth += (t in PAIRS) - (t in PAIRS.values())
        if depth == 0 and t == separator:
            parts.append([])
        else:
            parts[-1].append(t)
    return parts


def until(tokens, start, ends):
    """Tokens from `start` to the first of `ends`, or to a closing bracket, outside of all brackets."""
    depth = 0
    for i in range(start, len(tokens)):
        if depth == 0 and (tokens[i] in ends or tokens[i] in PAIRS.values()):
            return tokens[start:i]
        depth += (tokens[i] in PAIRS) - (tokens[i] in PAIRS.values())
    return tokens[start:]


class Function:
    """A function or lambda with a body."""

    def __init__(self, name, text, parameters, start, end):
        self.name, self.is_text, self.start, self.end = name, text, start, end
        kinds = [(next((t for t in reversed(split(p, "=")[0]) if t.isidentifier()), ""), bool(TEXT_TYPES & set(p))) for p in split(parameters, ",")]
        self.texts = {n: i for i, (n, is_text) in enumerate(kinds) if is_text}
        self.count = len(kinds)


class Source:
    def __init__(self, name, text):
        self.name, self.tokens = name, tokens_of(text)
        self.closing = closing_of(self.tokens)
        self.opening = {b: a for a, b in self.closing.items()}
        self.functions = [f for f in map(self.function_at, self.closing) if f]
        self.places = {}
        for i, t in enumerate(self.tokens[:-3]):
            self.places.setdefault(str(t), []).append(i)
        self.has_warnings = bool({"Warning", "warnings"} & set(self.places))

    def function_at(self, opening):
        t = self.tokens
        body = self.closing[opening] + 1
        while body < len(t) and (t[body].isidentifier() or t[body] in ("->", "::", "<", ">", "*", "&")) and t[body] != "return":
            body += 1
        before = t[opening - 1] if opening else Token("")
        if t[opening] != "(" or body not in self.closing or t[body] != "{" or before in NOT_FUNCTIONS:
            return None
        parameters = t[opening + 1:self.closing[opening]]
        if before == "]":  # a lambda has the name of its variable, or of the function that receives it
            start = self.opening.get(opening - 1, 2)
            return Function(t[start - 2] if t[start - 1] in ("=", "(") else "", True, parameters, body, self.closing[body])
        first = next((i for i in range(opening - 1, 0, -1) if t[i] in (";", "}", "{")), 0)
        return Function(before, bool(TEXT_TYPES & set(t[first:opening])), parameters, body, self.closing[body])

    def arguments(self, index):
        """Arguments of the call or the braces after a token."""
        opening = index + 1
        return split(self.tokens[opening + 1:self.closing[opening]], ",") if self.tokens[opening] in ("(", "{") and opening in self.closing else []

    def function_of(self, index):
        return [f for f in self.functions if f.start < index < f.end]
