"""Other names for parameters: what differs from record to record has a name of its own in each."""

import re
from collections.abc import Callable, Mapping
from dataclasses import fields, is_dataclass, replace

from shaftprint.arrays import FloatArray
from shaftprint.errors import StructureError
from shaftprint.models._block import Block
from shaftprint.models._combination import Combination
from shaftprint.models._expression import Expression
from shaftprint.models._parameter import Parameter


def renamed_parameter(parameter: Parameter, names: Mapping[str, str]) -> Parameter:
    """Return a parameter under its new name, if it has one."""
    return replace(parameter, name=names[parameter.name]) if parameter.name in names else parameter


class Renaming:
    """Expressions with other parameter names; what is shared stays shared."""

    def __init__(self, names: Mapping[str, str]) -> None:
        self._names = names
        self._done: dict[int, tuple[Expression, Expression]] = {}

    def of(self, expression: Expression) -> Expression:
        """Return an expression with the new names.

        Raises
        ------
        StructureError
            If a parameter stands in the equations of a diagram, or in a block that is no dataclass.
        """
        if id(expression) not in self._done:
            # the expression is kept with its answer, so that its identity is not given to another
            self._done[id(expression)] = expression, self._renamed(expression)
        return self._done[id(expression)][1]

    def _renamed(self, expression: Expression) -> Expression:
        if not is_dataclass(expression):
            changed = expression
        else:
            values = {one.name: self._value(getattr(expression, one.name)) for one in fields(expression) if one.init}
            changed = replace(expression, **values)
        if isinstance(changed, Block):
            left = [one.name for one in changed.parameters if one.name in self._names]
            if left:
                raise StructureError(
                    f"{left[0]} stands in equations, in which a parameter cannot be renamed; make a second structure "
                    "with the other name in its equations."
                )
        return changed

    def _value(self, value: object) -> object:
        if isinstance(value, Parameter):
            return renamed_parameter(value, self._names)
        if isinstance(value, Expression):
            return self.of(value)
        if isinstance(value, tuple):
            return tuple(self._value(item) for item in value)
        return value


def renamed_combination(
    combination: Combination, names: Mapping[str, str], values: Mapping[str, FloatArray]
) -> Combination:
    """Return a combination of renamed parameters, under a name of its own if one of them is in it.

    Parameters
    ----------
    combination
        The combination, in the former names.
    names
        New names by former ones.
    values
        Every parameter by its former name, for which it is looked which of them the combination is made of.
    """
    concerned = [former for former in names if not _without(combination, values, former)]
    if not concerned:
        return combination
    name = combination.name
    for former in concerned:
        name = re.sub(rf"(?<![\w]){re.escape(former)}(?![\w])", names[former], name)
    if name == combination.name:
        name = f"{name} ({', '.join(names[former] for former in concerned)})"
    return replace(combination, name=name, of=_with_former_names(combination.of, names))


def _without(combination: Combination, values: Mapping[str, FloatArray], former: str) -> bool:
    return combination.is_defined_by({name: value for name, value in values.items() if name != former})


def _with_former_names(
    of: Callable[[Mapping[str, FloatArray]], FloatArray], names: Mapping[str, str]
) -> Callable[[Mapping[str, FloatArray]], FloatArray]:
    def value(values: Mapping[str, FloatArray]) -> FloatArray:
        return of({**values, **{former: values[new] for former, new in names.items() if new in values}})

    return value
