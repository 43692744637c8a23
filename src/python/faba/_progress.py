"""The progress bar of long calls."""

from __future__ import annotations

import sys
import time
from typing import Callable, Optional, Union

Progress = Union[None, bool, Callable[[int, int], None]]
_FIRST, _WIDTH = 1.0, 24  # s before a bar appears; characters


class _Bar:
    def __init__(self, name: str) -> None:
        self._name, self._start, self._shown = name, time.monotonic(), False

    def __call__(self, done: int, total: int) -> None:
        elapsed = time.monotonic() - self._start
        if elapsed < _FIRST or total <= 0:
            return
        if done >= total:
            if self._shown:
                sys.stderr.write("\r" + " " * 78 + "\r")
            return
        self._shown = True
        filled = _WIDTH * done // total
        left = elapsed * (total - done) / done if done else float("inf")
        eta = f"{left:.0f} s left" if done else ""
        sys.stderr.write(f"\r{self._name} [{'#' * filled}{'.' * (_WIDTH - filled)}] {100 * done // total} % {eta}   ")
        sys.stderr.flush()


def reporter(progress: Progress, name: str) -> Optional[Callable[[int, int], None]]:
    """The function that is called with the progress. None: a bar if standard error is a terminal; True: always; False: nothing."""
    if callable(progress):
        return progress
    shown = sys.stderr.isatty() if progress is None else progress
    return _Bar(name) if shown else None
