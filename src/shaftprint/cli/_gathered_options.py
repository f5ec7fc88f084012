"""Options that a command takes as one record."""

from collections.abc import Callable, Sequence
from functools import wraps
from typing import Any

Command = Callable[..., Any]


def gathered_options(
    build: Callable[..., Any], options: Sequence[Callable[[Command], Command]], *, name: str = "options"
) -> Callable[[Command], Command]:
    """Return what adds options to a command, which takes their values as one record.

    ``build``: makes the record of the values, which have the names of the options. ``options``: Decorators, each of one
    option, in the order of the help text. ``name``: name under which the command takes the record.
    """

    def add(command: Command) -> Command:
        @wraps(command)
        def gathered(**values: Any) -> Any:
            return command(**{name: build(**{one: values.pop(one) for one in names})}, **values)

        wrapped: Command = gathered
        before = len(vars(gathered).get("__click_params__", ()))
        for option in reversed(options):
            wrapped = option(wrapped)
        names = [parameter.name for parameter in vars(gathered)["__click_params__"][before:]]
        return wrapped

    return add
