"""Checks of values against accepted ranges, and the verdict that follows from them."""

import dataclasses
import math

SAME, CORRECTED, VIDEOS, LATER, PENDING, DIFFERS = "same", "corrected", "needs the original videos", "later work", "pending", "DIFFERS"


def shown(x, digits=4):
    """A value as text: numbers with `digits` significant digits, and an exponent only below 1e-3 and from 1e6."""
    if isinstance(x, bool) or x is None:
        return {True: "yes", False: "no", None: "none"}[x]
    if isinstance(x, int) or not math.isfinite(x):
        return str(x)
    if x != 0 and not 1e-3 <= abs(x) < 1e6:
        mantissa, exponent = f"{x:.{digits - 1}e}".split("e")
        return f"{mantissa.rstrip('0').rstrip('.')}e{int(exponent)}".replace("-", "\u2212")
    text = f"{x:.{max(0, digits - 1 - (math.floor(math.log10(abs(x))) if x else 0))}f}"
    return (text.rstrip("0").rstrip(".") if "." in text else text).replace("-", "\u2212")


@dataclasses.dataclass
class Check:
    """A value that must lie in [low, high] (None: no limit), or be true if both limits are None; `why` is the reason for the range."""

    what: str
    value: object
    low: object
    high: object
    why: str
    unit: str = ""
    around: object = None  # (expected value, tolerance) if the range was given in this form

    @property
    def ok(self):
        if self.low is None and self.high is None:
            return self.value is True
        if isinstance(self.value, bool) or not isinstance(self.value, (int, float)) or not math.isfinite(self.value):
            return False
        return (self.low is None or self.value >= self.low) and (self.high is None or self.value <= self.high)

    def accepted(self):
        unit = f" {self.unit}" if self.unit else ""
        if self.low is None and self.high is None:
            return "yes"
        if self.around:
            return f"{shown(self.around[0], 6)} ± {shown(self.around[1], 2)}{unit}"
        if self.low is None:
            return f"at most {shown(self.high)}{unit}"
        if self.high is None:
            return f"at least {shown(self.low)}{unit}"
        if self.low == self.high:
            return f"{shown(self.low, 12)}{unit}"
        return f"{shown(self.low, 6)} to {shown(self.high, 6)}{unit}"


class Found:
    """The result of a row: value in one line, checks, figures, notes. `beside` describes values that are computed without the program,
    `chosen` inputs that the thesis does not give."""

    def __init__(self):
        self.value, self.note, self.checks, self.pictures, self.commands, self.files, self.failed = "", [], [], [], [], [], None
        self.beside, self.chosen = "", ""

    def within(self, what, value, low, high, why, unit=""):
        value = value if isinstance(value, (bool, int)) or value is None else float(value)
        self.checks.append(Check(what, value, low, high, why, unit))

    def about(self, what, value, expected, tolerance, why, unit=""):
        self.checks.append(Check(what, float(value), expected - tolerance, expected + tolerance, why, unit, (expected, tolerance)))

    def true(self, what, value, why):
        self.checks.append(Check(what, bool(value), None, None, why))

    def show(self, *markups):
        self.pictures += [m for m in markups if m]


def verdict(intended, found):
    """The intended verdict if all checks pass; DIFFERS if a check fails, if there are none, or if the computation failed."""
    if intended == PENDING and not found.failed:
        return PENDING
    if found.failed or not found.checks or not all(c.ok for c in found.checks):
        return DIFFERS
    return intended
