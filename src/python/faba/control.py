"""Parts of the control loop in Python: derive a class from Controller, Estimator or Reference."""

from __future__ import annotations

from typing import Any, Sequence, Union

import numpy as np
import numpy.typing as npt

from ._faba import Context, Drift, Estimate, Observation, Target

Currents = Union[Sequence[float], npt.NDArray[np.float64]]


class _Part:
    """What all parts have in common.

    `context` (Context) is set before the first cycle: coils, limits, polarity, frame period, scale.
    A part that keeps values between cycles in attributes needs the two functions

        def state(self): return {"sum": self.sum}            # numbers, texts, lists and dicts
        def restore(self, state): self.sum = state["sum"]

    to be resumed from a checkpoint and replayed; restore() is called after start(). An object without attributes needs none.
    An object that several runs use keeps its attributes: initialise them in start(), or give the class.
    """

    context: Context

    def start(self) -> None:
        """Called once when a run starts, with `context` set: prepare what update() needs."""


class Controller(_Part):
    """A feedback law. It gets an estimate and a target only, so it steers a simulation and a bench alike."""

    def update(self, estimate: Estimate, target: Target, dt: float) -> Drift | Currents:
        """Called once per frame.

        estimate : Estimate, of the swarm; with `visible` 0 the coils are switched off whatever is returned
        target : Target; its position is NaN without a setpoint
        dt : float, s since the last call

        Returns one current for each coil, A, such as self.context.currents_for_direction(...) or currents_for_field(...) gives, or
        Drift(x, y), the desired mean velocity, m/s, for cells whose speed is proportional to the field (models basic and adapted).
        """
        raise NotImplementedError("a controller needs the function update(estimate, target, dt)")


class Estimator(_Part):
    """Estimates the state of the swarm from observations."""

    def update(self, observation: Observation, last: npt.NDArray[np.float64]) -> Estimate:
        """Called once per frame. last : array (coils,), the previous currents, A. Returns an Estimate."""
        raise NotImplementedError("an estimator needs the function update(observation, last)")


class Reference(_Part):
    """Gives the setpoint of the swarm.

    `setpoints`, a list of positions (m, world frame), is drawn in pictures and reports; `tolerance_px` is the
    distance within which a setpoint counts as reached.
    """

    setpoints: Sequence[Any] = ()
    tolerance_px: float | None = None

    def update(self, estimate: Estimate) -> Target | Sequence[float] | None:
        """Called once per frame. Returns a Target, a position (m, world frame), or None for no setpoint."""
        raise NotImplementedError("a reference needs the function update(estimate)")
