"""Faba, a laboratory for magnetotactic bacteria: simulate, steer and measure swarms in magnetic fields.

All quantities are in SI units unless a name says otherwise (`_px`, `um_per_px`). Arrays are NumPy arrays. Errors are faba.Error with
`code`, `where` and `what`. The guide is docs/guide/python.md.
"""

from ._faba import require_main_interpreter as _require_main_interpreter

_require_main_interpreter()

from ._faba import (  # noqa: E402
    Context,
    Drift,
    Error,
    Estimate,
    Field,
    Group,
    Observation,
    Simulation,
    Target,
    Tick,
    Worlds,
    __version__,
    distance,
    flow,
    parts,
    schema,
)
from . import study
from ._program import Measurement
from ._register import register_lazily as _register_lazily
from .batch import compare_controllers, simulate
from .control import Controller, Estimator, Reference
from .measure_models import calibrate, identify, moment
from .measure_pictures import drop, scale
from .measure_setup import field_fit, optics
from .measure_videos import activity, compare, track
from .recorded import Run, bench, replay, resume, run

field = Field

_register_lazily()

__all__ = [
    "Context",
    "Controller",
    "Drift",
    "Error",
    "Estimate",
    "Estimator",
    "Field",
    "Group",
    "Measurement",
    "Observation",
    "Reference",
    "Run",
    "Simulation",
    "Target",
    "Tick",
    "Worlds",
    "__version__",
    "activity",
    "bench",
    "calibrate",
    "compare",
    "compare_controllers",
    "distance",
    "drop",
    "field",
    "field_fit",
    "flow",
    "identify",
    "moment",
    "optics",
    "parts",
    "replay",
    "resume",
    "run",
    "scale",
    "schema",
    "simulate",
    "study",
    "track",
]
