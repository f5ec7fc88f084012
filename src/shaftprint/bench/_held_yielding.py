"""By how much what a block holds yields: a number of its row is a held parameter, so that what rests on it is told."""

from shaftprint.drive._blocks import Block
from shaftprint.models._parameter import Parameter

YIELDING = "yielding"


def yielding_of(block: Block) -> str:
    """Return the parameter that says by how much what a block holds yields."""
    value = block.parameters.get(YIELDING)
    return value if isinstance(value, str) else f"{block.output}_{YIELDING}"


def states_yielding(block: Block) -> bool:
    """Return whether the row of a block states a number by which what it holds yields."""
    value = block.parameters.get(YIELDING)
    return isinstance(value, float) and value > 0.0


def held_yielding(block: Block) -> Parameter:
    """Return the stated number as a held parameter."""
    value = float(block.parameters[YIELDING])
    meaning = f"by how much {block.output} yields where it holds, in units of its speed times seconds"
    return Parameter(yielding_of(block), "-", 0.0, 2.0 * value, value, meaning, held=True)


def with_named_yielding(block: Block) -> Block:
    """Return a block that asks for the held parameter in place of the stated number."""
    return block.model_copy(update={"parameters": {**block.parameters, YIELDING: yielding_of(block)}})
