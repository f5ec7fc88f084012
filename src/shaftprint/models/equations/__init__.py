"""Equations in time: formulas, their derivatives and values, the flow that a block asks, limits and engine parts."""

from shaftprint.models.equations._calculus import depends, derivative, derivatives, postorder, rebuilt, replaced, swept
from shaftprint.models.equations._clutch import slipping_clutch
from shaftprint.models.equations._engine_parts import boosted, firing_delay, full_load, quadratic_propeller
from shaftprint.models.equations._evaluate import Array, Leaves, evaluate
from shaftprint.models.equations._flow import Flow, Past
from shaftprint.models.equations._formula import (
    Formula,
    Number,
    as_formula,
    choose,
    clip,
    maximum,
    minimum,
    number,
    table,
)
from shaftprint.models.equations._friction import backlash, coulomb_friction, stribeck_friction
from shaftprint.models.equations._limits import (
    Governed,
    deadband,
    first_order_lag,
    limited_pi,
    raised,
    rate_limited,
    second_order_lag,
    two_sided,
)
from shaftprint.models.equations._realisation import Ratio, coefficients, product, realised, total

__all__ = [
    "Array",
    "Flow",
    "Formula",
    "Governed",
    "Leaves",
    "Number",
    "Past",
    "Ratio",
    "as_formula",
    "backlash",
    "boosted",
    "choose",
    "clip",
    "coefficients",
    "coulomb_friction",
    "deadband",
    "depends",
    "derivative",
    "derivatives",
    "evaluate",
    "firing_delay",
    "first_order_lag",
    "full_load",
    "limited_pi",
    "maximum",
    "minimum",
    "number",
    "postorder",
    "product",
    "quadratic_propeller",
    "raised",
    "rate_limited",
    "realised",
    "rebuilt",
    "replaced",
    "second_order_lag",
    "slipping_clutch",
    "stribeck_friction",
    "swept",
    "table",
    "total",
    "two_sided",
]
