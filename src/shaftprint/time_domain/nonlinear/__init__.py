"""Lines with limits: from small signals and large in one likelihood to the levels of the limits."""

from shaftprint.time_domain.nonlinear._covariance import with_scatter_of_blocks
from shaftprint.time_domain.nonlinear._drive import Jump, jumps_in, sharpened, with_jumps
from shaftprint.time_domain.nonlinear._fit import NonlinearFit, identify_nonlinear
from shaftprint.time_domain.nonlinear._jump_resonance import Fragile, fragile_stretches, without_fragile
from shaftprint.time_domain.nonlinear._limited_sines import touched
from shaftprint.time_domain.nonlinear._numbers import LimitNumber, limit_numbers
from shaftprint.time_domain.nonlinear._orders import without_orders
from shaftprint.time_domain.nonlinear._search import Given, SomeDrawn
from shaftprint.time_domain.nonlinear._settings import NonlinearSettings
from shaftprint.time_domain.nonlinear._structure import LimitedModel, full_load_shape, structure_for

__all__ = [
    "Fragile",
    "Given",
    "Jump",
    "LimitNumber",
    "LimitedModel",
    "NonlinearFit",
    "NonlinearSettings",
    "SomeDrawn",
    "fragile_stretches",
    "full_load_shape",
    "identify_nonlinear",
    "jumps_in",
    "limit_numbers",
    "sharpened",
    "structure_for",
    "touched",
    "with_jumps",
    "with_scatter_of_blocks",
    "without_fragile",
    "without_orders",
]
