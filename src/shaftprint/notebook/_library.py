"""Packages that only some users need."""

import importlib
from typing import Any

from shaftprint.errors import ExportError


def library(name: str, verb: str) -> Any:
    """Return an optional package, which has an extra of its name.

    ``name``: the package. ``verb``: what needs it. Raises ExportError if it is not installed.
    """
    try:
        return importlib.import_module(name)
    except ImportError:
        raise ExportError(f'{verb} needs the package {name}: pip install "shaftprint[{name}]".') from None
