"""Trained policies as controllers. Needs no Gymnasium, so that a computer at a bench needs none either."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from . import _faba
from .control import Controller

Floats = npt.NDArray[np.float64]


class PolicyController(Controller):
    """A trained policy as a controller, for faba.run(), faba.compare_controllers() and the bench.

    Derive a class that defines policy(observation) -> action, with the observation and action of the environments, and
    `strength` or `action` if they are not the defaults.
    """

    action = "field"
    strength = 40.0

    def start(self) -> None:
        self.last = np.zeros(self.context.coils)

    def policy(self, observation: npt.NDArray[np.float32]) -> Any:
        """The action for an observation, each number from -1 to 1."""
        raise NotImplementedError("define the function policy(observation)")

    def update(self, estimate: _faba.Estimate, target: _faba.Target, dt: float) -> Floats:
        observation = _faba.policy_input(self.context, estimate, target, self.last)
        action = np.clip(np.asarray(self.policy(observation), dtype=float), -1.0, 1.0)
        if self.action == "currents":
            currents = action * self.context.max_currents
        else:
            currents = self.context.currents_for_direction(self.strength * action, at=estimate.centroid)
        self.last = np.clip(currents, -self.context.max_currents, self.context.max_currents)
        return self.last

    def state(self) -> dict[str, Any]:
        return {"last": [float(v) for v in self.last]}

    def restore(self, state: dict[str, Any]) -> None:
        self.last = np.array(state["last"])
