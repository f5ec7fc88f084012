"""Options that a command takes as one record."""

from collections.abc import Callable, Sequence
from dataclasses import fields
from functools import wraps
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

Command = Callable[..., Any]


def gathered_options(
    record: "type[DataclassInstance]", options: Sequence[Callable[[Command], Command]], *, name: str = "options"
) -> Callable[[Command], Command]:
    """Return what adds options to a command, which takes their values as one record.

    Parameters
    ----------
    record
        A dataclass whose fields have the names of the options' values.
    options
        Decorators, each of one option, in the order of the help text.
    name
        Name under which the command takes the record.
    """
    names = [field.name for field in fields(record)]

    def add(command: Command) -> Command:
        @wraps(command)
        def gathered(**values: Any) -> Any:
            return command(**{name: record(**{field: values.pop(field) for field in names})}, **values)

        wrapped: Command = gathered
        for option in reversed(options):
            wrapped = option(wrapped)
        return wrapped

    return add
