"""Checks and verdicts: what a result must be, with the reason for the range, and what follows for the page."""

import dataclasses
import math

SAME, CORRECTED, VIDEOS, PENDING, DIFFERS = "same", "corrected", "needs the original videos", "pending", "DIFFERS"


def shown(x, digits=4):
    """A number as one writes it: significant digits, no needless exponent."""
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
    """A value that must lie in [low, high] (None: open), or be true, and why just there."""

    what: str
    value: object
    low: object
    high: object
    why: str
    unit: str = ""
    around: object = None  # (middle, tolerance) where the range was meant so

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
    """What a row's work comes to: our value in a line, checks, pictures, and words about them; `beside` says which of its values are
    computed without the program, `chosen` which inputs are not the thesis's."""

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
    """The verdict a row is meant to have, where every one of its checks holds; a row without checks proves nothing."""
    if intended == PENDING and not found.failed:
        return PENDING
    if found.failed or not found.checks or not all(c.ok for c in found.checks):
        return DIFFERS
    return intended
