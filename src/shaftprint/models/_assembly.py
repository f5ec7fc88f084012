"""What a structure is assembled from: channels, parameters of the blocks, the feedback loop."""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import StructureError
from shaftprint.models._block import Block
from shaftprint.models._combination import Combination
from shaftprint.models._expression import Expression, Sensitivity
from shaftprint.models._parameter import Parameter
from shaftprint.models._role import Role
from shaftprint.models._tied_parameter import Tie


def channel_paths(
    structure: str, outputs: Mapping[str, Expression | Mapping[str, Expression]], inputs: tuple[str, ...]
) -> dict[tuple[str, str], Expression]:
    """Return the expression of each channel by output and input, outputs slowest.

    Raises StructureError if there is no output, an input has no name, or an output does not name each input.
    """
    if isinstance(inputs, str):
        raise StructureError(
            f'structure {structure}: expected a tuple of inputs such as ("{inputs}",), found the text.'
        )
    if not isinstance(outputs, Mapping):
        raise StructureError(
            f'structure {structure}: expected outputs by name such as {{"y": ...}}, found {outputs!r}.'
        )
    if not outputs or not all(inputs):
        raise StructureError(f"structure {structure}: expected a named input and at least one output.")
    paths: dict[tuple[str, str], Expression] = {}
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
            paths[output, name] = by_input[name]
    return paths


def _words(value: object) -> str:
    if isinstance(value, Parameter):
        return f"a parameter; write Gain({value.name})"
    return f"{value!r}"


def block_parameters(structure: str, blocks: Iterable[Block]) -> dict[str, Parameter]:
    """Return every parameter of the blocks by name.

    Raises StructureError if two blocks describe a parameter of one name differently, or something else stands for a
    parameter.
    """
    parameters: dict[str, Parameter] = {}
    for block, parameter in ((owner, p) for owner in blocks for p in owner.parameters):
        if not isinstance(parameter, Parameter):
            raise StructureError(
                f"structure {structure}, block {type(block).__name__}: expected a Parameter, found {parameter!r}; a "
                "number multiplies a block, as in 2.0 * block, or is a Parameter with held=True."
            )
        if parameters.setdefault(parameter.name, parameter) != parameter:
            raise StructureError(
                f"structure {structure}: parameter {parameter.name} occurs twice with different bounds, values or "
                "units; use one Parameter for both."
            )
    return parameters


def expect_combinations(
    structure: str, combinations: tuple[Combination, ...], values: Mapping[str, FloatArray]
) -> None:
    """Check that combinations are made of parameters that there are.

    ``values``: every parameter by name. Raises StructureError if one is not.
    """
    if isinstance(combinations, Combination):
        raise StructureError(f"structure {structure}: expected a tuple of combinations such as ({combinations.name},).")
    for combination in combinations:
        try:
            with np.errstate(all="ignore"):
                combination.of(values)
        except KeyError as missing:
            raise StructureError(
                f"structure {structure}, combination {combination.name}: it names a parameter {missing}; the structure "
                f"has {', '.join(values)}."
            ) from None


def expect_tie(structure: str, ties: Iterable[Tie], name: str, new: Iterable[object]) -> None:
    """Check that a parameter can be tied, and that what comes with it are parameters.

    Raises StructureError if not.
    """
    others = [item for item in new if not isinstance(item, Parameter)]
    if others:
        raise StructureError(f"tied parameter {name}: expected new parameters, found {others[0]!r}.")
    followers = [tie.name for tie in ties if name in tie.arguments]
    if followers:
        raise StructureError(
            f"structure {structure}: {name} cannot be tied, since {', '.join(followers)} follows from it; write both "
            "formulas in other parameters."
        )


def expect_known_names(structure: str, known: Sequence[str], names: Iterable[str]) -> None:
    """Check that names are those of parameters.

    Raises StructureError if not.
    """
    unknown = [name for name in names if name not in known]
    if unknown:
        raise StructureError(f"structure {structure} has no parameter {', '.join(unknown)}; it has {', '.join(known)}.")


def expect_new_names(structure: str, known: Sequence[str], names: Iterable[str]) -> None:
    """Check that names are not those of parameters, and each once.

    Raises StructureError if not.
    """
    given = list(names)
    repeated = [name for index, name in enumerate(given) if name in known or name in given[:index]]
    if repeated:
        raise StructureError(f"structure {structure} has a parameter {', '.join(repeated)} already; use another name.")


def shown_parts(
    paths: Iterable[Expression], parameters: Iterable[Parameter], ties: Iterable[Tie]
) -> tuple[tuple[Parameter, ...], tuple[Tie, ...]]:
    """Return the parameters and ties that some paths show."""
    shown = {p.name for path in paths for node in path.nodes() if isinstance(node, Block) for p in node.parameters}
    kept = tuple(tie for tie in ties if tie.name in shown)
    shown |= {argument for tie in kept for argument in tie.arguments}
    return tuple(p for p in parameters if p.name in shown), kept


def distinct_nodes(paths: Iterable[Expression]) -> list[Expression]:
    """Return all parts of some paths, each once."""
    seen: dict[int, Expression] = {}
    for expression in paths:
        for node in expression.nodes():
            seen.setdefault(id(node), node)
    return list(seen.values())


def outermost_loop(structure: str, nodes: Iterable[Expression]) -> Expression | None:
    """Return the loop gain of the feedback that lies in no other feedback; None where there is no feedback.

    Raises StructureError if there is more than one.
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


def expect_single_roles(structure: str, roles: Mapping[str, Role]) -> None:
    """Check that no two parameters have one role.

    Raises StructureError if two have.
    """
    first: dict[Role, str] = {}
    for name, role in roles.items():
        if first.setdefault(role, name) != name:
            raise StructureError(
                f"structure {structure}: expected one parameter of the role {role.name}, found {first[role]} and "
                f"{name}; give one of them another role, or none."
            )
