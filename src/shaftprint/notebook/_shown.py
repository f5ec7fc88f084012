"""Nouns that show themselves in a few lines."""

from collections.abc import Iterable
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from shaftprint.notebook._summary import Summary, shortened


class Shown:
    """A noun that a session shows in a few lines and a notebook as a small table.

    A dataclass that derives from it has ``repr=False``, or it would print all of its arrays.
    """

    __slots__ = ()

    def summary(self) -> Summary:
        """Return what matters of it: its fields in a few words each, where a noun does not choose."""
        names = [one.name for one in fields(self)] if is_dataclass(self) else list(getattr(self, "__annotations__", ()))
        facts = {name: _in_brief(getattr(self, name)) for name in names if not name.startswith("_")}
        return Summary(title=type(self).__name__, facts=facts)

    def __repr__(self) -> str:
        """Return a few lines of text."""
        return self.summary().text()

    def __str__(self) -> str:
        """Return the same lines to ``print``."""
        return self.summary().text()

    def _repr_html_(self) -> str:
        """Return a small table, which notebooks show."""
        return self.summary().html()


def _in_brief(value: Any) -> str:
    """Return a value in a few words: a number as it is, an array by its shape, a list by its names or its length."""
    match value:
        case None:
            return ""
        case str():
            return str(value)
        case bool():
            return "yes" if value else "no"
        case int() | float():
            return f"{value:.6g}"
        case np.ndarray():
            return f"array of shape {value.shape}"
        case Shown():
            return value.summary().title
        case dict():
            return shortened(str(key) for key in value)
        case tuple() | list():
            return _of_list(list(value))
        case _:
            return type(value).__name__


def _of_list(values: list[Any]) -> str:
    """Return the names of what a list holds, where all have one; else how many of what they are."""
    names = [value if isinstance(value, str) else getattr(value, "name", None) for value in values]
    if all(isinstance(name, str) for name in names):
        return shortened(str(name) for name in names)
    return f"{len(values)} {type(values[0]).__name__}"


def field_words(names: Iterable[str], foreign: type) -> list[str]:
    """Return the names of an object without the public ones that it has of a library, for completion in a session.

    ``names``: all its names. ``foreign``: the class of the library.
    """
    hidden = {name for name in dir(foreign) if not name.startswith("_")}
    return sorted(set(names) - hidden)
