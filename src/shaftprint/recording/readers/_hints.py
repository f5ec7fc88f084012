"""What a caller may add where a file does not say it."""

import math
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import cast

from shaftprint.errors import RecordingError

OF_HINT = "the hint sample_rate_hz"


def expect_hints(path: Path, hints: Mapping[str, object], accepted: Mapping[str, type | tuple[type, ...]]) -> None:
    """Refuse hints that a reader does not know or that are of the wrong type.

    Raises RecordingError if a hint is unknown or of the wrong type.
    """
    for name, value in hints.items():
        if name not in accepted:
            raise RecordingError(f"{path}: expected {_listed(accepted)} for this format, found the hint {name}.")
        if not isinstance(value, accepted[name]) or isinstance(value, bool):
            raise RecordingError(f"{path}: the hint {name} cannot be {value!r}.")


def rate_hint(
    path: Path, hints: Mapping[str, object], others: Mapping[str, type | tuple[type, ...]] = MappingProxyType({})
) -> float | None:
    """Return the hint ``sample_rate_hz`` [Hz], if given; besides it only ``others`` are accepted.

    Raises RecordingError if it is not a positive number, or a hint is given that is not known.
    """
    expect_hints(path, hints, {**others, "sample_rate_hz": (int, float)})
    if "sample_rate_hz" not in hints:
        return None
    rate = float(cast(float, hints["sample_rate_hz"]))
    if not (math.isfinite(rate) and rate > 0.0):
        raise RecordingError(f"{path}: the hint sample_rate_hz cannot be {rate:g}.")
    return rate


def expect_one_rate(path: Path, rates: Mapping[str, float], agreement: float) -> None:
    """Refuse sample rates that contradict each other.

    ``rates``: each by what says it, that of the caller by `OF_HINT` [Hz]. ``agreement``: the share by which they may be
    apart. Raises RecordingError if they are further apart.
    """
    rate_hz, *others = rates.values()
    if not all(abs(other - rate_hz) <= agreement * abs(rate_hz) for other in others):
        listed = ", ".join(f"{name} {value:g} Hz" for name, value in rates.items())
        raise RecordingError(f"{path}: expected one sample rate, found {listed}.")


def _listed(accepted: Mapping[str, object]) -> str:
    return f"only the hints {', '.join(accepted)}" if accepted else "no hints"
