"""Finding one uniform clock in a column of times."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import RecordingError

_BLOCK = 1_000_000

# Times are printed with few decimals: a step may be off by this part of the mean step, as may be the place
# of a sample on the uniform grid. A sample that is missing or doubled is off by a whole step.
_STEP_TOLERANCE = 0.5


@dataclass(frozen=True, kw_only=True, slots=True)
class Clock:
    """When the samples of a channel were taken."""

    rate_hz: float
    """Sample rate [Hz]."""
    start_s: float
    """Time of the first sample [s]."""


def uniform_clock(path: Path, name: str, count: int, read: Callable[[int, int], FloatArray]) -> Clock:
    """Return the clock of a column of times, which must be uniform.

    The rate is the number of steps over the whole time, rounded to nine digits because printed times are
    rounded too.

    Parameters
    ----------
    path, name
        File and column, for messages.
    count
        Number of times.
    read
        Gives the times [start, stop) [s].

    Raises
    ------
    RecordingError
        If there are fewer than two times, or a step is not the others'; the message names the row.
    """
    if count < 2:
        raise RecordingError(f"{path}, {name}: expected at least 2 rows of times, found {count}.")
    first, last = float(read(0, 1)[0]), float(read(count - 1, count)[0])
    steps = np.diff(read(0, min(count, 1001)))
    steps = steps[np.isfinite(steps)]
    step = float(np.median(steps)) if steps.size else np.nan
    if not step > 0.0:
        raise RecordingError(f"{path}, {name}: expected ascending times, found a step of {step:g} s.")
    _expect_equal_steps(path, name, count, read, step)
    mean_step = (last - first) / (count - 1)
    for start in range(0, count, _BLOCK):
        stop = min(start + _BLOCK, count)
        off = np.abs(read(start, stop) - (first + mean_step * np.arange(start, stop)))
        worst = int(np.argmax(off))
        if off[worst] > _STEP_TOLERANCE * mean_step:
            raise RecordingError(
                f"{path}, {name}: expected a uniform clock, found row {start + worst + 1} off by {off[worst]:g} s; "
                "the sample rate changes within the file."
            )
    return Clock(rate_hz=float(f"{1.0 / mean_step:.9g}"), start_s=first)


def _expect_equal_steps(path: Path, name: str, count: int, read: Callable[[int, int], FloatArray], step: float) -> None:
    for start in range(0, count - 1, _BLOCK):
        steps = np.diff(read(start, min(start + _BLOCK + 1, count)))
        # written so that a time that is not a number counts as wrong
        wrong = np.flatnonzero(~(np.abs(steps - step) <= _STEP_TOLERANCE * step))
        if wrong.size:
            row = start + int(wrong[0]) + 2
            raise RecordingError(
                f"{path}, {name}: expected a step of {step:g} s, found {steps[wrong[0]]:g} s before row {row}; "
                "resample the file or cut it there."
            )
