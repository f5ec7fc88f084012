"""The decorator of every function that is compiled."""

import threading
from collections.abc import Callable
from typing import Any

import numba
import numba.core.config

from shaftprint.kernels._folder import private_folder

_CHOOSING = threading.Lock()
_CONFIG: Any = numba.core.config


def compiled(**options: Any) -> Callable[[Callable[..., Any]], Any]:
    """Return a decorator that compiles a function when it is first called, and keeps what was compiled.

    Parameters
    ----------
    options
        Options of ``numba.njit``, without ``cache``: numba would look for a folder by itself, beside the source or in
        the user's home, take one that others can write, and raise where there is none.
    """

    def decorated(function: Callable[..., Any]) -> Any:
        kernel = numba.njit(**options)(function)
        folder = private_folder()
        # with NUMBA_DISABLE_JIT the function stays Python, and there is nothing to keep
        if folder is not None and kernel is not function:
            _keep(kernel, str(folder))
        return kernel

    return decorated


def _keep(function: Any, folder: str) -> None:
    """Let numba keep a compiled function in a folder, and what it compiles for others where it did before."""
    with _CHOOSING:
        before = _CONFIG.CACHE_DIR
        try:
            # where this is set, numba looks nowhere else
            _CONFIG.CACHE_DIR = folder
            function.enable_caching()
        except RuntimeError:
            # a source that is no file, as in a zip archive, has no age: it is compiled in every run
            return
        finally:
            _CONFIG.CACHE_DIR = before
