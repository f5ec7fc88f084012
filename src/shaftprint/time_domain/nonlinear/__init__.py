"""Lines with limits: from small signals and large in one likelihood to the levels of the limits."""

from shaftprint.time_domain.nonlinear._drive import Jump, jumps_in, with_jumps
from shaftprint.time_domain.nonlinear._fit import NonlinearFit, identify_nonlinear
from shaftprint.time_domain.nonlinear._jump_resonance import Fragile
from shaftprint.time_domain.nonlinear._numbers import LimitNumber, limit_numbers
from shaftprint.time_domain.nonlinear._orders import without_orders
from shaftprint.time_domain.nonlinear._settings import NonlinearSettings
from shaftprint.time_domain.nonlinear._structure import LimitedModel, full_load_shape, structure_for

__all__ = [
    "Fragile",
    "Jump",
    "LimitNumber",
    "LimitedModel",
    "NonlinearFit",
    "NonlinearSettings",
    "full_load_shape",
    "identify_nonlinear",
    "jumps_in",
    "limit_numbers",
    "structure_for",
    "with_jumps",
    "without_orders",
]
