"""A cause of drift with a size, as options take them."""

from __future__ import annotations

import click

from shaftprint.late import late

with late():
    from shaftprint.drift import _causes
    from shaftprint.drift._causes import Cause


class CauseSize(click.ParamType):  # type: ignore[type-arg]
    """A cause and a size of it, such as ``propeller=10%``; of an engine, a motor or both."""

    name = "size"

    def convert(
        self, value: object, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[tuple[Cause, ...], float]:
        """Return the cause, one for each machine that has it by another name, and the size, a share or a time [s]."""
        word, _, size = str(value).partition("=")
        found = tuple(cause for cause in _causes.ALL_CAUSES if word and cause.name.startswith(word.strip()))
        machines = [cause.machine for cause in found]
        if not found or (len(found) > 1 and (None in machines or len(set(machines)) < len(found))):
            names = ", ".join(cause.name for cause in _causes.ALL_CAUSES)
            self.fail(f"expected the beginning of one of {names}, found {word!r}.", param, ctx)
        cause = found[0]
        number = size.strip().removesuffix(cause.unit)
        try:
            return found, cause.from_unit(float(number))
        except ValueError:
            self.fail(f"expected a number of {cause.unit} after {word}=, found {size!r}.", param, ctx)
