"""The decorator of every function that is compiled."""

import functools
import importlib
import threading
from collections.abc import Callable, Iterator
from types import CodeType
from typing import Any

from shaftprint.kernels._folder import private_folder

# x / 0 is inf or nan, as with arrays, not an error that each division looks for: a quarter of the time of a ship
_PLAIN_DIVISION = {"error_model": "numpy"}
# one kernel is made from another, and several threads may ask for the same
_MAKING = threading.RLock()


class Kernel:
    """A function that is compiled when it is first called: numba, which takes half a second to load, is loaded then."""

    py_func: Callable[..., Any]
    """The function as it was written."""

    def __init__(self, function: Callable[..., Any], options: dict[str, Any]) -> None:
        functools.update_wrapper(self, function)
        self.py_func = function
        self._options = options
        self._made: Callable[..., Any] | None = None

    def __call__(self, *arguments: Any) -> Any:
        """Compile the function if it is not, and call it."""
        return (self._made or self.made())(*arguments)

    def made(self) -> Callable[..., Any]:
        """Return what numba makes of the function, and of those kernels that it calls."""
        with _MAKING:
            if self._made is None:
                _make_what_it_calls(self.py_func)
                self._made = _kept(self.py_func, self._options)
            return self._made


def compiled(**options: Any) -> Callable[[Callable[..., Any]], Any]:
    """Return a decorator that compiles a function when it is first called, and keeps what was compiled.

    ``options``: options of ``numba.njit``, without ``cache``: numba would look for a folder by itself, beside the
    source or in the user's home, take one that others can write, and raise where there is none.
    """
    return lambda function: Kernel(function, {**_PLAIN_DIVISION, **options})


def _make_what_it_calls(function: Any) -> None:
    """Put what numba can call in place of the kernels that a function calls by their names."""
    names = function.__globals__
    for name in _names_in(function.__code__):
        if isinstance(names.get(name), Kernel):
            names[name] = names[name].made()


def _names_in(code: CodeType) -> Iterator[str]:
    yield from code.co_names
    for inner in code.co_consts:
        if isinstance(inner, CodeType):
            yield from _names_in(inner)


def _kept(function: Callable[..., Any], options: dict[str, Any]) -> Any:
    """Return a compiled function whose code is kept where nobody but the user can have put it."""
    numba: Any = importlib.import_module("numba")
    kernel = numba.njit(**options)(function)
    folder = private_folder()
    # with NUMBA_DISABLE_JIT the function stays Python, and there is nothing to keep
    if folder is not None and kernel is not function:
        _keep(kernel, str(folder), numba.core.config)
    return kernel


def _keep(function: Any, folder: str, config: Any) -> None:
    """Let numba keep a compiled function in a folder, and what it compiles for others where it did before."""
    before = config.CACHE_DIR
    try:
        # where this is set, numba looks nowhere else
        config.CACHE_DIR = folder
        function.enable_caching()
    except RuntimeError:
        # a source that is no file, as in a zip archive, has no age: it is compiled in every run
        return
    finally:
        config.CACHE_DIR = before
