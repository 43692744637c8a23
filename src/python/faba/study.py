"""Studies on the workers of a dask.distributed.Client."""

from __future__ import annotations

import importlib
import os
import pathlib
import subprocess
import time
from typing import Any, Callable, Optional

from . import _program
from ._progress import Progress, reporter


def _work(program: str, directory: str, tasks: str, results: str) -> str:
    """Runs on a worker: computes tasks of a study in a folder that all workers share."""
    done = subprocess.run(
        [program, "study", "work", directory, "--tasks", tasks, "--results", results, "--threads", "1", "--quiet"],
        capture_output=True,
        text=True,
        check=False,
    )
    return "" if done.returncode == 0 else done.stderr.strip() or f"the worker ended with code {done.returncode}"


def _numbers(tasks: str) -> list[int]:
    """The numbers of "1-3,7"."""
    numbers: list[int] = []
    for part in tasks.split(","):
        first, _, last = part.partition("-")
        numbers += range(int(first), int(last or first) + 1)
    return numbers


def _ranges(numbers: list[int]) -> str:
    """The inverse of _numbers()."""
    parts: list[str] = []
    for n in numbers:
        last = parts[-1].partition("-") if parts else ("", "", "")
        if parts and int(last[2] or last[0]) == n - 1:
            parts[-1] = f"{last[0]}-{n}"
        else:
            parts.append(str(n))
    return ",".join(parts)


def run(
    study: str | os.PathLike[str],
    *,
    client: Any,
    out: str | os.PathLike[str] | None = None,
    chunks_per_worker: int = 4,
    progress: Progress = None,
) -> pathlib.Path:
    """Computes a study on the workers of a client: identify, calibrate or compare-controllers.

    study : path of a study file
    client : dask.distributed.Client; its workers need the folder of the study at the same path, and the same build of Faba
    out : directory of the study; default: runs/NAME. An incomplete study is resumed
    chunks_per_worker : parts into which the open tasks of a round are divided, for each thread of the workers
    progress : function of the number of tasks done and their total, in the present round

    Returns the directory; its files are those of a study without a client, byte for byte. Raises faba.Error with the message of a
    worker if two rounds in succession give no result.
    """
    directory = pathlib.Path(out) if out is not None else pathlib.Path("runs") / pathlib.Path(study).stem
    directory = directory.absolute()
    plan = _program.call(["study", "plan"], [("study", os.path.abspath(study))], {"out": str(directory)})
    failures = 0
    while int(plan.get("open", 0)) > 0:
        numbers = _numbers(str(plan["tasks"]))
        before = len(numbers)
        message = _compute(client, directory, numbers, chunks_per_worker, reporter(progress, "tasks"))
        plan = _program.call(["study", "collect"], [("dir", str(directory))], codes=(0, 10))
        failures = failures + 1 if message and int(plan.get("open", 0)) >= before else 0
        if failures == 2:
            raise _program.error(1, str(directory), message)
    return directory


def _compute(
    client: Any, directory: pathlib.Path, numbers: list[int], chunks: int, progress: Optional[Callable[[int, int], None]]
) -> str:
    """Computes tasks; returns the last message of a worker that failed, or an empty text."""
    distributed: Any = importlib.import_module("distributed")
    workers = max(1, sum(client.nthreads().values()))
    parts = min(len(numbers), max(1, chunks) * workers)
    pieces = [numbers[i::parts] for i in range(parts)]
    stamp = f"{os.getpid()}-{time.time_ns()}"
    futures = {
        client.submit(
            _work, str(_program.PROGRAM), str(directory), _ranges(sorted(piece)),
            str(directory / "results" / f"dask-{stamp}-{i}.results"), pure=False, retries=2,
        ): len(piece)
        for i, piece in enumerate(pieces)
    }
    message, done = "", 0
    for future in distributed.as_completed(futures):
        done += futures[future]
        message = str(future.result()) or message if future.status == "finished" else str(future.exception())
        if progress:
            progress(done, len(numbers))
    return message
