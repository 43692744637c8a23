"""An engine with which SwarmRL trains and tests agents in Faba: one agent is the swarm.

    engine = SwarmEngine("scenes/bench.toml", seed=1, strength=10)
    trainer.perform_rl_training(system_runner=engine, ...)

A field acts on all cells alike, so the agent is not a cell but the swarm: `colloids` has one colloid, the estimated swarm.

    pos        array (3,), um: estimated centroid, x right, y up, origin in the centre of the view, z = 0; older than the present by
               the delay of the camera
    director   array (3,), unit vector: the direction commanded last; before the first command (1, 0, 0)
    velocity   array (3,), um/s: estimated velocity of the centroid
    id, type   0, and the number given as `particle_type`

An action of the force model, of which SwarmRL's Action is an example:

    new_direction   array (3,) or None: direction along which the cells swim; None: the present director. z has no effect
    force           number from 0 to 1, limited to them: field in units of `strength`; 0 switches the coils off. For cells such as
                    those of the model `dipole` the field sets how fast they turn and how well they align, not how fast they swim
    torque          must be None or 0: a swarm has no orientation of its own

The direction and the force give a field at the centroid, the field gives the current of each coil, and the limits of the scenario
act on the currents. Written for the interface of SwarmRL (EPL-2.0) without code of it.
"""

import dataclasses
from typing import Any

import numpy as np

import faba


@dataclasses.dataclass(frozen=True)
class Colloid:
    """The attributes of a colloid in SwarmRL."""

    pos: np.ndarray
    director: np.ndarray
    id: int
    velocity: Any = None
    type: int = 0


class SwarmEngine:
    """A simulation of a scenario behind the interface of an engine of SwarmRL.

    scene, seed, set, duration : as of faba.Simulation
    frames_per_slice : camera frames for which an action is kept
    strength : field of an action with force 1, in field units of the scenario
    particle_type : type of the colloid, by which a force model finds its agent
    colloid : class of the colloids; SwarmRL's own for agents that need it
    """

    def __init__(self, scene, *, seed=None, set=None, duration=None, frames_per_slice=6, strength=40.0, particle_type=0, colloid=Colloid):
        if not (isinstance(frames_per_slice, int) and frames_per_slice >= 1):
            raise ValueError(f"frames_per_slice is {frames_per_slice}; give an integer of at least 1")
        self.simulation = faba.Simulation(scene, seed=seed, set=set, duration=duration)
        self.frames_per_slice, self.strength, self.particle_type, self.colloid = frames_per_slice, strength, particle_type, colloid
        self.context = self.simulation.context
        self.director = np.array([1.0, 0.0, 0.0])
        self.tick = self.simulation.turn(np.zeros(self.context.coils))  # the first picture

    @property
    def colloids(self):
        """The swarm as a list of one colloid."""
        if self.simulation is None:
            raise RuntimeError("the engine is finalised; make a new one")
        estimate = self.tick.estimate
        pos, velocity = (1e6 * np.append(v, 0.0) for v in (estimate.centroid, estimate.velocity))
        return [self.colloid(pos, self.director.copy(), 0, velocity, self.particle_type)]

    def integrate(self, n_slices, force_model):
        """Asks the force model for an action and executes it for `frames_per_slice` frames, n_slices times.

        Ends early when the force model sets `kill_switch`, or at the end of the scenario.
        """
        for _ in range(n_slices):
            colloids = self.colloids
            if self.simulation.finished or getattr(force_model, "kill_switch", False):
                return
            actions = force_model.calc_action(colloids)
            if len(actions) != 1:
                raise ValueError(f"the force model returned {len(actions)} actions; it must return one, for the swarm")
            field = self._field(actions[0])
            for _ in range(self.frames_per_slice):
                if self.simulation.finished:
                    return
                currents = self.context.currents_for_direction(field, at=self.tick.estimate.centroid)
                self.tick = self.simulation.turn(currents)

    def finalize(self):
        """Ends the simulation. It may be called again."""
        self.simulation = None

    def _field(self, action):
        """The field of an action, in field units along which the cells swim; sets the director."""
        if action.torque is not None and np.any(np.asarray(action.torque, dtype=float)):
            raise ValueError(f"torque is {action.torque}; it must be None or 0, because a swarm has no orientation of its own")
        force = float(action.force)
        if not np.isfinite(force):
            raise ValueError(f"force is {force}; give a number from 0 to 1")
        if action.new_direction is not None:
            direction = np.array(action.new_direction, dtype=float)
            if direction.shape != (3,) or not np.isfinite(direction).all():
                raise ValueError(f"new_direction is {action.new_direction}; give three finite numbers")
            direction[2] = 0.0
            length = np.linalg.norm(direction)
            if length == 0:
                raise ValueError(f"new_direction is {action.new_direction}; it must have a component in the plane of x and y")
            self.director = direction / length
        return self.strength * min(max(force, 0.0), 1.0) * self.director[:2]
