"""A structure that a drive file composes of blocks: names and numbers only, nothing of the file is run."""

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any, TypeAlias

from shaftprint.drive import Block, BlockKind, Drive
from shaftprint.errors import SettingsError
from shaftprint.models import (
    Diagram,
    Flow,
    Formula,
    Number,
    Parameter,
    Structure,
    backlash,
    clip,
    coulomb_friction,
    deadband,
    first_order_lag,
    number,
    second_order_lag,
    stribeck_friction,
)
from shaftprint.spelling import meant

Values: TypeAlias = Mapping[str, Number]
Part: TypeAlias = Callable[[Flow, Formula, Values], Formula]


def _integrator(flow: Flow, signal: Formula, p: Values) -> Formula:
    state = flow.state("sum")
    flow.rate(state, signal * p["gain"])
    return state


def _pi(flow: Flow, signal: Formula, p: Values) -> Formula:
    state = flow.state("sum")
    flow.rate(state, signal * p["integral"])
    return signal * p["proportional"] + state


PARTS: Mapping[BlockKind, tuple[Mapping[str, float | None], Part]] = MappingProxyType(
    {
        "gain": ({"gain": None}, lambda flow, u, p: u * p["gain"]),
        "sum": ({}, lambda flow, u, p: u),
        "integrator": ({"gain": 1.0}, _integrator),
        "first-order-lag": (
            {"gain": 1.0, "time": None},
            lambda flow, u, p: first_order_lag(flow, u, p["time"]) * p["gain"],
        ),
        "second-order-lag": (
            {"gain": 1.0, "frequency": None, "damping": None},
            lambda flow, u, p: second_order_lag(flow, u, p["frequency"], p["damping"]) * p["gain"],
        ),
        "pi": ({"proportional": None, "integral": None}, _pi),
        "delay": ({"time": None}, lambda flow, u, p: flow.delayed(u, p["time"])),
        "deadband": ({"half-width": None}, lambda flow, u, p: deadband(u, p["half-width"])),
        "limit": ({"lowest": None, "highest": None}, lambda flow, u, p: clip(u, p["lowest"], p["highest"])),
        "coulomb-friction": (
            {"size": None, "yielding": None, "within": 1e-3},
            lambda flow, u, p: coulomb_friction(flow, u, p["size"], yielding=p["yielding"], within_s=p["within"]),
        ),
        "stribeck-friction": (
            {"size": None, "breakaway": None, "fading-speed": None, "yielding": None, "within": 1e-3},
            lambda flow, u, p: stribeck_friction(
                flow,
                u,
                p["size"],
                breakaway=p["breakaway"],
                fading_speed=p["fading-speed"],
                yielding=p["yielding"],
                within_s=p["within"],
            ),
        ),
        "backlash": (
            {"gap": None, "within": 1e-3},
            lambda flow, u, p: backlash(flow, u, p["gap"], within_s=p["within"]),
        ),
    }
)
"""What each kind of block asks for, with the usual value where there is one, and what it does."""
# By how much what friction holds yields.
YIELDING = "yielding"


def composed(drive: Drive) -> Structure:
    """Return the structure that the blocks of a drive file make.

    Raises
    ------
    SettingsError
        If a signal comes from nowhere, goes nowhere or is both input and output of a block, or a block lacks a
        parameter.
    """
    inputs = tuple(one.name for one in drive.inputs)
    outputs = tuple(one.name for one in drive.outputs)
    _expect_wiring(drive, inputs, outputs)
    used = {text for block in drive.blocks for text in block.parameters.values() if isinstance(text, str)}
    _expect_parameters(drive, used)
    parameters = (
        *(Parameter(one.name, one.unit, one.lower, one.upper, one.value, one.meaning) for one in drive.parameters),
        *(_held_yielding(block) for block in drive.blocks if _is_number(block, YIELDING)),
    )

    def equations(flow: Flow, first: Formula, _: Any) -> dict[str, Formula]:
        signals = {name: first if name == inputs[0] else flow.input(name) for name in inputs}
        signals |= {block.output: flow.unknown() for block in drive.blocks}
        for block in drive.blocks:
            into = number(0.0)
            for name in block.inputs:
                signal = signals[name.removeprefix("-")]
                into = into - signal if name.startswith("-") else into + signal
            asked, part = PARTS[block.kind]
            values = {key: _value(flow, block, key, usual) for key, usual in asked.items()}
            if _is_number(block, YIELDING):
                values[YIELDING] = flow.parameter(yielding_of(block))
            flow.close(signals[block.output], part(flow, into, values), f"drive {drive.name}, block {block.output}")
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


def yielding_of(block: Block) -> str:
    """Return the parameter that says by how much what a block holds yields."""
    value = block.parameters.get(YIELDING)
    return value if isinstance(value, str) else f"{block.output}_{YIELDING}"


def _is_number(block: Block, key: str) -> bool:
    value = block.parameters.get(key)
    return value is not None and not isinstance(value, str) and value > 0.0


def _held_yielding(block: Block) -> Parameter:
    """Return a number as a held parameter, so that what rests on it can be told."""
    value = float(block.parameters[YIELDING])
    meaning = f"by how much {block.output} yields where it holds, in units of its speed times seconds"
    return Parameter(yielding_of(block), "-", 0.0, 2.0 * value, value, meaning, held=True)


def _value(flow: Flow, block: Block, key: str, usual: float | None) -> Number:
    value = block.parameters.get(key, usual)
    return flow.parameter(value) if isinstance(value, str) else number(value or 0.0)


def _expect_wiring(drive: Drive, inputs: tuple[str, ...], outputs: tuple[str, ...]) -> None:
    made = [block.output for block in drive.blocks]
    both = [name for name in made if name in inputs]
    if both:
        raise SettingsError(
            f"drive {drive.name}, blocks: expected another name for the output {both[0]} of a block, which is an input "
            "of the drive."
        )
    known = (*inputs, *made)
    for block in drive.blocks:
        for name in block.inputs:
            if name.removeprefix("-") not in known:
                raise SettingsError(
                    f"drive {drive.name}, block {block.output}, inputs: expected a signal, one of {', '.join(known)}, "
                    f"found {name}.{meant(name, known)}"
                )
    missing = [name for name in outputs if name not in made]
    if missing:
        raise SettingsError(
            f"drive {drive.name}, outputs: expected the output of a block, one of {', '.join(made)}, found "
            f"{missing[0]}.{meant(missing[0], made)}"
        )


def _expect_parameters(drive: Drive, used: set[str]) -> None:
    stated = [one.name for one in drive.parameters]
    for block in drive.blocks:
        asked = PARTS[block.kind][0]
        for key in block.parameters:
            if key not in asked:
                raise SettingsError(
                    f"drive {drive.name}, block {block.output}, parameters: expected {_listed(asked)} of {block.kind}, "
                    f"found {key}.{meant(key, asked)}"
                )
        for key, usual in asked.items():
            if usual is None and key not in block.parameters:
                raise SettingsError(
                    f"drive {drive.name}, block {block.output}, parameters: expected {key}, the name of a parameter or "
                    "a number, found none."
                )
        for value in block.parameters.values():
            if isinstance(value, str) and value not in stated:
                known = ", ".join(stated) or "of which there is none"
                raise SettingsError(
                    f"drive {drive.name}, block {block.output}, parameters: expected a number or one of "
                    f"[[parameters]], {known}, found {value!r}.{meant(value, stated)}"
                )
    idle = [name for name in stated if name not in used]
    if idle:
        raise SettingsError(
            f"drive {drive.name}, parameters: expected each to stand in a block, found {idle[0]} in none."
        )


def _listed(asked: Mapping[str, float | None]) -> str:
    return ", ".join(asked) or "no parameters"
