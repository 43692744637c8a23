"""Measuring verbs on suitable and unsuitable material with known truth, for bench/quality.py."""

from . import drop, field, flow, scale

VERBS = {"drop": drop, "scale": scale, "flow": flow, "field fit": field}
