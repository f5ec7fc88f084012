"""Units of time as loggers write them."""

from shaftprint.units import plain_unit

_SECONDS = {
    "s": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "μs": 1e-6, "ns": 1e-9, "min": 60.0, "h": 3600.0, "d": 86_400.0,
    "msec": 1e-3, "usec": 1e-6, "nsec": 1e-9, "millis": 1e-3, "micros": 1e-6, "nanos": 1e-9, "mins": 60.0,
    "millisecond": 1e-3, "microsecond": 1e-6, "nanosecond": 1e-9, "minute": 60.0, "hr": 3600.0, "hour": 3600.0,
    "day": 86_400.0, "sekunde": 1.0, "sekunden": 1.0, "minuten": 60.0, "stunden": 3600.0, "tage": 86_400.0,
    "unix": 1.0, "unix time": 1.0, "posix": 1.0, "epoch": 1.0,
}  # fmt: skip


def seconds_in(text: str) -> float | None:
    """Return how many seconds a unit of time has; None where it is no unit of time."""
    unit = plain_unit(text)
    word = unit.lower()
    # M and S stand for other things than minutes and seconds; only words are the same in capitals
    seconds = _SECONDS.get(unit)
    return seconds if seconds is not None or len(word) < 3 else _SECONDS.get(word, _SECONDS.get(word.removesuffix("s")))
