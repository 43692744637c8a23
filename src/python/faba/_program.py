"""Calls the program `faba`, which computes the measurements of files."""

from __future__ import annotations

import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import tempfile
from typing import Any, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from . import _faba


def _find() -> pathlib.Path:
    """The program: $FABA_PROGRAM, beside the package in a source tree, under its prefix if it is installed, or in PATH."""
    given = os.environ.get("FABA_PROGRAM")
    candidates = [pathlib.Path(given)] if given else []
    package = pathlib.Path(__file__).resolve().parent
    candidates.append(package.parents[1] / "faba")  # build/python/faba
    candidates.append(package.parents[3] / "bin" / "faba")  # PREFIX/lib/python3/dist-packages/faba
    found = shutil.which("faba")
    if found:
        candidates.append(pathlib.Path(found).resolve())
    for candidate in candidates:
        if candidate.is_file() and os.access(candidate, os.X_OK):
            return candidate
    return pathlib.Path(found or "faba")


PROGRAM = _find()
_faba.set_program_folder(str(PROGRAM.parent))


class Measurement(dict):  # type: ignore[type-arg]
    """The result of a measurement: a dict with the members of `faba VERB --json`.

    Its attribute `tracks` is None, or for track() of a single video without `out` a structured array with a row for each detection and
    the columns of tracks.csv.
    """

    tracks: npt.NDArray[Any] | None = None
    _options: Mapping[str, Any] = {}

    @property
    def quality(self) -> str:
        """How reliable the answer is: good, doubtful or poor; empty if the verb does not state it."""
        return str(self.get("quality", ""))

    @property
    def warnings(self) -> list[dict[str, Any]]:
        """Violated assumptions: dicts with aspect, what, evidence and advice. Options are named as the arguments in Python."""
        return [{key: _as_arguments(text, self._options) if isinstance(text, str) else text for key, text in warning.items()}
                for warning in self.get("warnings", [])]

    def __repr__(self) -> str:
        return f"faba.Measurement({dict.__repr__(self)})"


def error(code: int, where: str, what: str) -> Exception:
    e = _faba.Error(f"{where}: {what}" if where else what)
    e.code, e.where, e.what = code, where, what
    return e


def _as_arguments(text: str, options: Mapping[str, Any]) -> str:
    """A message of the program with its options as the arguments in Python; commands in backticks are kept."""
    names = {_flag(name): f"{name}=True" if value is False or value is True else name for name, value in options.items()}
    text = re.sub(r" \(see \S*faba [a-z -]*--help\)", "", text)
    return re.sub(r"`[^`]*`|--[a-z0-9][a-z0-9-]*", lambda m: names.get(m[0], m[0]), text)


def _without_folder(value: Any, folder: str) -> Any:
    """A result in which arrays have their names, not the temporary files in which the program read them."""
    if isinstance(value, str):
        return re.sub(re.escape(folder) + r"/(\w+)(\.pgm|/\d+\.pgm)?", r"\1", value)
    if isinstance(value, list):
        return [_without_folder(one, folder) for one in value]
    if isinstance(value, dict):
        return {key: _without_folder(one, folder) for key, one in value.items()}
    return value


def _write_pgm(path: pathlib.Path, picture: np.ndarray[Any, Any], name: str) -> None:
    if picture.ndim != 2 or picture.size == 0:
        raise error(2, name, f"has the shape {picture.shape}; give grey pictures, arrays (height, width)")
    if picture.dtype == np.bool_ or not np.issubdtype(picture.dtype, np.number) or np.iscomplexobj(picture):
        raise error(2, name, f"has the type {picture.dtype}; give numbers")
    values = np.asarray(picture, dtype=float)
    if not np.all(np.isfinite(values)) or values.min() < 0 or values.max() > 65535:
        raise error(2, name, "has values that are not between 0 and 65535; scale the grey values")
    deep = picture.dtype != np.uint8 and values.max() > 255
    stored = np.rint(values).astype(">u2" if deep else np.uint8)
    header = f"P5\n{picture.shape[1]} {picture.shape[0]}\n{65535 if deep else 255}\n"
    path.write_bytes(header.encode() + stored.tobytes())


def _input(value: Any, name: str, folder: pathlib.Path) -> str:
    """A path; an array is written into the folder as a picture, or as a folder of pictures."""
    if isinstance(value, (str, os.PathLike)):
        return os.fspath(value)
    array = np.asarray(value)
    if array.ndim == 3:
        if name in ("picture", "ruler"):
            raise error(2, name, f"has the shape {array.shape}; give one grey picture, an array (height, width)")
        if array.shape[2] in (3, 4):
            raise error(2, name, f"has the shape {array.shape}, as a colour picture; give grey pictures, an array (frames, height, width)")
        frames = folder / name
        frames.mkdir()
        for i, picture in enumerate(array):
            _write_pgm(frames / f"{i:06d}.pgm", picture, name)
        return str(frames)
    path = folder / f"{name}.pgm"
    _write_pgm(path, array, name)
    return str(path)


def _flag(name: str) -> str:
    return "--" + name.rstrip("_").replace("_", "-")


def _option(name: str, value: Any) -> list[str]:
    flag = _flag(name)
    if value is None or value is False:
        return []
    if value is True:
        return [flag]
    values = value if isinstance(value, (list, tuple)) else [value]
    return [f"{flag}={os.fspath(one) if isinstance(one, os.PathLike) else one}" for one in values]


def call(verb: Sequence[str], inputs: Sequence[tuple[str, Any]] = (), options: Mapping[str, Any] | None = None,
         codes: Sequence[int] = (0,)) -> Measurement:
    """Calls a verb with --json and returns its result. Ctrl-C stops the program, which keeps what it has stored.

    codes : exit codes that are not errors

    Raises faba.Error with the code, place and reason that the program states.
    """
    with tempfile.TemporaryDirectory(prefix="faba-") as folder:
        words = [str(PROGRAM), *verb, "--json"]
        for name, value in (options or {}).items():
            words += _option(name, value)
        words.append("--")
        for name, value in inputs:
            for i, one in enumerate(value if isinstance(value, (list, tuple)) else [value]):
                words.append(_input(one, f"{name}{i or ''}", pathlib.Path(folder)))
        try:
            process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True)
        except OSError as e:
            raise error(1, str(PROGRAM), f"cannot be started ({e.strerror}); set FABA_PROGRAM to the program faba") from e
        out, messages = _wait(process)
        return _result(process.returncode, out, messages, codes, options or {}, folder)


def call_track(verb: Sequence[str], inputs: Sequence[tuple[str, Any]], options: Mapping[str, Any]) -> Measurement:
    """As call(); the result of a single video has the tracks in the attribute `tracks`, unless they are written to a file."""
    videos = inputs[0][1]
    single = not isinstance(videos, (list, tuple)) or len(videos) == 1
    if not single or any(options.get(name) is not None for name in ("out", "folder", "preview", "edits", "engine")):
        return call(verb, inputs, options)
    with tempfile.TemporaryDirectory(prefix="faba-") as folder:
        file = pathlib.Path(folder) / "tracks.csv"
        result = call(verb, inputs, {**options, "out": file})
        result.tracks = np.genfromtxt(file, delimiter=",", names=True, ndmin=1)
    return result


def _wait(process: subprocess.Popen[bytes]) -> tuple[bytes, bytes]:
    try:
        return process.communicate()
    except BaseException:  # also KeyboardInterrupt
        process.send_signal(signal.SIGINT)
        try:
            process.communicate(timeout=10)
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()
        raise


def _result(code: int, out: bytes, messages: bytes, codes: Sequence[int], options: Mapping[str, Any], folder: str) -> Measurement:
    text = out.decode(errors="replace").strip()
    try:
        result = json.loads(text.splitlines()[-1]) if text else {}
    except ValueError:
        result = {}
    if code in codes:
        measured = Measurement(_without_folder(result, folder))
        measured._options = dict(options)
        return measured
    stated = result.get("error", {}) if isinstance(result, dict) else {}
    last = messages.decode(errors="replace").strip().splitlines()
    what = stated.get("what", last[-1] if last else f"the program ended with code {code}")
    where, what = (_as_arguments(_without_folder(text, folder), options) for text in (stated.get("where", ""), what))
    raise error(code, where, what)
