"""Derivatives and replacements in formulas of the time domain."""

from collections.abc import Callable, Iterable, Iterator

from shaftprint.models.equations._formula import Formula, choose, number, power

Replacement = Callable[[Formula], Formula | None]


def postorder(roots: Iterable[Formula]) -> Iterator[Formula]:
    """Walk over formulas and all they are made of, parts first, each object once."""
    seen: set[int] = set()
    for root in roots:
        stack = [(root, False)]
        while stack:
            node, done = stack.pop()
            if done:
                yield node
            elif id(node) not in seen:
                seen.add(id(node))
                stack.append((node, True))
                stack.extend((part, False) for part in reversed(node.of))


def rebuilt(node: Formula, parts: tuple[Formula, ...]) -> Formula:
    """Return the same operation on other parts, simplified where one became a number."""
    if all(new is old for new, old in zip(parts, node.of, strict=True)):
        return node
    if node.operation == "add":
        return parts[0] + parts[1]
    if node.operation == "multiply":
        return parts[0] * parts[1]
    if node.operation == "divide":
        return parts[0] / parts[1]
    if node.operation == "power":
        return power(parts[0], node.value)
    return Formula(node.operation, parts, node.name, node.value, node.place, node.points)


def replaced(roots: Iterable[Formula], by: Replacement) -> list[Formula]:
    """Return formulas in which some parts stand for others; what replaces is not walked again.

    ``by``: what to put in the place of a part, or None to keep it.
    """
    roots = list(roots)
    replacements: dict[int, Formula] = {}
    keep: list[Formula] = []
    for node in postorder(roots):
        new = by(node)
        if new is None:
            new = rebuilt(node, tuple(replacements[id(part)] for part in node.of))
        keep.append(new)
        replacements[id(node)] = new
    return [replacements[id(root)] for root in roots]


def depends(root: Formula, on: Formula) -> bool:
    """Return whether a formula contains a leaf, other than in how fast something changes."""
    (marked,) = replaced([root], lambda node: number(0.0) if node.operation == "rate" else None)
    return any(is_leaf(node, on) for node in postorder([marked]))


def is_leaf(node: Formula, leaf: Formula) -> bool:
    """Return whether two leaves stand for the same."""
    return node.operation == leaf.operation and node.place == leaf.place


def derivative(root: Formula, to: Formula) -> Formula:
    """Return the derivative of a formula to a leaf."""
    return derivatives([root], to)[0]


def derivatives(roots: Iterable[Formula], to: Formula) -> list[Formula]:
    """Return the derivatives of several formulas to one leaf."""
    return swept(roots, lambda node: number(1.0) if is_leaf(node, to) else None)


def swept(roots: Iterable[Formula], of_leaf: Replacement) -> list[Formula]:
    """Return the derivatives of formulas along a direction.

    ``of_leaf``: derivative of a leaf; None where it is zero.
    """
    roots = list(roots)
    slopes_by_node: dict[int, Formula] = {}
    zero = number(0.0)
    for node in postorder(roots):
        if not node.of or node.operation == "rate":
            slope = of_leaf(node)
            slopes_by_node[id(node)] = zero if slope is None else slope
            continue
        slopes = [slopes_by_node[id(part)] for part in node.of]
        slopes_by_node[id(node)] = zero if all(slope.equals(0.0) for slope in slopes) else _chain(node, slopes)
    return [slopes_by_node[id(root)] for root in roots]


def _chain(node: Formula, slopes: list[Formula]) -> Formula:
    """Return the derivative of an operation from those of what it operates on."""
    parts = node.of
    match node.operation:
        case "add":
            return slopes[0] + slopes[1]
        case "multiply":
            return slopes[0] * parts[1] + parts[0] * slopes[1]
        case "divide":
            return (slopes[0] - node * slopes[1]) / parts[1]
        case "minimum":
            return choose(parts[0], parts[1], slopes[0], slopes[1])
        case "maximum":
            return choose(parts[1], parts[0], slopes[0], slopes[1])
        case "choose":
            return choose(parts[0], parts[1], slopes[2], slopes[3])
    return _slope(node) * slopes[0]


def _slope(node: Formula) -> Formula:
    """Return the derivative of a function of one argument to it."""
    x = node.of[0]
    match node.operation:
        case "power":
            return node.value * power(x, node.value - 1.0)
        case "sqrt":
            return 0.5 / node
        case "exp":
            return node
        case "log":
            return 1.0 / x
        case "sin":
            return x.cos()
        case "cos":
            return -x.sin()
        case "tanh":
            return 1.0 - node * node
        case "absolute":
            return choose(x, 0.0, -1.0, 1.0)
    # the slope of a table is constant between its corners
    return Formula("table slope", (x,), points=node.points) if node.operation == "table" else number(0.0)
