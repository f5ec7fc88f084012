"""Count right structures that the check of a structure refuses, and wrong derivatives that it does not.

Right structures: the shipped ones, each free parameter between bounds drawn narrower or wider than its own; a
parameter that cannot be negative stays so. Wrong ones: the shipped structures with one block whose derivative to one
parameter is 1 % too large, of the wrong sign, zero, or that to another parameter. Two equal derivatives may be swapped:
such a change is counted apart. Run ``python benchmarks/structure_check.py --draws 2000``: about a minute.
"""

import argparse
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from unittest import mock

import numpy as np

# Run as a file, the folder of the benchmarks is on the path, not the one above.
sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from shaftprint.arrays import ComplexArray
from shaftprint.catalogue import STRUCTURES, structure
from shaftprint.errors import StructureError
from shaftprint.models import Block, Structure, check_structure

# Largest change of a bound, in widths between the shipped bounds, inwards and outwards.
INWARDS, OUTWARDS = 0.45, 0.5
SEED = 13

Change = Callable[[tuple[ComplexArray, ...]], tuple[ComplexArray, ...]]


def between_other_bounds(shipped: Structure, rng: np.random.Generator) -> Structure:
    """Return a structure with each free parameter between bounds drawn around the shipped ones."""
    bounds = {}
    for parameter in shipped.free:
        width = parameter.upper - parameter.lower
        if np.isfinite(width):
            below, above = rng.uniform(-OUTWARDS, INWARDS, size=2)
            lower = parameter.lower + below * width
            if parameter.lower >= 0.0:
                lower = max(lower, 0.5 * parameter.lower)
            bounds[parameter.name] = (lower, parameter.upper - above * width)
    return shipped.free_between(**bounds)


def changes(count: int) -> Iterator[tuple[str, Change]]:
    """Give every way to spoil the derivatives to so many parameters, with its name."""
    for index in range(count):
        for name, factor in (("1 % too large", 1.01), ("wrong sign", -1.0), ("zero", 0.0)):
            yield f"{name}, parameter {index}", lambda d, i=index, f=factor: (*d[:i], f * d[i], *d[i + 1 :])
        other = (index + 1) % count
        if other != index:
            order = list(range(count))
            order[index], order[other] = other, index
            yield f"parameters {index} and {other} swapped", lambda d, o=tuple(order): tuple(d[i] for i in o)


def is_refused(checked: Structure) -> bool:
    """Return whether the check refuses a structure."""
    try:
        check_structure(checked)
    except StructureError:
        return True
    return False


def spoilt(checked: Structure, block: Block, change: Change) -> tuple[bool, bool]:
    """Return whether a structure is refused with one block's derivatives changed, and whether that changed any."""
    kind = type(block)
    original = kind.derivatives
    differs = []

    def derivatives(self: Block, s: ComplexArray, response: ComplexArray, *values: ComplexArray) -> object:
        right = original(self, s, response, *values)
        if self is not block:
            return right
        wrong = change(right)
        differs.append(not all(np.array_equal(a, b) for a, b in zip(right, wrong, strict=True)))
        return wrong

    with mock.patch.object(kind, "derivatives", derivatives):
        return is_refused(checked), any(differs)


def main() -> None:
    """Print how many right structures are refused, and how many wrong ones are not."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--draws", type=int, default=2000, help="structures with drawn bounds, 2000 by default")
    rng, names = np.random.default_rng(SEED), tuple(STRUCTURES)
    draws = parser.parse_args().draws
    refused = sum(is_refused(between_other_bounds(structure(names[i % len(names)]), rng)) for i in range(draws))
    print(f"right structures refused: {refused} of {draws} over {len(names)} shipped ones")
    wrong = missed = equal = 0
    for name in names:
        shipped = structure(name)
        for block in shipped.blocks:
            for words, change in changes(len(block.parameters)):
                was_refused, differs = spoilt(shipped, block, change)
                wrong, equal = wrong + differs, equal + (not differs)
                if differs and not was_refused:
                    missed += 1
                    print(f"not refused: {name}, {type(block).__name__}: {words}")
    print(f"wrong derivatives not refused: {missed} of {wrong}; {equal} changes left equal derivatives equal")


if __name__ == "__main__":
    main()
