"""From the expression of a response to equations in time.

A product is read from left to right: what stands first acts first, which matters as soon as a block is not linear. A
loop is closed where its forward blocks and their sensitivity meet: of ``A * G * S(G H)`` the error is ``e = A u - H(G
e)`` and the result ``G e``, without a second copy of ``G``. Where all blocks are linear, their order is none of the
author's concern: they are put in that of the loop.
"""

import math
from collections.abc import Sequence

from shaftprint.errors import StructureError
from shaftprint.models._block import Block
from shaftprint.models._delays import AveragingSensor, Delay
from shaftprint.models._expression import Constant, Expression, Inverse, Parallel, Sensitivity, Series
from shaftprint.models.equations._calculus import depends, derivative, replaced
from shaftprint.models.equations._flow import Flow
from shaftprint.models.equations._formula import Formula, number
from shaftprint.models.equations._realisation import Ratio, product, realised, total

# How often the change of an input or of a late signal can be taken.
KNOWN_CHANGES = 1


def factors(expression: Expression) -> list[Expression]:
    """Return the parts of a product in their order, the inverse of a late product taken apart."""
    if isinstance(expression, Series):
        return [*factors(expression.first), *factors(expression.second)]
    if isinstance(expression, Inverse) and isinstance(expression.of, Series):
        parts = factors(expression.of)
        if any(isinstance(part, Delay) for part in parts):
            return [Inverse(part) for part in reversed(parts)]
    return [expression]


def through(flow: Flow, expression: Expression, signal: Formula) -> Formula:
    """Return what an expression makes of a signal.

    Raises StructureError if a part has no equations in time.
    """
    return along(flow, factors(expression), signal)


def along(flow: Flow, chain: Sequence[Expression], signal: Formula) -> Formula:
    """Return what a chain of expressions makes of a signal, closing the loops in it."""
    closings = [(i, part) for i, part in enumerate(chain) if isinstance(part, Sensitivity)]
    if not closings:
        for part in _in_order_of_changes(flow, chain):
            signal = _of_part(flow, part, signal)
        return signal
    last, sensitivity = closings[-1]
    loop = factors(sensitivity.loop)
    before = _in_order_of(loop, chain[:last])
    shared = _shared(before, loop)
    signal = along(flow, before[: len(before) - shared], signal)
    error = _error(flow, sensitivity, loop, signal)
    return along(flow, [*before[len(before) - shared :], *chain[last + 1 :]], error)


def _in_order_of(loop: list[Expression], before: Sequence[Expression]) -> list[Expression]:
    """Return the parts ahead of a sensitivity, those of its loop last and in its order, if all may change places."""
    places = {id(part): index for index, part in enumerate(loop)}
    if not all(_is_linear(part) for part in before):
        return list(before)
    inside = sorted((part for part in before if id(part) in places), key=lambda part: places[id(part)])
    return [*(part for part in before if id(part) not in places), *inside]


def _in_order_of_changes(flow: Flow, chain: Sequence[Expression]) -> list[Expression]:
    """Return a chain so that every change it forms is known: what falls off first, what rises next, what is late last.

    The given order is kept where it will do, so that states are shared with other outputs.
    """
    falls = {id(part): _falls(flow, part) for part in chain}
    orders = KNOWN_CHANGES
    for fall in (falls[id(part)] for part in chain):
        orders = min(orders, KNOWN_CHANGES) if fall is None else orders + fall
        if orders < 0 and all(_is_linear(part) for part in chain):
            return sorted(chain, key=lambda part: _place(falls[id(part)]))
    return list(chain)


def _place(fall: int | None) -> float:
    return math.inf if fall is None else -fall


def _falls(flow: Flow, part: Expression) -> int | None:
    """Return by how many powers of ``s`` a part falls off, negative where it rises; None where it is not rational."""
    ratio = ratio_of(flow, part)
    return None if ratio is None else len(ratio[1]) - len(ratio[0])


def _shared(before: list[Expression], loop: list[Expression]) -> int:
    """Return how many of the last parts are the first of the loop."""
    for count in range(min(len(before), len(loop)), 0, -1):
        if all(a is b for a, b in zip(before[-count:], loop[:count], strict=True)):
            return count
    return 0


def _error(flow: Flow, sensitivity: Sensitivity, loop: list[Expression], signal: Formula) -> Formula:
    """Return what feedback leaves of a signal."""
    key = (id(sensitivity), id(signal))
    if key in flow.known:
        return flow.known[key]
    error = flow.unknown()
    flow.kept += [sensitivity, signal]
    flow.known[key] = error
    return flow.close(error, signal - along(flow, loop, error), "feedback")


def _of_part(flow: Flow, part: Expression, signal: Formula) -> Formula:
    key = (id(part), id(signal))
    if key not in flow.known:
        flow.kept += [part, signal]
        flow.known[key] = _fresh(flow, part, signal)
    return flow.known[key]


def _fresh(flow: Flow, part: Expression, signal: Formula) -> Formula:
    if isinstance(part, Constant):
        return part.number * signal
    if isinstance(part, Parallel):
        return through(flow, part.first, signal) + through(flow, part.second, signal)
    if isinstance(part, Block):
        return part.flow(flow, signal)
    if isinstance(part, Inverse):
        return _inverse(flow, part, signal)
    raise StructureError(f"{type(part).__name__} has no equations in time; it can be fitted, but not simulated.")


def _inverse(flow: Flow, part: Inverse, signal: Formula) -> Formula:
    ratio = ratio_of(flow, part.of)
    if ratio is not None:
        return realised(flow, signal, (ratio[1], ratio[0]), "inverse")
    unknown = flow.unknown()
    forward = through(flow, part.of, unknown)
    slope = derivative(forward, unknown)
    if slope.equals(0.0) or depends(slope, unknown):
        raise StructureError("the inverse of a response that is late or falls off would need the future of a signal.")
    (constant,) = replaced([forward], lambda node: number(0.0) if node is unknown else None)
    return flow.close(unknown, (signal - constant) / slope, "inverse")


def ratio_of(flow: Flow, expression: Expression) -> Ratio | None:
    """Return numerator and denominator with formulas as coefficients; None where there is no such ratio."""
    if isinstance(expression, Constant):
        return [number(expression.number)], [number(1.0)]
    if isinstance(expression, Block):
        return expression.coefficients_in(flow)
    if isinstance(expression, Inverse):
        ratio = ratio_of(flow, expression.of)
        return None if ratio is None else (ratio[1], ratio[0])
    if isinstance(expression, Sensitivity):
        ratio = ratio_of(flow, expression.loop)
        return None if ratio is None else (ratio[1], total(ratio[1], ratio[0]))
    if not isinstance(expression, Series | Parallel):
        return None
    one, two = ratio_of(flow, expression.first), ratio_of(flow, expression.second)
    if one is None or two is None:
        return None
    bottom = product(one[1], two[1])
    if isinstance(expression, Series):
        return product(one[0], two[0]), bottom
    return total(product(one[0], two[1]), product(two[0], one[1])), bottom


def split_shift(flow: Flow, expression: Expression, signal: Formula) -> tuple[Formula, Formula]:
    """Return the output of an expression without the delays at its end, and their sum, which may be negative.

    What only shifts an output is taken off the simulated signal afterwards, so that a latency that was corrected by
    too much needs no future.
    """
    parts = factors(expression)
    end = len(parts)
    while end and _is_linear(parts[end - 1]):
        end -= 1
    shift = number(0.0)
    undelayed: list[Expression] = []
    sensors: list[AveragingSensor] = []
    for part in parts[end:]:
        if isinstance(part, AveragingSensor):
            shift = shift + part.lateness(flow)
            sensors.append(part)
        elif isinstance(part, Delay):
            shift = shift + flow.parameter(part.time.name)
        elif isinstance(part, Inverse) and isinstance(part.of, Delay):
            shift = shift - flow.parameter(part.of.time.name)
        else:
            undelayed.append(part)
    response = along(flow, undelayed, along(flow, parts[:end], signal))
    for sensor in sensors:
        response = sensor.means(flow, response)
    return response, shift


def split_common_shift(flow: Flow, paths: Sequence[tuple[Expression, Formula]]) -> tuple[tuple[Formula, ...], Formula]:
    """Return what each path makes of its signal without the delays that end them all, and the sum of these delays.

    The latency of a sensor may be corrected by too much for an output of several inputs too.
    """
    parts = [factors(expression) for expression, _ in paths]
    ends = [_delays_at_the_end(one) for one in parts]
    shared = [name for name in ends[0] if all(name in end for end in ends[1:])]
    responses = []
    for one, end, (_, signal) in zip(parts, ends, paths, strict=True):
        left_out = {end[name] for name in shared}
        kept = [part for place, part in enumerate(one) if place not in left_out]
        responses.append(along(flow, kept, signal))
    shift = number(0.0)
    for name in shared:
        shift = shift + flow.parameter(name)
    return tuple(responses), shift


def _delays_at_the_end(parts: Sequence[Expression]) -> dict[str, int]:
    """Return the places of the delays behind the last loop, by the names of their parameters."""
    places: dict[str, int] = {}
    for place in range(len(parts) - 1, -1, -1):
        part = parts[place]
        if not _is_linear(part):
            break
        if isinstance(part, Delay):
            places[part.time.name] = place
    return places


def _is_linear(part: Expression) -> bool:
    """Return whether a part may change places with a delay: no loop is closed at it, and its blocks are linear."""
    if isinstance(part, Sensitivity):
        return False
    return all(node.is_linear for node in part.nodes() if isinstance(node, Block))
