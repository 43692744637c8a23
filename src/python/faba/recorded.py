"""Recorded runs: run(), resume(), bench(), replay() and Run."""

from __future__ import annotations

import json
import os
import pathlib
from typing import Any, Callable, Mapping, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _faba, _program
from .control import Controller, Estimator, Reference

Scene = Union[str, "os.PathLike[str]", Mapping[str, Any]]
Part = Union[None, str, Mapping[str, Any], Controller, Estimator, Reference, type]
Progress = Optional[Callable[[int, int], None]]


class Run:
    """The directory of a run: its data as arrays.

    directory : path of a run directory
    """

    def __init__(self, directory: str | os.PathLike[str]) -> None:
        self.path = pathlib.Path(directory)
        if not self.path.is_dir():
            raise _program.error(3, str(self.path), "directory not found; give a run directory, such as runs/steer-1")

    @property
    def complete(self) -> bool:
        """Whether the run reached its end; an interrupted run can be continued with faba.resume()."""
        return not (self.path / "incomplete").exists() and (self.path / "manifest.json").exists()

    @property
    def manifest(self) -> dict[str, Any]:
        """The content of manifest.json."""
        return dict(json.loads((self.path / "manifest.json").read_text()))

    @property
    def state_hash(self) -> str:
        """Hash of the final state of a simulation."""
        return str(self.manifest["state_hash"])

    @property
    def series(self) -> npt.NDArray[Any]:
        """series.csv as a structured array: one row for each frame, columns by name; NaN where there is no value.

        pandas.DataFrame(run.series) makes a table of it.
        """
        with open(self.path / "series.csv") as file:
            names = file.readline().strip().split(",")
            values = np.loadtxt(file, delimiter=",", ndmin=2, converters=lambda s: float(s or "nan"))
        rows = np.zeros(len(values), dtype=[(name, float) for name in names])
        for i, name in enumerate(names):
            rows[name] = values[:, i] if len(values) else []
        return rows

    @property
    def metrics(self) -> dict[str, Any]:
        """Metrics of the control, as in `faba run --json`: settling time, steady-state error, path length, ..."""
        return dict(_faba.run_metrics(str(self.path)))

    @property
    def tracks(self) -> Any:
        """tracks.h5: an xarray.Dataset with the positions of all cells if xarray is installed, else an h5py.File."""
        file = self.path / "tracks.h5"
        try:
            import xarray
        except ImportError:
            import h5py

            return h5py.File(file, "r")
        return xarray.open_dataset(file, engine="h5netcdf")

    @property
    def video(self) -> pathlib.Path | None:
        """Path of the video, lossless if there is one; None without a video."""
        for name in ("video.avi", "video.mp4"):
            if (self.path / name).exists():
                return self.path / name
        return None

    def __repr__(self) -> str:
        return f"<faba.Run {self.path}{'' if self.complete else ', incomplete'}>"


def run(scene: Scene, *, out: str | os.PathLike[str] | None = None, seed: int | None = None, set: Mapping[str, Any] | None = None,
        duration: float | str | None = None, controller: Part = None, estimator: Part = None, reference: Part = None, threads: int = 0,
        force: bool = False, as_seen: bool = False, progress: Progress = None) -> Run:
    """Runs the control loop of a scenario and records it, like `faba run`.

    scene : path, TOML text or dict
    out : directory; default: runs/SCENE-SEED, with -2, -3, ... if it exists
    seed, set, duration, controller, estimator, reference : as of Simulation
    threads : int, 0: all; does not change the result
    force : replace an earlier run in the directory
    as_seen : record videos as the camera sees them, not drawings
    progress : function of the number of frames done and their total, called ten times per second

    Returns the Run. An exception of a part in Python ends the run; its directory stays incomplete. Ctrl-C stops it with a checkpoint.
    """
    return Run(_faba.run_scene(scene, out=out, seed=seed, set=set, duration=duration, controller=controller, estimator=estimator,
                               reference=reference, threads=threads, force=force, as_seen=as_seen, progress=progress))


def resume(directory: str | os.PathLike[str], *, controller: Part = None, estimator: Part = None, reference: Part = None, threads: int = 0,
           progress: Progress = None) -> Run:
    """Continues an interrupted run from its last checkpoint; the result is bit-identical to that of an uninterrupted one.

    Parts in Python are imported by the name that the run stores, or given as objects or classes. They need state() and restore() if
    they keep values in attributes.
    """
    _faba.resume_run(os.fspath(directory), controller=controller, estimator=estimator, reference=reference, threads=threads,
                     progress=progress)
    return Run(directory)


def bench(scene: Scene, *, arm: bool = False, out: str | os.PathLike[str] | None = None, seed: int | None = None,
          set: Mapping[str, Any] | None = None, duration: float | str | None = None, controller: Part = None, estimator: Part = None,
          reference: Part = None, force: bool = False, progress: Progress = None) -> Run:
    """Runs the control loop of a scenario on its bench, like `faba rig run`.

    arm : permit current in the coils; use it only while a person supervises them
    Other arguments : as of run()

    All currents pass the limits and the guard, which is a process of its own. They are zero when a part raises, blocks longer than
    the guard permits, or this process ends in any way.
    """
    return Run(_faba.bench_run(scene, arm=arm, out=out, seed=seed, set=set, duration=duration, controller=controller,
                               estimator=estimator, reference=reference, force=force, progress=progress))


def replay(directory: str | os.PathLike[str], *, controller: Part = None, estimator: Part = None, reference: Part = None) -> dict[str, Any]:
    """Computes the commands of a run on a bench again from its lossless video, and compares them bit by bit.

    Returns a dict: recorded, equal_commands, same, first_difference.
    """
    return dict(_faba.replay_run(os.fspath(directory), controller=controller, estimator=estimator, reference=reference))
