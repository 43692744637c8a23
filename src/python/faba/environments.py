"""Environments for reinforcement learning with Gymnasium: a swarm is held, steered along a route, or gathered.

An action is a vector along which the cells swim, or normalised currents; it passes the limits of the scenario. An observation comes
from the estimator, with the delay of the camera and noise. True values are in `info` and in the reward only.
"""

from __future__ import annotations

import math
import pathlib
from typing import Any, Callable, Mapping, Sequence

import gymnasium
import numpy as np
import numpy.typing as npt

from . import _faba
from .policy import PolicyController as PolicyController  # Also found here, beside the environments.

Floats = npt.NDArray[np.float64]
# A distribution of a value of the scenario: limits of a uniform distribution, or a function of a numpy.random.Generator.
Distribution = Any

_HERE = pathlib.Path(__file__).resolve().parent
_WIDTH, _HEIGHT, _RATE = 640, 480, 60.0  # px, px, Hz

_SWARM: dict[str, Any] = {"count": 300, "model": {"type": "dipole", "preset": "IT-1"}, "start": {"type": "disc", "radius_px": 25.0}}
_HOLD: dict[str, Any] = {
    "title": "Hold a swarm at a setpoint",
    "duration": 10.0,
    "camera": {"rate": _RATE, "delay_frames": 2},
    "arena": {"type": "drop", "radius_px": 220.0},
    "swarm": [_SWARM],
    "controller": {"type": "proportional"},
    "reference": {"type": "hold"},
}
_ROUTE: dict[str, Any] = {
    **_HOLD,
    "title": "Steer a swarm along a route",
    "duration": 20.0,
    "reference": {
        "type": "route",
        "setpoints_px": [[220.0, 160.0], [420.0, 160.0], [420.0, 320.0], [220.0, 320.0]],
        "tolerance_px": 20.0,
    },
}
_GATHER: dict[str, Any] = {
    **_HOLD,
    "title": "Gather a swarm with four coils",
    "duration": 20.0,
    "field": {"type": "rig", "file": str(_HERE / "thesis-four-coils.toml")},
    "swarm": [{**_SWARM, "start": {"type": "disc", "radius_px": 120.0}}],
    "limits": {"max_current": 0.4},
}


def _in_drop(generator: np.random.Generator) -> list[float]:
    """A position in the inner part of the drop, px."""
    radius, angle = 150.0 * math.sqrt(generator.random()), generator.uniform(0.0, 2.0 * math.pi)
    return [_WIDTH / 2 + radius * math.cos(angle), _HEIGHT / 2 + radius * math.sin(angle)]


_STARTS = {"swarm[0].start.centre_px": _in_drop, "swarm[0].model.speed": (150e-6, 220e-6)}


class _Task:
    """What the environments have in common: worlds, distributions, observations and rewards."""

    scene: Mapping[str, Any] = _HOLD
    random: Mapping[str, Distribution] = _STARTS
    action = "field"

    def __init__(
        self,
        number: int,
        threads: int,
        scene: Any = None,
        set: Mapping[str, Any] | None = None,
        randomise: Mapping[str, Distribution] | None = None,
        duration: float | str | None = None,
        action: str | None = None,
        strength: float = 40.0,
        noise_px: float = 1.0,
        delay_frames: int | None = None,
    ) -> None:
        changes = dict(set or {})
        if delay_frames is not None:
            changes["camera.delay_frames"] = delay_frames
        self.randomised = dict(self.random if randomise is None else randomise)
        self.worlds = _faba.Worlds(
            dict(self.scene) if scene is None else scene,
            number,
            threads=threads,
            set=changes or None,
            duration=duration,
            action=self.action if action is None else action,
            strength=strength,
            noise_px=noise_px,
        )
        self.number = number
        # The sizes of observations and actions are known when there are worlds.
        self.worlds.reset(list(range(number)), [0] * number, [{}] * number)
        self.last_setpoints = self.worlds.setpoint_indices()

    def draw(self, generator: np.random.Generator) -> dict[str, Any]:
        """Values of the randomised parameters of an episode."""
        values: dict[str, Any] = {}
        for path, distribution in self.randomised.items():
            if callable(distribution):
                values[path] = distribution(generator)
            else:
                low, high = distribution
                values[path] = float(generator.uniform(low, high))
        return values

    def start(self, which: Sequence[int], generators: Sequence[np.random.Generator]) -> list[dict[str, Any]]:
        """Starts episodes; returns the values that were drawn."""
        seeds = [int(g.integers(2**31)) for g in generators]
        drawn = [self.draw(g) for g in generators]
        self.worlds.reset(list(which), seeds, drawn)
        self.last_setpoints = self.worlds.setpoint_indices()
        return drawn

    def observations(self) -> npt.NDArray[np.float32]:
        """Of all worlds."""
        return self.worlds.observations()

    def true_errors(self) -> Floats:
        """Distance of each swarm from its setpoint, in units of half the height of the view."""
        return self.worlds.true_distances() / self.worlds.half_height

    def rewards(self) -> Floats:
        """Minus the true distance from the setpoint, in units of half the height of the view, for each frame."""
        return -self.true_errors()

    def ended(self) -> npt.NDArray[np.bool_]:
        """Whether the goal is reached, so that the episode ends before its duration."""
        return np.zeros(self.number, dtype=np.bool_)

    def info(self) -> dict[str, Floats]:
        """True values of all worlds; lengths in m, world frame."""
        return {
            "true_centroid": self.worlds.true_centroids(),
            "true_radius": self.worlds.true_radii(),
            "setpoint": self.worlds.setpoints(),
        }

    def spaces(self) -> tuple[gymnasium.spaces.Box, gymnasium.spaces.Box]:
        """Of an observation and of an action."""
        return (
            gymnasium.spaces.Box(-10.0, 10.0, (self.worlds.inputs,), np.float32),
            gymnasium.spaces.Box(-1.0, 1.0, (self.worlds.outputs,), np.float32),
        )


class _HoldTask(_Task):
    random = {**_STARTS, "reference.setpoint_px": _in_drop}


class _RouteTask(_Task):
    scene = _ROUTE

    def rewards(self) -> Floats:
        """As Hold, and 10 for each setpoint that is reached."""
        indices, finished = self.worlds.setpoint_indices(), self.worlds.routes_finished()
        reached = (indices != self.last_setpoints) | finished
        self.last_setpoints = indices
        return np.asarray(super().rewards() + 10.0 * reached)

    def ended(self) -> npt.NDArray[np.bool_]:
        return np.asarray(self.worlds.routes_finished())


class _GatherTask(_Task):
    scene = _GATHER
    random = {"swarm[0].start.centre_px": _in_drop}
    action = "currents"

    def rewards(self) -> Floats:
        """As Hold, and minus the root-mean-square radius of the swarm in the same unit."""
        return np.asarray(super().rewards() - self.worlds.true_radii() / self.worlds.half_height)


class _Env(gymnasium.Env[npt.NDArray[np.float32], npt.NDArray[np.float32]]):
    """One world. `render_mode`: "rgb_array", or "human", a window with the picture of the lab (needs matplotlib)."""

    metadata = {"render_modes": ["rgb_array", "human"], "render_fps": 60}
    task: type[_Task]

    def __init__(self, render_mode: str | None = None, **options: Any) -> None:
        if render_mode not in (None, *self.metadata["render_modes"]):
            raise ValueError(f'render_mode "{render_mode}" is not one of rgb_array, human')
        self.render_mode = render_mode
        self._task = self.task(1, 1, **options)
        self.observation_space, self.action_space = self._task.spaces()
        self._window: Any = None

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[npt.NDArray[np.float32], dict[str, Any]]:
        super().reset(seed=seed)
        drawn = self._task.start([0], [self.np_random])[0]
        return self._task.observations()[0], {**self._info(), "randomised": drawn}

    def step(
        self, action: npt.NDArray[np.float32]
    ) -> tuple[npt.NDArray[np.float32], float, bool, bool, dict[str, Any]]:
        self._task.worlds.step(np.asarray(action, dtype=float)[np.newaxis])
        observation = self._task.observations()[0]
        reward = float(self._task.rewards()[0])
        ended = bool(self._task.ended()[0])
        truncated = bool(self._task.worlds.finished()[0]) and not ended
        if self.render_mode == "human":
            self._show()
        return observation, reward, ended, truncated, self._info()

    def render(self) -> Any:
        if self.render_mode == "rgb_array":
            return self._task.worlds.drawing(0)
        if self.render_mode == "human":
            self._show()
        return None

    def close(self) -> None:
        if self._window is not None:
            import matplotlib.pyplot

            matplotlib.pyplot.close(self._window[0])
            self._window = None

    def _info(self) -> dict[str, Any]:
        return {name: values[0] for name, values in self._task.info().items()}

    def _show(self) -> None:
        import matplotlib.pyplot

        picture = self._task.worlds.drawing(0)
        if self._window is None:
            figure, axes = matplotlib.pyplot.subplots(num="Faba")
            axes.set_axis_off()
            self._window = (figure, axes.imshow(picture))
        self._window[1].set_data(picture)
        self._window[0].canvas.draw_idle()
        matplotlib.pyplot.pause(1e-3)


class _VectorEnv(gymnasium.vector.VectorEnv[npt.NDArray[np.float32], npt.NDArray[np.float32], npt.NDArray[Any]]):
    """Many worlds, stepped by one call on all cores. A world that ended starts again in the next step."""

    metadata = {
        "render_modes": ["rgb_array"],
        "render_fps": 60,
        "autoreset_mode": gymnasium.vector.AutoresetMode.NEXT_STEP,
    }
    task: type[_Task]

    def __init__(self, num_envs: int = 1, threads: int = 0, render_mode: str | None = None, **options: Any) -> None:
        if render_mode not in (None, "rgb_array"):
            raise ValueError(f'render_mode "{render_mode}" is not rgb_array')
        self.render_mode = render_mode
        self.num_envs = num_envs
        self._task = self.task(num_envs, threads, **options)
        self.single_observation_space, self.single_action_space = self._task.spaces()
        self.observation_space = gymnasium.vector.utils.batch_space(self.single_observation_space, num_envs)
        self.action_space = gymnasium.vector.utils.batch_space(self.single_action_space, num_envs)
        self._generators = [np.random.default_rng() for _ in range(num_envs)]
        self._ended = np.zeros(num_envs, dtype=np.bool_)

    def reset(
        self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[npt.NDArray[np.float32], dict[str, Any]]:
        seeds: Sequence[int | None]
        if seed is None or isinstance(seed, int):
            seeds = [None if seed is None else seed + i for i in range(self.num_envs)]
        else:
            seeds = seed
        for i, one in enumerate(seeds):
            if one is not None:
                self._generators[i] = gymnasium.utils.seeding.np_random(one)[0]
        mask = np.ones(self.num_envs, dtype=np.bool_)
        if options and "reset_mask" in options:
            mask = np.asarray(options["reset_mask"], dtype=np.bool_)
        self._start(np.flatnonzero(mask))
        self._ended[mask] = False
        return self._task.observations(), self._task.info()

    def step(
        self, actions: npt.NDArray[np.float32]
    ) -> tuple[npt.NDArray[np.float32], Floats, npt.NDArray[np.bool_], npt.NDArray[np.bool_], dict[str, Any]]:
        again = np.flatnonzero(self._ended)
        self._task.worlds.step(actions)
        if len(again):  # the action of an ended world is not used
            self._start(again)
        rewards, terminated = self._task.rewards(), self._task.ended()
        truncated = self._task.worlds.finished() & ~terminated
        rewards[again] = 0.0
        self._ended = terminated | truncated
        return self._task.observations(), rewards, terminated, truncated, self._task.info()

    def render(self) -> tuple[Any, ...]:
        return tuple(self._task.worlds.drawing(i) for i in range(self.num_envs))

    def _start(self, which: npt.NDArray[np.intp]) -> None:
        self._task.start([int(i) for i in which], [self._generators[i] for i in which])


class HoldEnv(_Env):
    """faba/Hold-v0: a swarm of about 186 um/s is held at a setpoint in a drop, for 10 s at 60 frames per second."""

    task = _HoldTask


class HoldVectorEnv(_VectorEnv):
    """Many worlds of faba/Hold-v0."""

    task = _HoldTask


class RouteEnv(_Env):
    """faba/Route-v0: a swarm is steered along four setpoints; ends when the last one is reached, at most 20 s."""

    task = _RouteTask


class RouteVectorEnv(_VectorEnv):
    """Many worlds of faba/Route-v0."""

    task = _RouteTask


class GatherEnv(_Env):
    """faba/Gather-v0: a wide swarm is gathered at the centre by the currents of four coils, for 20 s."""

    task = _GatherTask


class GatherVectorEnv(_VectorEnv):
    """Many worlds of faba/Gather-v0."""

    task = _GatherTask
