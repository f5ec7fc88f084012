"""Imports that are made when what they bring is first used, so that a command loads what it does, and no more.

A file says which they are in one block, and evaluates no annotation that names them::

    from __future__ import annotations

    with late():
        import numpy as np

        from shaftprint.survey._survey import run

Until ``run`` is called, it is a ``Late`` that knows where it comes from; then it is loaded, and takes that place in the
file. Functions may call such a name and take attributes of it; nothing else, as it is something else before.
``tests/test_late.py`` holds every file to that.
"""

import builtins
import importlib
import sys
import threading
from collections.abc import Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager
from typing import Any

# nothing is loaded inside a block, so none waits for another for long
_ONE_AFTER_THE_OTHER = threading.Lock()


class Late:
    """What a name stands for until it is used."""

    __slots__ = ("_module", "_name", "_names")

    def __init__(self, module: str, name: str | None, names: dict[str, Any]) -> None:
        self._module = module
        self._name = name
        self._names = names

    def __call__(self, *arguments: Any, **options: Any) -> Any:
        """Load what is meant, and call it."""
        return self._loaded()(*arguments, **options)

    def __getattr__(self, attribute: str) -> Any:
        """Load what is meant, and ask it."""
        if attribute.startswith("__"):
            # what copy, inspect and doctest ask everything for that they find in a file
            raise AttributeError(attribute)
        return getattr(self._loaded(), attribute)

    def _loaded(self) -> Any:
        """Import what is meant, and put it into the file that asked for it."""
        meant: Any = importlib.import_module(self._module)
        if self._name is not None:
            try:
                meant = getattr(meant, self._name)
            except AttributeError:
                # a file of a room, which the room itself does not name
                meant = importlib.import_module(f"{self._module}.{self._name}")
        for name in [name for name, value in self._names.items() if value is self]:
            self._names[name] = meant
        return meant


class _Source:
    """A module from which names are taken late."""

    def __init__(self, module: str, names: dict[str, Any]) -> None:
        self._module = module
        self._names = names

    def __getattr__(self, name: str) -> Late:
        return Late(self._module, name, self._names)


def late() -> AbstractContextManager[None]:
    """Make the imports of a block late: those that stand in it, and no others of threads beside it."""
    return _deferring(sys._getframe(1).f_globals)


@contextmanager
def _deferring(names: dict[str, Any]) -> Iterator[None]:
    def deferred(
        name: str,
        globals: Mapping[str, object] | None = None,
        locals: Mapping[str, object] | None = None,
        fromlist: Sequence[str] | None = (),
        level: int = 0,
    ) -> Any:
        if globals is not names:
            return before(name, globals, locals, fromlist or (), level)
        return _Source(name, names) if fromlist else Late(name, None, names)

    with _ONE_AFTER_THE_OTHER:
        before = builtins.__import__
        builtins.__import__ = deferred
        try:
            yield
        finally:
            builtins.__import__ = before
