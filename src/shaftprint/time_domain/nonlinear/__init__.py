"""Lines with limits: from small signals and large in one likelihood to the levels of the limits."""

from shaftprint.time_domain.nonlinear._covariance import with_scatter_of_blocks
from shaftprint.time_domain.nonlinear._drive import Jump, jumps_in, with_exact_jumps, with_jumps
from shaftprint.time_domain.nonlinear._fit import NonlinearFit, identify_nonlinear
from shaftprint.time_domain.nonlinear._jump_resonance import JumpStretch, jump_stretches, without_jumps
from shaftprint.time_domain.nonlinear._limited_sines import limited_sines
from shaftprint.time_domain.nonlinear._numbers import LimitNumber, limit_numbers
from shaftprint.time_domain.nonlinear._orders import without_orders
from shaftprint.time_domain.nonlinear._search import SomeDrawn
from shaftprint.time_domain.nonlinear._settings import NonlinearSettings
from shaftprint.time_domain.nonlinear._structure import LimitedModel, structure_for

__all__ = [
    "Jump",
    "JumpStretch",
    "LimitNumber",
    "LimitedModel",
    "NonlinearFit",
    "NonlinearSettings",
    "SomeDrawn",
    "identify_nonlinear",
    "jump_stretches",
    "jumps_in",
    "limit_numbers",
    "limited_sines",
    "structure_for",
    "with_exact_jumps",
    "with_jumps",
    "with_scatter_of_blocks",
    "without_jumps",
    "without_orders",
]
