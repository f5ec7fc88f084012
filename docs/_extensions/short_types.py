"""Types of arrays under the names by which the code calls them, instead of what these stand for."""

import sys
from collections.abc import Callable
from typing import Any

import numpy.typing as npt
from sphinx.application import Sphinx
from sphinx.util import typing as sphinx_typing

from shaftprint import arrays

NAMES = {
    name: value for name, value in vars(arrays).items() if name.endswith("Array") and not isinstance(value, type)
} | {"ArrayLike": npt.ArrayLike}
HOMES = {name: "numpy.typing" if name == "ArrayLike" else "shaftprint.arrays" for name in NAMES}


def with_names(plain: Callable[..., str]) -> Callable[..., str]:
    """Return a writer of annotations that knows the names of array types, alone and as members of a union."""
    spelled: dict[str, dict[str, str]] = {}

    def written(annotation: Any, /, *given: Any, **more: Any) -> str:
        found, key = plain(annotation, *given, **more), repr((given, more))
        if key not in spelled:
            # the writer asks itself for the parts of a type, which are to stay as they are here
            spelled[key] = {}
            spelled[key] = {plain(meant, *given, **more): f"~{HOMES[name]}.{name}" for name, meant in NAMES.items()}
        for text, name in spelled[key].items():
            found = found.replace(text, name)
        return found

    return written


def made_each_time(
    app: Sphinx, what: str, name: str, value: object, options: object, signature: str | None, returned: str | None
) -> tuple[str | None, str | None]:
    """Write a default that is made anew each time as ``...``: the marker of dataclasses is no Python."""
    return (None if signature is None else signature.replace("<factory>", "...")), returned


def setup(app: Sphinx) -> dict[str, bool]:
    """Put the writer where Sphinx looks for its own."""
    plain = sphinx_typing.stringify_annotation
    for module in [module for name, module in sys.modules.items() if name.startswith("sphinx.")]:
        if getattr(module, "stringify_annotation", None) is plain:
            module.stringify_annotation = with_names(plain)
    app.connect("autodoc-process-signature", made_each_time)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
