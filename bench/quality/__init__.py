"""Measuring verbs on suitable and unsuitable material with known truth, for bench/quality.py."""

from . import activity, compare, drop, field, flow, identify, scale, track

VERBS = {"drop": drop, "scale": scale, "flow": flow, "activity": activity, "compare": compare, "track": track, "identify": identify, "field fit": field}
