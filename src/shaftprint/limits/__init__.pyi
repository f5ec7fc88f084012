from ._candidates import Kind
from ._identify_limits import identify_limits
from ._limit_fit import LimitFit
from ._limit_hints import limit_hints

__all__ = [
    "Kind",
    "LimitFit",
    "identify_limits",
    "limit_hints",
]
