"""Units of time as loggers write them."""

from shaftprint.units import plain_unit

_SECONDS = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "μs": 1e-6, "ns": 1e-9, "min": 60.0, "h": 3600.0}


def seconds_in(text: str) -> float | None:
    """Return how many seconds a unit of time has; None where it is no unit of time."""
    return _SECONDS.get(plain_unit(text))
