"""What a structure is assembled from: channels, parameters of the blocks, the feedback loop."""

from collections.abc import Iterable, Mapping

from shaftprint.errors import StructureError
from shaftprint.models._block import Block
from shaftprint.models._expression import Expression, Sensitivity
from shaftprint.models._parameter import Parameter


def channel_paths(
    structure: str, outputs: Mapping[str, Expression | Mapping[str, Expression]], inputs: tuple[str, ...]
) -> dict[tuple[str, str], Expression]:
    """Return the expression of each channel by output and input, outputs slowest.

    Raises
    ------
    StructureError
        If there is no output, an input has no name, or an output does not name each input.
    """
    if not outputs or not all(inputs):
        raise StructureError(f"structure {structure}: expected a named input and at least one output.")
    found: dict[tuple[str, str], Expression] = {}
    for output, response in outputs.items():
        by_input = response if isinstance(response, Mapping) else {inputs[0]: response}
        if set(by_input) != set(inputs):
            raise StructureError(
                f"structure {structure}, output {output}: expected a response to each of {', '.join(inputs)}, found "
                f"{', '.join(by_input)}."
            )
        for name in inputs:
            if not isinstance(by_input[name], Expression):
                cause = f" from {name}" if len(inputs) > 1 else ""
                raise StructureError(
                    f"structure {structure}, output {output}{cause}: expected an expression of blocks, found "
                    f"{_words(by_input[name])}."
                )
            found[output, name] = by_input[name]
    return found


def _words(found: object) -> str:
    if isinstance(found, Parameter):
        return f"a parameter; write Gain({found.name})"
    return f"{found!r}"


def block_parameters(structure: str, blocks: Iterable[Block]) -> dict[str, Parameter]:
    """Return every parameter of the blocks by name.

    Raises
    ------
    StructureError
        If two blocks describe a parameter of one name differently.
    """
    found: dict[str, Parameter] = {}
    for parameter in (p for block in blocks for p in block.parameters):
        if found.setdefault(parameter.name, parameter) != parameter:
            raise StructureError(
                f"structure {structure}: parameter {parameter.name} occurs twice with different bounds, values or "
                "units; use one Parameter for both."
            )
    return found


def outermost_loop(structure: str, nodes: Iterable[Expression]) -> Expression | None:
    """Return the loop gain of the feedback that lies in no other feedback; None where there is no feedback.

    Raises
    ------
    StructureError
        If there is more than one.
    """
    loops = [node for node in nodes if isinstance(node, Sensitivity)]
    inner = {id(node) for outer in loops for node in outer.loop.nodes()}
    outermost = [node for node in loops if id(node) not in inner]
    if len(outermost) > 1:
        raise StructureError(
            f"structure {structure}: expected one outermost feedback loop, found {len(outermost)}; use one Sensitivity "
            "object for all outputs."
        )
    return outermost[0].loop if outermost else None
