"""Other names for parameters: what differs from record to record has a name of its own in each."""

import re
from collections.abc import Callable, Mapping
from dataclasses import fields, is_dataclass, replace
from typing import Protocol, runtime_checkable

from shaftprint.arrays import FloatArray
from shaftprint.errors import StructureError
from shaftprint.models._block import Block
from shaftprint.models._combination import Combination
from shaftprint.models._expression import Expression
from shaftprint.models._parameter import Parameter
from shaftprint.models._tied_parameter import Tie


@runtime_checkable
class HasNames(Protocol):
    """Equations that several blocks share, which know their parameters under other names."""

    def renamed(self, names: Mapping[str, str]) -> "HasNames":
        """Return them with other names."""
        ...


class Renaming:
    """The parts of a structure with other parameter names; what expressions share stays shared."""

    def __init__(self, names: Mapping[str, str]) -> None:
        self._names = names
        self._done: dict[int, tuple[Expression, Expression]] = {}
        self._shared: dict[int, tuple[HasNames, HasNames]] = {}

    def parameter(self, one: Parameter) -> Parameter:
        """Return a parameter under its new name, if it has one."""
        return replace(one, name=self._names[one.name]) if one.name in self._names else one

    def tie(self, tie: Tie) -> Tie:
        """Return a tie that follows from the new names."""
        return replace(tie, arguments=tuple(self._names.get(one, one) for one in tie.arguments))

    def keys(self, numbers: Mapping[str, float]) -> dict[str, float]:
        """Return numbers of parameters by their new names."""
        return {self._names.get(name, name): value for name, value in numbers.items()}

    def combination(self, one: Combination, values: Mapping[str, FloatArray]) -> Combination:
        """Return a combination, under a name of its own if a renamed parameter is in it.

        ``one``: the combination, in the former names. ``values``: every parameter by its former name, for which it is
        looked which of them the combination is made of.
        """
        return _renamed_combination(one, self._names, values)

    def of(self, expression: Expression) -> Expression:
        """Return an expression with the new names.

        Raises StructureError if a parameter stands in a block that is no dataclass.
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
            return self.parameter(value)
        if isinstance(value, Expression):
            return self.of(value)
        if isinstance(value, HasNames):
            if id(value) not in self._shared:
                self._shared[id(value)] = value, value.renamed(self._names)
            return self._shared[id(value)][1]
        if isinstance(value, tuple):
            return tuple(self._value(item) for item in value)
        return value


def _renamed_combination(
    combination: Combination, names: Mapping[str, str], values: Mapping[str, FloatArray]
) -> Combination:
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
