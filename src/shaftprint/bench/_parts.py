"""What each kind of block of a drive file does, as equations of signals."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TypeAlias

from shaftprint.drive._blocks import Block, BlockKind
from shaftprint.models.equations._flow import Flow
from shaftprint.models.equations._formula import Formula, Number, as_formula, clip, number, table
from shaftprint.models.equations._friction import backlash, coulomb_friction, stribeck_friction
from shaftprint.models.equations._limits import deadband, first_order_lag, raised, second_order_lag, two_sided
from shaftprint.models.equations._realisation import coefficients, realised

Usual: TypeAlias = float | str | None
"""Usual value of a parameter: a number, the name of another parameter that it then equals, or none."""


@dataclass(frozen=True, slots=True, eq=False)
class Coefficients:
    """What the row of a block says, as numbers of the equations."""

    parameters: Mapping[str, Formula]
    block: Block
    usual_values: Mapping[str, Usual]

    def __getitem__(self, key: str) -> Number:
        """Return a parameter of the block, or its usual value."""
        value = self.block.parameters.get(key)
        if value is not None:
            return self.number(value)
        usual = self.usual_values[key]
        return self[usual] if isinstance(usual, str) else number(usual or 0.0)

    def number(self, value: str | float) -> Number:
        """Return a parameter of the file, or a number."""
        return self.parameters[value] if isinstance(value, str) else number(value)


Part: TypeAlias = Callable[[Flow, Formula, Coefficients], Formula]


def _integrator(flow: Flow, signal: Formula, p: Coefficients) -> Formula:
    state = flow.state("integral")
    flow.rate(state, signal * p["gain"])
    return state


def _pi(flow: Flow, signal: Formula, p: Coefficients) -> Formula:
    state = flow.state("integral")
    flow.rate(state, signal * p["integral"])
    return signal * p["proportional"] + state


def _inertia(flow: Flow, signal: Formula, p: Coefficients) -> Formula:
    state = flow.state("motion")
    flow.rate(state, signal / p["inertia"])
    return state


def _power(flow: Flow, signal: Formula, p: Coefficients) -> Formula:
    return raised(signal, p.block.exponent or 1.0, keeps_sign=p.block.keeps_sign)


def _ratio(flow: Flow, signal: Formula, p: Coefficients) -> Formula:
    top, bottom = ([p.number(value) for value in values or ()] for values in (p.block.numerator, p.block.denominator))
    return realised(flow, signal, (coefficients(top), coefficients(bottom)), "state")


def _coulomb(flow: Flow, speed: Formula, p: Coefficients) -> Formula:
    size, sided = _sizes(p)
    return sided(coulomb_friction(flow, speed, size, yielding=p["yielding"], within_s=p["within"]))


def _stribeck(flow: Flow, speed: Formula, p: Coefficients) -> Formula:
    size, sided = _sizes(p)
    return sided(
        stribeck_friction(
            flow,
            speed,
            size,
            breakaway=p["breakaway"],
            fading_speed=p["fading-speed"],
            yielding=p["yielding"],
            within_s=p["within"],
        )
    )


def _sizes(p: Coefficients) -> tuple[Number, Callable[[Formula], Formula]]:
    """Return the size for the law of friction, and what makes two sizes of what the law gives."""
    if "size-backward" not in p.block.parameters:
        return p["size"], lambda friction: friction
    return 1.0, lambda share: two_sided(share, p["size"], p["size-backward"])


PARTS: Mapping[BlockKind, tuple[Mapping[str, Usual], Part]] = MappingProxyType(
    {
        "constant": ({"value": None}, lambda flow, u, p: as_formula(p["value"])),
        "gain": ({"gain": None}, lambda flow, u, p: u * p["gain"]),
        "sum": ({}, lambda flow, u, p: u),
        "product": ({}, lambda flow, u, p: u),
        "abs": ({}, lambda flow, u, p: abs(u)),
        "power": ({}, _power),
        "table": ({}, lambda flow, u, p: table(u, p.block.points or ())),
        "integrator": ({"gain": 1.0}, _integrator),
        "inertia": ({"inertia": None}, _inertia),
        "first-order-lag": (
            {"gain": 1.0, "time": None},
            lambda flow, u, p: first_order_lag(flow, u * p["gain"], p["time"]),
        ),
        "second-order-lag": (
            {"gain": 1.0, "frequency": None, "damping": None},
            lambda flow, u, p: second_order_lag(flow, u * p["gain"], p["frequency"], p["damping"]),
        ),
        "ratio": ({}, _ratio),
        "pi": ({"proportional": None, "integral": None}, _pi),
        "delay": ({"time": None}, lambda flow, u, p: flow.delayed(u, p["time"])),
        "deadband": ({"half-width": None}, lambda flow, u, p: deadband(u, p["half-width"])),
        "limit": ({"lowest": None, "highest": None}, lambda flow, u, p: clip(u, p["lowest"], p["highest"])),
        "coulomb-friction": ({"size": None, "size-backward": "size", "yielding": None, "within": 1e-3}, _coulomb),
        "stribeck-friction": (
            {
                "size": None,
                "size-backward": "size",
                "breakaway": None,
                "fading-speed": None,
                "yielding": None,
                "within": 1e-3,
            },
            _stribeck,
        ),
        "backlash": (
            {"gap": None, "within": 1e-3},
            lambda flow, u, p: backlash(flow, u, p["gap"], within_s=p["within"]),
        ),
    }
)
"""What each kind of block asks for, with the usual value where there is one, and what it does."""
