"""The clock of segments that follow each other by their times, beside a rate that their heads print."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.recording.readers._clock import Hole, SampleClock, clock_of_times, printed_step

# Times of a clock stray by no more than this part of a step and so many of their last decimals, the finest where they
# have more than are looked for; a rate is kept with nine digits.
_STRAYING, _DECIMALS, _FINEST_S, _JUDGED, _NINE_DIGITS = 0.02, 2.0, 1e-6, 1000, 1e-9
# Distances of two segments, to this part of a step; a hole is whole samples long to less than that. One that is so many
# times as long as all rows is kept as a jump.
_HALF, _WHOLE, _LONGEST_HOLE = 0.5, 0.05, 20


def clock_of_segments(
    path: Path, name: str, pieces: Sequence[FloatArray], rate_hz: float | None, remarks: list[str]
) -> SampleClock:
    """Return the clock of all segments; its rate is the printed one where the times agree with that.

    ``path``, ``name``: file and channel, for messages. ``pieces``: times of each segment [s]. ``rate_hz``: the rate
    that the heads print [Hz], where they do. ``remarks``: gets a sentence on what is missing between segments. Raises
    RecordingError if the times are those of no clock and no sender.
    """
    seconds = np.concatenate(pieces)
    decimal_s = _DECIMALS * (printed_step(seconds[:_JUDGED]) or _FINEST_S)

    def nearest(measured_hz: float) -> float:
        """Return the printed rate where times and their printing do not contradict it."""
        if rate_hz is None:
            return measured_hz
        off_s = abs(1.0 / measured_hz - 1.0 / rate_hz) * seconds.size
        return rate_hz if off_s <= decimal_s * len(pieces) + _NINE_DIGITS * seconds.size / rate_hz else measured_hz

    steps, spans_s = sum(piece.size - 1 for piece in pieces), sum(float(piece[-1] - piece[0]) for piece in pieces)
    if len(pieces) > 1 and steps and spans_s > 0.0:
        rate = nearest(float(f"{steps / spans_s:.9g}"))
        strays_s = _STRAYING / rate + decimal_s
        if all(np.all(np.abs(np.diff(piece) - 1.0 / rate) <= strays_s) for piece in pieces):
            holes = _holes_between(pieces, rate, remarks)
            if holes:
                return SampleClock(rate_hz=rate, start_s=float(seconds[0]), holes=holes)
    clock = clock_of_times(path, f"the times of {name}", seconds.size, lambda start, stop: seconds[start:stop])
    return clock if clock.is_uneven else replace(clock, rate_hz=nearest(clock.rate_hz))


def _holes_between(pieces: Sequence[FloatArray], rate_hz: float, remarks: list[str]) -> tuple[Hole, ...]:
    """Return where whole samples are missing between segments, or the clock jumps."""
    count = sum(piece.size for piece in pieces)
    holes, row, longest_s = [], 0, 0.0
    for before, after in pairwise(pieces):
        row += before.size
        gap = float(after[0] - before[-1]) * rate_hz - 1.0
        if abs(gap) < _HALF:
            continue
        missing = round(gap)
        longest_s = max(longest_s, gap / rate_hz)
        is_hole = 0 < missing < _LONGEST_HOLE * count and abs(gap - missing) <= _WHOLE
        holes.append(
            Hole(row=row, missing=missing, jump_s=0.0) if is_hole else Hole(row=row, missing=0, jump_s=gap / rate_hz)
        )
    if holes:
        remarks.append(
            f"{len(pieces)} segments, up to {longest_s:.6g} s apart; whole samples that are missing between two "
            "are no numbers, other distances are kept as jumps of the clock."
        )
    return tuple(holes)
