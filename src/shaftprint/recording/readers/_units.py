"""Ways in which loggers write the units that vessel files know."""

_PLAIN = {
    "volt": "V", "volts": "V", "v": "V", "nm": "N m", "n·m": "N m", "n*m": "N m", "n.m": "N m", "newton metre": "N m",
    "newton-meter": "N m", "newton meters": "N m",
    "knm": "kN m", "kn·m": "kN m", "kn.m": "kN m", "percent": "%", "pct": "%", "kt": "kn", "kts": "kn", "knot": "kn",
    "knots": "kn", "sec": "s", "secs": "s", "second": "s", "seconds": "s", "m s-1": "m/s",
    "m s^-1": "m/s", "mps": "m/s", "hertz": "Hz", "hz": "Hz",
}  # fmt: skip

_SECONDS = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "μs": 1e-6, "ns": 1e-9, "min": 60.0, "h": 3600.0}


def plain_unit(text: str) -> str:
    """Return a unit as vessel files write it; one that they do not know as it is."""
    text = text.strip().strip("\0").strip()
    return _PLAIN.get(text.lower(), text)


def seconds_in(text: str) -> float | None:
    """Return how many seconds a unit of time has; None where it is no unit of time."""
    return _SECONDS.get(plain_unit(text))
