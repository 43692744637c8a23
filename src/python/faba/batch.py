"""Many simulations at once: simulate() and compare_controllers()."""

from __future__ import annotations

import os
from typing import Any, Callable, Mapping, Sequence, Union

import numpy as np
import numpy.typing as npt

from . import _faba
from ._progress import Progress, reporter
from .recorded import Part, Scene

Statistic = Union[str, Sequence[str], Callable[[_faba.Simulation], Any]]


def simulate(
    scene: Scene,
    parameters: Mapping[str, Any],
    seeds: int | Sequence[int] | npt.NDArray[np.integer[Any]],
    statistic: Statistic,
    *,
    duration: float | str | None = None,
    set: Mapping[str, Any] | None = None,
    controller: Part = None,
    estimator: Part = None,
    reference: Part = None,
    threads: int = 0,
    progress: Progress = None,
) -> npt.NDArray[Any]:
    """Simulates a scenario with many parameter sets and seeds, on all cores, without files.

    scene : path, TOML text or dict
    parameters : dict from paths such as "swarm[0].model.speed" to a sequence of values in SI units, or of texts with a unit, one for
        each set; a single value belongs to all sets
    seeds : int or sequence of int: the seeds themselves, not their number; range(20) gives twenty trials
    statistic : name of a metric such as "steady_rms_px" (those of Run.metrics), a list of names, or a function of the finished
        Simulation, which several threads call, one at a time
    duration, set, controller, estimator, reference : as of Simulation; parts in Python as classes, of which each simulation has an object
    threads : int, 0: all; does not change the values
    progress : function of the number of simulations done and their total; None: a bar in a terminal, False: nothing

    Returns an array (sets, seeds), with a further axis for several metrics; NaN: the metric is not defined for the run.
    """
    return _faba.simulate(scene, dict(parameters), seeds, statistic, duration=duration, set=set, controller=controller,
                          estimator=estimator, reference=reference, threads=threads, progress=reporter(progress, "simulations"))


def compare_controllers(
    study: str | os.PathLike[str],
    controllers: Mapping[str, Part] | None = None,
    *,
    seeds: int | None = None,
    threads: int = 0,
    page: str | os.PathLike[str] | None = None,
    progress: Progress = None,
) -> dict[str, Any]:
    """Compares the controllers of a study file, and further ones, over its models, delays and seeds.

    study : path of a study file of `faba compare-controllers`
    controllers : dict from names to classes in Python, names of built-in controllers, or tables
    seeds : int, number of trials of each combination; default: that of the study
    page : path of an HTML page to write, or None
    threads, progress : as of simulate()

    Returns a dict, as in controllers.json. Nothing is stored, so a stopped comparison starts again.
    """
    return _faba.compare_controllers(study, dict(controllers or {}), seeds=seeds, threads=threads, page=page,
                                     progress=reporter(progress, "trials"))
