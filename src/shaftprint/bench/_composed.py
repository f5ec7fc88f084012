"""A structure that a drive file composes of blocks: names and numbers only, nothing of the file is run."""

from collections.abc import Mapping
from dataclasses import replace
from functools import reduce
from typing import Any

from shaftprint.bench._begun import parameters_of
from shaftprint.bench._held_yielding import held_yielding, states_yielding, with_named_yielding
from shaftprint.bench._parts import PARTS, Coefficients
from shaftprint.drive._blocks import Block
from shaftprint.drive._drive import Drive
from shaftprint.errors import SettingsError
from shaftprint.models._diagram import Diagram
from shaftprint.models._structure import Structure
from shaftprint.models.equations._flow import Flow
from shaftprint.models.equations._formula import Formula, number
from shaftprint.spelling import meant


def composed(drive: Drive) -> Structure:
    """Return the structure that the blocks of a drive file make.

    Raises SettingsError if a signal comes from nowhere, goes nowhere or is both input and output of a block, or a block
    lacks a parameter.
    """
    inputs = tuple(one.name for one in drive.inputs)
    outputs = tuple(one.name for one in drive.outputs)
    _expect_wiring(drive, inputs, outputs)
    _expect_parameters(drive)
    blocks = [with_named_yielding(block) if states_yielding(block) else block for block in drive.blocks]
    parameters = (
        *parameters_of(drive),
        *(held_yielding(block) for block in drive.blocks if states_yielding(block)),
    )

    def equations(flow: Flow, first: Formula, p: Any) -> dict[str, Formula]:
        signals = {name: first if name == inputs[0] else flow.input(name) for name in inputs}
        signals |= {block.output: flow.unknown() for block in blocks}
        for block in blocks:
            value = _made(flow, block, _into(block, signals), vars(p))
            flow.close(signals[block.output], value, f"drive {drive.name}, block {block.output}")
        return {name: signals[name] for name in outputs}

    diagram = Diagram(drive.name, inputs[0], outputs, equations, parameters, further=inputs[1:])
    return Structure(
        # no name of a shipped structure, whatever the drive is called
        name=f"{drive.name} (blocks)",
        title=f"blocks of the drive file: {', '.join(block.output for block in drive.blocks)}",
        inputs=inputs,
        outputs={
            output: {source: diagram.port(output, "" if source == inputs[0] else source) for source in inputs}
            for output in outputs
        },
    )


def _into(block: Block, signals: Mapping[str, Formula]) -> Formula:
    """Return what goes into a block: its inputs added, those of a product multiplied."""
    terms = [-signals[name[1:]] if name.startswith("-") else signals[name] for name in block.inputs]
    if block.kind == "product":
        return reduce(lambda left, right: left * right, terms)
    return reduce(lambda left, right: left + right, terms, number(0.0))


def _made(flow: Flow, block: Block, into: Formula, parameters: Mapping[str, Formula]) -> Formula:
    """Return what comes out of a block; its states are called after it."""
    usual_values, part = PARTS[block.kind]
    first = len(flow.states)
    value = part(flow, into, Coefficients(parameters, block, usual_values))
    for index, state in enumerate(flow.states[first:], start=first):
        # the output itself is what a user knows at the start; what is behind it says what it is
        name = block.output if state is value else f"{block.output} {state.name}"
        flow.states[index] = replace(state, name=name)
    return value


def _expect_wiring(drive: Drive, inputs: tuple[str, ...], outputs: tuple[str, ...]) -> None:
    made = [block.output for block in drive.blocks]
    both = [name for name in made if name in inputs]
    if both:
        raise SettingsError(
            f"drive {drive.name}, blocks: expected another name for the output {both[0]} of a block, which is an input "
            "of the drive."
        )
    sources = (*inputs, *made)
    for block in drive.blocks:
        for name in block.inputs:
            if name.removeprefix("-") not in sources:
                raise SettingsError(
                    f"drive {drive.name}, block {block.output}, inputs: expected a signal, one of "
                    f"{', '.join(sources)}, found {name}.{meant(name, sources)}"
                )
    missing = [name for name in outputs if name not in made]
    if missing:
        raise SettingsError(
            f"drive {drive.name}, outputs: expected the output of a block, one of {', '.join(made)}, found "
            f"{missing[0]}.{meant(missing[0], made)}"
        )


def _expect_parameters(drive: Drive) -> None:
    stated = [one.name for one in drive.parameters]
    for block in drive.blocks:
        usual_values = PARTS[block.kind][0]
        for key in block.parameters:
            if key not in usual_values:
                raise SettingsError(
                    f"drive {drive.name}, block {block.output}, parameters: expected "
                    f"{', '.join(usual_values) or 'no parameters'} of {block.kind}, found {key}."
                    f"{meant(key, usual_values)}"
                )
        for key, usual in usual_values.items():
            if usual is None and key not in block.parameters:
                raise SettingsError(
                    f"drive {drive.name}, block {block.output}, parameters: expected {key}, the name of a parameter or "
                    "a number, found none."
                )
        for value in block.names:
            if value not in stated:
                listed = ", ".join(stated) or "of which there is none"
                raise SettingsError(
                    f"drive {drive.name}, block {block.output}, parameters: expected a number or one of "
                    f"[[parameters]], {listed}, found {value!r}.{meant(value, stated)}"
                )
    used = {name for block in drive.blocks for name in block.names} | {one.value for one in drive.start}
    idle = [name for name in stated if name not in used]
    if idle:
        raise SettingsError(
            f"drive {drive.name}, parameters: expected each to stand in a block, found {idle[0]} in none."
        )
