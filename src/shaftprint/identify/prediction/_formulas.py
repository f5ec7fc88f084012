"""Formulas in the parameters' names: sums, differences, and products of their powers."""

import re
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from shaftprint.arrays import FloatArray

Value = Callable[[Mapping[str, FloatArray]], FloatArray]


@dataclass(frozen=True, kw_only=True, slots=True)
class FormulaTerm:
    """A factor of a formula: a parameter, a sum or difference of two, or a number minus or plus a parameter."""

    name: str
    """Its formula."""
    unit: str
    """Its unit."""
    of: Value
    """Its value from the parameters' values."""
    parts: int
    """Number of numbers and parameters in it."""
    order: int
    """Place among the terms."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ParameterFormula:
    """A product of powers of terms."""

    factors: tuple[tuple[FormulaTerm, int], ...]
    """Terms with their powers, 1 or 2, negative below the line."""

    @property
    def name(self) -> str:
        """The formula as it is written, such as ``v K_p / (tau_up + tau_dn)``."""
        above = [(term, power) for term, power in self.factors if power > 0]
        below = [(term, -power) for term, power in self.factors if power < 0]
        if not below:
            return _product(above, bracket=len(above) > 1)
        line = f"({_product(below)})" if len(below) > 1 else _product(below)
        return f"{_product(above) or '1'} / {line}"

    @property
    def unit(self) -> str:
        """Its unit."""
        return unit_of(*((term.unit, power) for term, power in self.factors))

    @property
    def cost(self) -> tuple[int, ...]:
        """How much there is to read: formulas are tried in this order."""
        return (
            len(self.factors),
            sum(term.parts - 1 for term, _ in self.factors),
            sum(abs(power) - 1 for _, power in self.factors),
            *(term.order for term, _ in self.factors),
        )

    def of(self, values: Mapping[str, FloatArray]) -> FloatArray:
        """Return its value from the parameters' values."""
        (first, power), *others = self.factors
        product: FloatArray = first.of(values) ** float(power)
        for term, power in others:
            product = product * term.of(values) ** float(power)
        return product


def single(name: str, unit: str, *, order: int) -> FormulaTerm:
    """Return the term of one parameter."""
    return FormulaTerm(name=name, unit=unit, of=lambda values: values[name], parts=1, order=order)


def sum_of(first: FormulaTerm, second: FormulaTerm, sign: int, *, order: int) -> FormulaTerm:
    """Return the sum or, for the sign -1, the difference of two terms."""
    return FormulaTerm(
        name=f"{first.name} {'+' if sign > 0 else '-'} {second.name}",
        unit=first.unit,
        of=lambda values: first.of(values) + sign * second.of(values),
        parts=first.parts + second.parts,
        order=order,
    )


def number(value: float, unit: str) -> FormulaTerm:
    """Return the term of a known number; it prints as the number."""
    return FormulaTerm(name=f"{value:g}", unit=unit, of=lambda values: value, parts=1, order=-1)  # type: ignore[arg-type,return-value]


def product_of(first: FormulaTerm, second: FormulaTerm) -> FormulaTerm:
    """Return the product of two terms as a term of its own, to be added to another."""
    square = first is second
    return FormulaTerm(
        name=f"{first.name}^2" if square else _product([(first, 1), (second, 1)]),
        unit=unit_of((first.unit, 1), (second.unit, 1)),
        of=lambda values: first.of(values) * second.of(values),
        parts=first.parts + second.parts,
        order=first.order,
    )


def _product(factors: Sequence[tuple[FormulaTerm, int]], *, bracket: bool = True) -> str:
    # Gains such as v stand before what they multiply, as in v K_p: small letters before capitals.
    ordered = sorted(factors, key=lambda factor: (factor[0].name[:1].isupper(), factor[0].order))
    return " ".join(_power(term, power, bracket=bracket) for term, power in ordered)


def _power(term: FormulaTerm, power: int, *, bracket: bool) -> str:
    name = f"({term.name})" if term.parts > 1 and (bracket or power > 1) else term.name
    return f"{name}^{power}" if power > 1 else name


def unit_of(*powers: tuple[str, int]) -> str:
    """Return the unit of a product of powers of units; an angle in rad is a plain number."""
    if len(powers) == 1 and powers[0][1] == 1:
        return powers[0][0]
    total: Counter[str] = Counter()
    for unit, power in powers:
        for name, exponent in _parsed(unit).items():
            total[name] += power * exponent
    above = " ".join(_unit_power(name, power) for name, power in total.items() if power > 0)
    below = [_unit_power(name, -power) for name, power in total.items() if power < 0]
    if not below:
        return above or "-"
    return f"{above or '1'}/{below[0] if len(below) == 1 else '(' + ' '.join(below) + ')'}"


def _parsed(unit: str) -> dict[str, int]:
    """Return the powers of the unit names in a unit such as ``N m s/rad`` or ``kg m2``."""
    above, _, below = unit.partition("/")
    powers: Counter[str] = Counter()
    for text, sign in ((above, 1), (below, -1)):
        for name, power in re.findall(r"([^\W\d]+|%|°)(\d*)", text):
            powers[name] += sign * int(power or 1)
    return {name: power for name, power in powers.items() if name != "rad"}


def _unit_power(name: str, power: int) -> str:
    return f"{name}{power}" if power > 1 else name
