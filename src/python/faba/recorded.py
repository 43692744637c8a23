"""Recorded runs: run(), resume(), bench(), replay() and Run."""

from __future__ import annotations

import json
import os
import pathlib
from typing import Any, Callable, Mapping, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _faba, _program
from ._progress import Progress, reporter
from .control import Controller, Estimator, Reference

Scene = Union[str, "os.PathLike[str]", Mapping[str, Any]]
Part = Union[None, str, Mapping[str, Any], Controller, Estimator, Reference, type]


class Run:
    """The directory of a run: its data as arrays.

    directory : path of a run directory
    """

    def __init__(self, directory: str | os.PathLike[str]) -> None:
        self.path = pathlib.Path(directory)
        if not self.path.is_dir():
            raise _program.error(3, str(self.path), "directory not found; give a run directory, such as runs/steer-1")
        if not (self.path / "scenario.toml").is_file():
            raise _program.error(3, str(self.path), "is not a run directory: scenario.toml not found; give the directory of a run")

    def _file(self, name: str) -> pathlib.Path:
        """A file of the run. Raises faba.Error if it does not exist."""
        if (self.path / name).is_file():
            return self.path / name
        why = "the run did not record it" if self.complete else "the run is incomplete; continue it with faba.resume()"
        raise _program.error(3, str(self.path / name), f"file not found; {why}")

    @property
    def complete(self) -> bool:
        """Whether the run reached its end; an interrupted run can be continued with faba.resume()."""
        return not (self.path / "incomplete").exists() and (self.path / "manifest.json").exists()

    @property
    def manifest(self) -> dict[str, Any]:
        """The content of manifest.json: what was run, with which program, and `notes` on the scenario."""
        return dict(json.loads(self._file("manifest.json").read_text()))

    @property
    def state_hash(self) -> str:
        """Hash of the final state of a simulation."""
        return str(self.manifest["state_hash"])

    @property
    def series(self) -> npt.NDArray[Any]:
        """series.csv as a structured array: one row for each frame, columns by name; NaN where there is no value.

        The names end with the units: t_s, distance_px, current_0_a. true_* are known in a simulation only, estimated_* are what the
        estimator found. pandas.DataFrame(run.series) makes a table of it.
        """
        lines = self._file("series.csv").read_text().splitlines(keepends=True)
        if not lines[-1].endswith("\n"):  # the process was killed while it wrote
            lines.pop()
        rows = [tuple(float(v or "nan") for v in line.rstrip("\n").split(",")) for line in lines[1:]]
        return np.array(rows, dtype=[(name, float) for name in lines[0].strip().split(",")])

    @property
    def metrics(self) -> dict[str, Any]:
        """Metrics of the control, as in `faba run --json`: settling_time_s, steady_rms_px, ...; None: undefined for the run."""
        return dict(_faba.run_metrics(str(self.path)))

    @property
    def tracks(self) -> Any:
        """tracks.h5, the true positions of the cells of a simulation.

        An xarray.Dataset with position_px (frame, cell, axis), px, y down, and t_s (frame), s, if xarray is installed; else an
        h5py.File with the same arrays.
        """
        file = self._file("tracks.h5")
        try:
            import xarray
        except ImportError:
            try:
                import h5py
            except ImportError as missing:
                raise ImportError("tracks.h5 is read by xarray or h5py; install python3-h5netcdf and python3-xarray, or python3-h5py") from missing
            return h5py.File(file, "r")
        try:
            return xarray.open_dataset(file, engine="h5netcdf")
        except ValueError:  # files of earlier versions do not name their dimensions
            return _dataset(file)

    @property
    def video(self) -> pathlib.Path | None:
        """Path of the video, lossless if there is one; None without a video.

        By default it shows a drawing. Record with as_seen=True for a video that can be measured.
        """
        for name in ("video.avi", "video.mp4"):
            if (self.path / name).exists():
                return self.path / name
        return None

    def __repr__(self) -> str:
        return f"<faba.Run {self.path}{'' if self.complete else ', incomplete'}>"


def _dataset(file: pathlib.Path) -> Any:
    """A Dataset of a file of tracks without dimension scales."""
    import h5py
    import xarray

    with h5py.File(file, "r") as f:
        dimensions = {"position_px": ("frame", "cell", "axis"), "responding": ("frame", "cell"), "t_s": ("frame",), "frame": ("frame",)}
        arrays = {name: (dims, f[name][()]) for name, dims in dimensions.items() if name in f and f[name].ndim == len(dims)}
        coordinates = {"frame": arrays.pop("frame"), "t_s": arrays.pop("t_s"), "axis": ["x", "y"]}
        return xarray.Dataset(arrays, coordinates, dict(f.attrs))


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
    progress : function of the number of frames done and their total, called ten times per second; None: a bar in a terminal, False: nothing

    Returns the Run. An exception of a part in Python ends the run; its directory stays incomplete. Ctrl-C stops it with a checkpoint, from
    which resume() continues. An object that is given as a part keeps its attributes for the next run: initialise them in start(), or give
    the class. Raises faba.Error.
    """
    return Run(_faba.run_scene(scene, out=out, seed=seed, set=set, duration=duration, controller=controller, estimator=estimator,
                               reference=reference, threads=threads, force=force, as_seen=as_seen, progress=reporter(progress, "simulating")))


def resume(directory: str | os.PathLike[str], *, controller: Part = None, estimator: Part = None, reference: Part = None, threads: int = 0,
           progress: Progress = None) -> Run:
    """Continues an interrupted run from its last checkpoint; the result is bit-identical to that of an uninterrupted one.

    directory : of a run that Ctrl-C, an error or a failure of the machine stopped; its file `incomplete` exists
    controller, estimator, reference : parts in Python of that run, as objects or classes; default: imported by the name that the run
        stores. They need state() and restore() if they keep values in attributes
    threads, progress : as of run()
    """
    _faba.resume_run(os.fspath(directory), controller=controller, estimator=estimator, reference=reference, threads=threads,
                     progress=reporter(progress, "simulating"))
    return Run(directory)


def bench(scene: Scene, *, arm: bool = False, out: str | os.PathLike[str] | None = None, seed: int | None = None,
          set: Mapping[str, Any] | None = None, duration: float | str | None = None, controller: Part = None, estimator: Part = None,
          reference: Part = None, force: bool = False, progress: Progress = None) -> Run:
    """Runs the control loop of a scenario on its bench, like `faba rig run`.

    arm : permit current in the coils; use it only while a person supervises them
    Other arguments : as of run()

    All currents pass the limits and the guard, which is a process of its own. They are zero when a part raises, blocks longer than
    the guard permits, or this process ends in any way. Returns the Run. Raises faba.Error with code 4 for a failure of camera, driver
    or guard.
    """
    return Run(_faba.bench_run(scene, arm=arm, out=out, seed=seed, set=set, duration=duration, controller=controller,
                               estimator=estimator, reference=reference, force=force, progress=reporter(progress, "bench")))


def replay(directory: str | os.PathLike[str], *, controller: Part = None, estimator: Part = None, reference: Part = None) -> dict[str, Any]:
    """Computes the commands of a run on a bench again from its lossless video, and compares them bit by bit.

    directory : of a run that was recorded with set={"record.lossless": True}
    controller, estimator, reference : parts in Python of that run; default: imported by the name that the run stores

    Returns a dict: recorded (number of commands), equal_commands, same (bool), first_difference (frame, or None).
    """
    return dict(_faba.replay_run(os.fspath(directory), controller=controller, estimator=estimator, reference=reference))
