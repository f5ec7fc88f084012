"""Arguments that a public function cannot do without."""

import functools
import inspect
from collections.abc import Callable
from typing import ParamSpec, TypeVar

_OPEN = (inspect.Parameter.VAR_POSITIONAL, inspect.Parameter.VAR_KEYWORD)

_Given = ParamSpec("_Given")
_Result = TypeVar("_Result")


def refusing_none(
    error: type[Exception], **remedies: str
) -> Callable[[Callable[_Given, _Result]], Callable[_Given, _Result]]:
    """Return a decorator that refuses an argument that is left out or None, before anything else is done.

    In an interactive session None is what a name holds that was never set, and would otherwise end far inside in an
    attribute that None lacks.

    Parameters
    ----------
    error
        What is raised, with one sentence.
    remedies
        What to give, by argument, in words.
    """

    def decorated(verb: Callable[_Given, _Result]) -> Callable[_Given, _Result]:
        signature = inspect.signature(verb)
        kinds = {
            name: str(parameter.annotation if isinstance(parameter.annotation, str) else _name(parameter.annotation))
            for name, parameter in signature.parameters.items()
            if parameter.default is inspect.Parameter.empty and parameter.kind not in _OPEN
        }

        @functools.wraps(verb)
        def checked(*args: _Given.args, **kwargs: _Given.kwargs) -> _Result:
            arguments = signature.bind_partial(*args, **kwargs).arguments
            missing = [name for name in kinds if arguments.get(name) is None]
            if missing:
                expected = " and ".join(f"{name} ({kinds[name]})" for name in missing)
                found = "None" if any(name in arguments for name in missing) else "nothing"
                give = "; ".join(remedies[name] for name in missing if name in remedies)
                remedy = give or f"{'they' if len(missing) > 1 else 'it'} cannot be left out"
                raise error(f"{verb.__name__}: expected {expected}, found {found}; {remedy}.")
            return verb(*args, **kwargs)

        return checked

    return decorated


def _name(annotation: object) -> str:
    """Return a type as it is written, without its module."""
    if isinstance(annotation, type):
        return annotation.__name__
    last = str(annotation).rsplit(".", 1)[-1]
    return last if "[" in last else last.rstrip("]")
