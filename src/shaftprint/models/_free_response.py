"""What a structure shows without any input: how it goes on from the state in which a record finds it.

The Fourier transform of an output over a record that does not begin and end in the same state is::

    Y(s) = G(s) U(s) + sum_j c_j F_j(s),   s = 1j omega,  omega a multiple of 2 pi over the length of the record

with real numbers ``c_j``, differences between the states at begin and end (Pintelon and Schoukens, System
Identification: A Frequency Domain Approach, second edition, chapter 2 and appendix 2.B). A rational block ``N / D`` of
order ``n`` goes on with ``s^j / D``, ``j < n``. A delay goes on with what is under way in it, here a constant and a
line; any other block ``H`` as if its input had been constant before, ``(H(0) - H(s)) / s``. What lies behind in the
signal's way passes it on: a free response in a loop of gain ``L`` is multiplied by ``1 / (1 + L)``.

In which order the signal meets two blocks in series is not written in a product. It is taken from left to right, but
through a closed loop first; for the other order the span of the free responses is the same up to what happens
within one delay.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.models._block import Block
from shaftprint.models._delays import Delay
from shaftprint.models._expression import Expression, Inverse, Parallel, Sensitivity, Series
from shaftprint.models._parameter import Parameter
from shaftprint.models._structure import Structure

# Share of a parameter by which it is moved to see how coefficients change: exact but for rounding up to second order.
STEP = 1e-4
# Laplace variable [rad/s] near zero, where some blocks have no value.
AROUND_ZERO = np.array([-1e-4, 1e-4], dtype=np.complex128)
# Below this argument cosh(x) - sinh(x) / x loses its digits.
SERIES_BELOW = 0.02


@dataclass(frozen=True, slots=True, eq=False)
class RationalFreeResponse(Block):
    """Free response ``s^j / D(s)`` of a rational block."""

    of: Block
    power: int

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """Those of the block."""
        return self.of.parameters

    def transfer(self, s: ComplexArray, *values: FloatArray) -> ComplexArray:
        """Return ``s^j / D``."""
        return np.asarray(s**self.power / _polynomial(self._lower(values), s))

    def derivatives(self, s: ComplexArray, response: ComplexArray, *values: FloatArray) -> tuple[ComplexArray, ...]:
        """Return ``-s^j dD / D^2``; coefficients of ``D`` are of second order in a parameter, or nearly."""
        share = -response / _polynomial(self._lower(values), s)
        return tuple(share * _polynomial(self._change(values, index), s) for index in range(len(values)))

    def _lower(self, values: tuple[FloatArray, ...]) -> FloatArray:
        """Return the coefficients of ``D``, highest power first, shape (..., coefficients)."""
        rows = np.stack(np.broadcast_arrays(*values)) if values else np.empty((0, 1))
        flat = rows.reshape(len(values), -1).T
        ratios = [self.of.ratio(*row) for row in flat.tolist()]
        return np.reshape([ratio[1] for ratio in ratios if ratio is not None], (*rows.shape[1:-1], -1))

    def _change(self, values: tuple[FloatArray, ...], index: int) -> FloatArray:
        parameter, value = self.parameters[index], values[index]
        step = STEP * np.maximum(np.abs(value), STEP * (parameter.upper - parameter.lower))

        def at(steps: float) -> FloatArray:
            return self._lower((*values[:index], value + steps * step, *values[index + 1 :]))

        return np.asarray((at(1.0) - at(-1.0)) / (2.0 * step))


def _polynomial(coefficients: FloatArray, s: ComplexArray) -> ComplexArray:
    """Return a polynomial of coefficients (..., powers), highest first, at every ``s``."""
    value: ComplexArray = np.zeros((*coefficients.shape[:-1], s.size), dtype=np.complex128)
    value += coefficients[..., :1]
    for power in range(1, coefficients.shape[-1]):
        value = value * s + coefficients[..., power : power + 1]
    return value


@dataclass(frozen=True, slots=True, eq=False)
class DelayFreeResponse(Block):
    """Free response of a delay ``t`` in which a constant is under way, or a line about the middle of what is.

    With ``x = s t / 2``: ``exp(-x) sinh(x) / x`` is ``(1 - exp(-s t)) / (s t)``, and ``s exp(-x) k(x)`` with
    ``k(x) = (cosh(x) - sinh(x) / x) / x^2``. Both keep their digits, and their directions, down to a delay of zero.
    """

    of: Delay
    line: bool = False
    """Whether it is the line."""

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """The delay."""
        return self.of.parameters

    def transfer(self, s: ComplexArray, *values: FloatArray) -> ComplexArray:
        """Return the free response."""
        x = 0.5 * s * values[0]
        level, tilt, _ = _averages(x)
        return np.asarray(np.exp(-x) * (s * tilt if self.line else level))

    def derivatives(self, s: ComplexArray, response: ComplexArray, *values: FloatArray) -> tuple[ComplexArray, ...]:
        """Return ``s / 2 exp(-x) (x k - sinh(x) / x)``, or ``s^2 / 2 exp(-x) (k' - k)``."""
        x = 0.5 * s * values[0]
        level, tilt, slope = _averages(x)
        change = s * (slope - tilt) if self.line else x * tilt - level
        return (np.asarray(0.5 * s * np.exp(-x) * change),)


def _averages(x: ComplexArray) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
    """Return ``sinh(x) / x``, ``k(x) = (cosh(x) - sinh(x) / x) / x^2`` and ``k'``, by their series near zero."""
    square = x * x
    small = np.abs(x) < SERIES_BELOW
    far = np.where(small, 1.0, x)
    level = np.sinh(far) / far
    tilt = (np.cosh(far) - level) / far**2
    return (
        np.where(small, 1.0 + square / 6.0 * (1.0 + square / 20.0), level),
        np.where(small, (1.0 + square / 10.0 * (1.0 + square / 28.0)) / 3.0, tilt),
        np.where(small, x / 15.0 * (1.0 + square / 14.0), (level - 3.0 * tilt) / far),
    )


@dataclass(frozen=True, slots=True, eq=False)
class DriftingFreeResponse(Block):
    """Free response ``(H(0) - H(s)) / s`` of a block whose input was constant."""

    of: Block

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """Those of the block."""
        return self.of.parameters

    def transfer(self, s: ComplexArray, *values: FloatArray) -> ComplexArray:
        """Return the free response."""
        return _gone(s, self.of.transfer(s, *values), self.of.transfer(AROUND_ZERO, *values))

    def derivatives(self, s: ComplexArray, response: ComplexArray, *values: FloatArray) -> tuple[ComplexArray, ...]:
        """Return the same of the derivatives of ``H``."""
        there = self.of.derivatives(s, self.of.transfer(s, *values), *values)
        near = self.of.derivatives(AROUND_ZERO, self.of.transfer(AROUND_ZERO, *values), *values)
        return tuple(_gone(s, one, other) for one, other in zip(there, near, strict=True))


def _gone(s: ComplexArray, there: ComplexArray, near: ComplexArray) -> ComplexArray:
    return np.asarray((near.mean(axis=-1, keepdims=True) - there) / s)


def free_responses(structure: Structure) -> tuple[Structure, tuple[int, ...]]:
    """Return a structure whose outputs are the free responses of every channel, and the channel of each.

    Every channel has its own, with sizes of their own: more than the states of a minimal realisation, but their span
    holds all that the structure can show without input.

    ``structure``: structure with one input; parameters, ties and factors are kept. Returns the structure of free
    responses, with the parameters in the same order, and the place of the channel that each of its outputs belongs to.
    """
    finder = _Finder(
        values={name: float(value) for name, value in structure.named(structure.vector({})).items()},
        held=frozenset(parameter.name for parameter in structure.parameters if parameter.held),
    )
    outputs: dict[str, Expression] = {}
    channels: list[int] = []
    for channel, path in enumerate(structure.paths):
        for number, shape in enumerate(finder.free(path)):
            outputs[f"{structure.channels[channel][0]} free {number + 1}"] = shape
            channels.append(channel)
    return replace(structure, outputs=outputs, combinations=()), tuple(channels)


@dataclass(frozen=True, slots=True)
class _Finder:
    """Finds the free responses of expressions of one structure."""

    values: Mapping[str, float]
    """Value of every parameter by name."""
    held: frozenset[str]
    """Names of the parameters that stay as they are."""

    known: dict[int, tuple[Expression, ...]] = field(default_factory=dict)
    """Free responses by node: what two outputs have in common is evaluated once."""

    def free(self, node: Expression) -> tuple[Expression, ...]:
        """Return the free responses of an expression at its output."""
        if id(node) not in self.known:
            self.known[id(node)] = tuple(self._found(node))
        return self.known[id(node)]

    def _found(self, node: Expression) -> Iterator[Expression]:
        if isinstance(node, Block):
            yield from self._of_block(node)
        elif isinstance(node, Series):
            yield from self._of_series(node)
        elif isinstance(node, Parallel):
            yield from self.free(node.first)
            yield from self.free(node.second)
        elif isinstance(node, Inverse):
            yield from (Series(shape, node) for shape in self.free(node.of))
        elif isinstance(node, Sensitivity):
            yield from (Series(shape, node) for shape in self.free(node.loop))

    def _of_series(self, node: Series) -> Iterator[Expression]:
        first, second = node.first, node.second
        back = second.behind(first) if isinstance(second, Sensitivity) else None
        if back is not None:
            yield from (Series(shape, second) for shape in self.free(first))
            yield from (Series(shape, node) for expression in back for shape in self.free(expression))
            return
        if _closes_a_loop(second) and not _closes_a_loop(first):
            first, second = second, first
        yield from self.free(second)
        yield from (Series(shape, second) for shape in self.free(first))

    def _of_block(self, block: Block) -> Iterator[Block]:
        values = [self.values[parameter.name] for parameter in block.parameters]
        held = all(parameter.name in self.held for parameter in block.parameters)
        ratio = block.ratio(*values)
        if ratio is not None:
            top, bottom = (np.trim_zeros(part, "f") if held else part for part in ratio)
            order = max(len(top), len(bottom)) - 1
            yield from (RationalFreeResponse(block, power) for power in range(order))
        elif not (held and values and not any(values)):
            if isinstance(block, Delay):
                yield from (DelayFreeResponse(block), DelayFreeResponse(block, line=True))
            else:
                yield DriftingFreeResponse(block)


def _closes_a_loop(node: Expression) -> bool:
    return any(isinstance(inner, Sensitivity) for inner in node.nodes())
