"""Where a test leaves the limits of ship and engine: of a campaign as it is expected, of a recording as it was sailed.

Both give an ``Operation``, and ``limit_uses`` holds it against ``Limits``: the one place where that is done.
"""

from shaftprint.design.operation._expected import expected_operation, inputs_left_out
from shaftprint.design.operation._limit_use import LimitUse, limit_uses, stated_limits
from shaftprint.design.operation._operation import Operation
from shaftprint.design.operation._recorded import recorded_operation

__all__ = [
    "LimitUse",
    "Operation",
    "expected_operation",
    "inputs_left_out",
    "limit_uses",
    "recorded_operation",
    "stated_limits",
]
