"""What the variables of a MATLAB file mean: which are channels, which are the clock and the units."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import cast

import numpy as np

from shaftprint.errors import RecordingError
from shaftprint.recording._recording import Channel, Source
from shaftprint.recording.readers._clock import Clock, uniform_clock
from shaftprint.recording.readers._hints import expect_hints

_TIME_NAMES = ("time", "t")
_RATE_NAMES = ("sample_rate_hz", "fs")
_START_NAME = "start_s"
_RATE_AGREEMENT = 1e-6


@dataclass(frozen=True, kw_only=True, slots=True)
class MatVariables:
    """The variables of a MATLAB file by their kind."""

    vectors: Mapping[str, int]
    """Length of every real vector with at least two elements."""
    scalars: Mapping[str, float]
    """Value of every real scalar."""
    texts: Mapping[str, str]
    """Every char variable."""


def rate_hint(path: Path, hints: Mapping[str, object]) -> float | None:
    """Return the hint ``sample_rate_hz`` [Hz], if given.

    Raises
    ------
    RecordingError
        If it is not a positive number, or another hint is given.
    """
    expect_hints(path, hints, {"sample_rate_hz": (int, float)})
    if "sample_rate_hz" not in hints:
        return None
    rate = cast(float, hints["sample_rate_hz"])
    if not (np.isfinite(rate) and rate > 0.0):
        raise RecordingError(f"{path}: the hint sample_rate_hz cannot be {rate:g}.")
    return rate


def mat_channels(
    path: Path,
    variables: MatVariables,
    source_of: Callable[[str], Source],
    *,
    rate_hz: float | None,
) -> dict[str, Channel]:
    """Make a channel of every vector but the time.

    The clock is a vector ``time`` or ``t`` [s], or a scalar ``sample_rate_hz`` or ``fs`` [Hz] with an optional
    scalar ``start_s``. A char variable ``<channel>_unit`` gives the unit.

    Parameters
    ----------
    path
        The file, for messages.
    variables
        What it holds.
    source_of
        Gives what reads a vector.
    rate_hz
        Sample rate that the caller knows [Hz].

    Raises
    ------
    RecordingError
        If there is no channel or no clock, or lengths or clocks disagree.
    """
    time = _only_one(path, _TIME_NAMES, variables.vectors)
    names = [name for name in variables.vectors if name != time]
    if not names:
        raise RecordingError(
            f"{path}: expected vectors of numbers as channels, found none; tables in structures are not read."
        )
    lengths = {variables.vectors[name] for name in variables.vectors}
    if len(lengths) > 1:
        listed = ", ".join(f"{name} {length}" for name, length in variables.vectors.items())
        raise RecordingError(f"{path}: expected vectors of equal length, found {listed}.")
    clock = _clock(path, variables, time, source_of, rate_hz)
    return {
        name: Channel(
            name=name,
            unit=variables.texts.get(f"{name}_unit", ""),
            rate_hz=clock.rate_hz,
            start_s=clock.start_s,
            count=variables.vectors[name],
            source=source_of(name),
        )
        for name in names
    }


def _only_one(path: Path, names: tuple[str, ...], found: Mapping[str, object]) -> str | None:
    present = [name for name in names if name in found]
    if len(present) > 1:
        raise RecordingError(f"{path}: expected one of {' or '.join(names)}, found both.")
    return present[0] if present else None


def _clock(
    path: Path,
    variables: MatVariables,
    time: str | None,
    source_of: Callable[[str], Source],
    hint_hz: float | None,
) -> Clock:
    """Take the clock from where it is said, and refuse places that disagree."""
    rates: dict[str, float] = {}
    start = variables.scalars.get(_START_NAME, 0.0)
    if time is not None:
        clock = uniform_clock(path, f"variable {time}", variables.vectors[time], source_of(time))
        rates[time] = clock.rate_hz
        start = clock.start_s
    scalar = _only_one(path, _RATE_NAMES, variables.scalars)
    if scalar is not None:
        rates[scalar] = variables.scalars[scalar]
    if hint_hz is not None:
        rates["the hint sample_rate_hz"] = hint_hz
    if not rates:
        raise RecordingError(
            f"{path}: expected a clock, that is a vector time or t in seconds or a scalar sample_rate_hz or fs, "
            "found none; pass sample_rate_hz=."
        )
    rate = next(iter(rates.values()))
    if any(abs(other - rate) > _RATE_AGREEMENT * abs(rate) for other in rates.values()):
        listed = ", ".join(f"{name} {value:g} Hz" for name, value in rates.items())
        raise RecordingError(f"{path}: expected one sample rate, found {listed}.")
    return Clock(rate_hz=rate, start_s=start)
