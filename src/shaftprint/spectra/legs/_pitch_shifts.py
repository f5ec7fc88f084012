"""Whether the logged pitch and what asks for it are shifted against each other while a leg is tested.

The hydraulics follow each period alike, so that a shift from one instant on is samples that one of the channels lost,
and one that grows is two clocks. Either is half in the delay of the pitch, which nothing else shows.
"""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.distributions import f_tail
from shaftprint.reasons import Reason
from shaftprint.units import MILLI, PPM

if TYPE_CHECKING:
    from shaftprint.spectra.legs._leg_lines import LegLines

_PITCH = "theta"
_FEWEST_PERIODS = 5
# A shift below it moves no delay by more than its clocks may [s]; chance makes one of a course once in a thousand
# times, of a size that counts in fewer.
_LEAST_S, _BY_CHANCE = 0.008, 1e-3


def pitch_shift_reasons(measured: "LegLines", *, moved: str, shown: str) -> tuple[Reason, ...]:
    """Return a reason where the pitch shifts against what asks for it; nothing where it is not logged.

    ``measured``: the lines of the leg. ``moved``, ``shown``: channels of what asks for the pitch and of the pitch.
    """
    window = measured.window
    if _PITCH not in window.channels or window.state.periods < _FEWEST_PERIODS:
        return ()
    found = shift_of_periods(_late_s(measured))
    if found is None:
        return ()
    size_s, first = found
    state = window.state
    span_s = state.period_s * (state.periods - 1)
    course = (
        f"by {MILLI * abs(size_s):.0f} ms from the first period of {state.name} to the last, as with clocks that are "
        f"{PPM * abs(size_s) / span_s:.0f} ppm apart"
        if first is None
        else f"by {MILLI * abs(size_s):.0f} ms from about {state.start_s + first * state.period_s:.0f} s on"
    )
    return (
        Reason(
            # behind the set point of the speed it may be that one
            kind="late set point" if measured.lines[0].excitation == "n_set" else "late pitch feedback",
            where=_PITCH,
            sentence=(
                f"Channel {shown} comes {'later' if size_s > 0.0 else 'earlier'} behind {moved} {course}, though the "
                "pitch follows each period alike: look for samples that one of the two lost, or a clock of its own."
            ),
        ),
    )


def shift_of_periods(late_s: FloatArray) -> tuple[float, int | None] | None:
    """Return by how much periods shift [s], and during which one, None where it grows; None where chance explains it.

    ``late_s``: by how much the pitch is later in each period than in all, shape (periods,).
    """
    place = np.arange(late_s.size)
    courses = [(place / (late_s.size - 1.0), place >= 0, None)]
    # a piece is lost between two periods or during one, which is then late by a part of it
    courses += [(place >= first, place >= 0, first) for first in place[1:].tolist()]
    courses += [(place > first, place != first, first) for first in place[1:-1].tolist()]
    best, shift = _BY_CHANCE, None
    for course, counted, first in courses:
        late, about = late_s[counted] - late_s[counted].mean(), course[counted] - course[counted].mean()
        size_s = float(about @ late / (about @ about))
        left, spare = float(np.sum((late - size_s * about) ** 2)), late.size - 2
        ratio = (float(late @ late) - left) / max(left, np.finfo(np.float64).tiny) * spare
        by_chance = f_tail(ratio, 1.0, spare)
        if by_chance < best and abs(size_s) > _LEAST_S:
            best, shift = by_chance, (size_s, first)
    return shift


def _late_s(measured: "LegLines") -> FloatArray:
    """Return by how much the pitch is later behind what asks for it in each period than in all, shape (periods,)."""
    window = measured.window
    lines = window.by_period()[:, :, list(measured.harmonics)]
    turn = np.angle(lines * lines.mean(axis=1, keepdims=True).conj())
    pitch, asked = (window.channels.index(name) for name in (_PITCH, measured.lines[0].excitation))
    omega = 2.0 * np.pi * np.array(measured.harmonics) / window.state.period_s
    weight = omega * np.mean(np.abs(lines[pitch]) ** 2, axis=0)
    late_s = (turn[asked] - turn[pitch]) @ weight / float(weight @ omega)
    return np.asarray(late_s - late_s.mean(), dtype=np.float64)
