"""Registers the environments with Gymnasium, without importing it before the user does."""

from __future__ import annotations

import importlib.abc
import importlib.machinery
import importlib.util
import sys
import types
from typing import Any, Sequence

NAMES = ("Hold", "Route", "Gather")


def register() -> None:
    """Adds faba/Hold-v0, faba/Route-v0 and faba/Gather-v0 to Gymnasium, which must be imported."""
    gymnasium: Any = sys.modules["gymnasium"]
    for name in NAMES:
        gymnasium.register(
            id=f"faba/{name}-v0",
            entry_point=f"faba.environments:{name}Env",
            vector_entry_point=f"faba.environments:{name}VectorEnv",
        )


class _AfterImport(importlib.abc.MetaPathFinder):
    """Calls register() at the end of the first import of Gymnasium."""

    def __init__(self) -> None:
        self._searching = False

    def find_spec(
        self, name: str, path: Sequence[str] | None, target: types.ModuleType | None = None
    ) -> importlib.machinery.ModuleSpec | None:
        if name != "gymnasium" or self._searching:
            return None
        self._searching = True  # the other finders are asked
        try:
            spec = importlib.util.find_spec(name)
        finally:
            self._searching = False
        if spec is None or spec.loader is None:
            return spec
        execute = spec.loader.exec_module

        def execute_and_register(module: types.ModuleType) -> None:
            execute(module)
            if self in sys.meta_path:
                sys.meta_path.remove(self)
                register()

        setattr(spec.loader, "exec_module", execute_and_register)
        return spec


def register_lazily() -> None:
    if hasattr(sys.modules.get("gymnasium"), "register"):
        register()
    else:
        sys.meta_path.insert(0, _AfterImport())
