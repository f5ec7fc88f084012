"""What a structure shows without any input: how it goes on from the state in which a record finds it.

The Fourier transform of an output over a record that does not begin and end in the same state is::

    Y(s) = G(s) U(s) + sum_j c_j F_j(s),   s = 1j omega,  omega a multiple of 2 pi over the length of the record

with real numbers ``c_j``, differences between the states at begin and end (Pintelon and Schoukens, System
Identification: A Frequency Domain Approach, second edition, chapter 2 and appendix 2.B). A rational block ``N / D`` of
order ``n`` goes on with ``s^j / D``, ``j < n``. A delay goes on with what is under way in it: a constant gives
``(1 - exp(-s t)) / s``, and any block ``H`` that has had a constant input before gives ``(H(0) - H(s)) / s``; a line
adds ``(H(s) - H(0) - s H'(0)) / s^2``. What lies behind in the signal's way passes it on: a free response in a loop
of gain ``L`` is multiplied by ``1 / (1 + L)``.

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
# Laplace variable [rad/s] that stands for zero, and step of a slope there.
NEAR_ZERO = 1e-4
AROUND_ZERO = np.array([-NEAR_ZERO, NEAR_ZERO], dtype=np.complex128)


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
        return tuple(share * _polynomial(self._change(values, place), s) for place in range(len(values)))

    def _lower(self, values: tuple[FloatArray, ...]) -> FloatArray:
        """Return the coefficients of ``D``, highest power first, shape (..., coefficients)."""
        rows = np.stack(np.broadcast_arrays(*values)) if values else np.empty((0, 1))
        flat = rows.reshape(len(values), -1).T
        ratios = [self.of.ratio(*row) for row in flat.tolist()]
        return np.reshape([ratio[1] for ratio in ratios if ratio is not None], (*rows.shape[1:-1], -1))

    def _change(self, values: tuple[FloatArray, ...], place: int) -> FloatArray:
        parameter, value = self.parameters[place], values[place]
        step = STEP * np.maximum(np.abs(value), STEP * (parameter.upper - parameter.lower))

        def at(steps: float) -> FloatArray:
            return self._lower((*values[:place], value + steps * step, *values[place + 1 :]))

        return np.asarray((at(1.0) - at(-1.0)) / (2.0 * step))


def _polynomial(coefficients: FloatArray, s: ComplexArray) -> ComplexArray:
    """Return a polynomial of coefficients (..., powers), highest first, at every ``s``."""
    found: ComplexArray = np.zeros((*coefficients.shape[:-1], s.size), dtype=np.complex128)
    found += coefficients[..., :1]
    for power in range(1, coefficients.shape[-1]):
        found = found * s + coefficients[..., power : power + 1]
    return found


@dataclass(frozen=True, slots=True, eq=False)
class DriftingFreeResponse(Block):
    """Free response of a block whose input was constant, ``(H(0) - H(s)) / s``, or a line."""

    of: Block
    line: bool = False
    """Whether the input was a line: ``(H(s) - H(0) - s H'(0)) / s^2``."""

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """Those of the block."""
        return self.of.parameters

    def transfer(self, s: ComplexArray, *values: FloatArray) -> ComplexArray:
        """Return the free response."""
        return self._gone(s, self.of.transfer(s, *values), self.of.transfer(AROUND_ZERO, *values))

    def derivatives(self, s: ComplexArray, response: ComplexArray, *values: FloatArray) -> tuple[ComplexArray, ...]:
        """Return the same of the derivatives of ``H``."""
        there = self.of.derivatives(s, self.of.transfer(s, *values), *values)
        near = self.of.derivatives(AROUND_ZERO, self.of.transfer(AROUND_ZERO, *values), *values)
        return tuple(self._gone(s, one, other) for one, other in zip(there, near, strict=True))

    def _gone(self, s: ComplexArray, there: ComplexArray, near: ComplexArray) -> ComplexArray:
        """Return the free response of a response at ``s`` and beside zero."""
        gone = (0.5 * (near[..., :1] + near[..., 1:]) - there) / s
        if self.line:
            gone = -(gone + (near[..., 1:] - near[..., :1]) / (2.0 * NEAR_ZERO)) / s
        return np.asarray(gone)


def free_responses(structure: Structure) -> tuple[Structure, tuple[int, ...]]:
    """Return a structure whose outputs are the free responses of every channel, and the channel of each.

    Every channel has its own, with sizes of their own: more than the states of a minimal realisation, but their span
    holds all that the structure can show without input.

    Parameters
    ----------
    structure
        Structure with one input; parameters, ties and factors are kept.

    Returns
    -------
        The structure of free responses, with the parameters in the same order, and the place of the channel that each
        of its outputs belongs to.
    """
    finder = _Finder(
        values={name: float(value) for name, value in structure.named(structure.vector({})).items()},
        held=frozenset(parameter.name for parameter in structure.parameters if parameter.held),
    )
    outputs: dict[str, Expression] = {}
    channels: list[int] = []
    for place, path in enumerate(structure.paths):
        for number, shape in enumerate(finder.free(path)):
            outputs[f"{structure.channels[place][0]} free {number + 1}"] = shape
            channels.append(place)
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
            yield DriftingFreeResponse(block)
            if isinstance(block, Delay):
                yield DriftingFreeResponse(block, line=True)


def _closes_a_loop(node: Expression) -> bool:
    return any(isinstance(inner, Sensitivity) for inner in node.nodes())
