"""The clocks of loggers that were merged: how they read on the recording's clock, and what is uncertain by it."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from shaftprint.fingerprint import NOTABLE_SHIFT
from shaftprint.report._numbers import plain, rounded, with_deviation
from shaftprint.report._table import Cell, Table
from shaftprint.units import MILLI, PPM

if TYPE_CHECKING:
    from shaftprint.clocks import Alignment, LoggerClock
    from shaftprint.fingerprint import ClockInfluence

# Minutes that scatter so many times further than their noise explains lie on no straight line.
UNEVEN = 2.0


def clock_map_table(clocks: "Sequence[LoggerClock]") -> Table:
    """Return how the clocks of other loggers read on the clock of the recording."""
    rows: list[tuple[Cell, ...]] = []
    for clock in clocks:
        found = clock.alignment
        offset_std, drift_std, correlation = _deviations(found)
        rows.append(
            (
                clock.logger,
                ", ".join(clock.channels),
                with_deviation(MILLI * found.map.offset_s, MILLI * offset_std),
                plain(found.map.middle_s, 1),
                with_deviation(PPM * found.map.drift, PPM * drift_std),
                plain(correlation, 2),
                rounded(MILLI * found.worst_std_s, 2),
                str(len(found.stretches)),
                "–" if found.scatter is None else plain(found.scatter, 2),
            )
        )
    return Table(
        caption="Clock maps of the other loggers",
        header=(
            "logger", "channels", "offset [ms]", "at [s]", "drift [ppm]", "correlation", "largest std [ms]", "minutes",
            "scatter",
        ),
        rows=tuple(rows),
        note="The recording's clock reads the offset more at the given time of the logger, and runs faster by the "
        "drift. The largest standard deviation is that within the recording; the scatter is that of the minutes "
        "compared over what their noise explains. Samples are not moved: channels of another logger get another start "
        "and rate.",
    )  # fmt: skip


def clock_sentences(clock: "LoggerClock", influence: "ClockInfluence") -> str:
    """Return in words how the clock of one logger was, how well that is known, and what it does to the result."""
    found = clock.alignment
    offset_std, drift_std, _ = _deviations(found)
    offset = with_deviation(MILLI * abs(found.map.offset_s), MILLI * offset_std)
    drift = with_deviation(PPM * abs(found.map.drift), PPM * drift_std)
    behind = "behind" if found.map.offset_s >= 0.0 else "ahead of"
    slow = "slow" if found.map.drift >= 0.0 else "fast"
    return (
        f"{_listed(clock.channels)} {'was' if len(clock.channels) == 1 else 'were'} logged by {clock.logger}, whose "
        f"clock was {offset} ms {behind} that of {clock.reference} at {plain(found.map.middle_s, 0)} s and ran {drift} "
        f"ppm {slow}. {_rest(found)} {_influence(influence)}"
    )


def _deviations(found: "Alignment") -> tuple[float, float, float]:
    """Return the standard deviations of offset [s] and drift [s/s], and their correlation."""
    (offset, both), (_, drift) = found.map.covariance.tolist()
    size = math.sqrt(offset * drift)
    return math.sqrt(offset), math.sqrt(drift), both / size if size > 0.0 else 0.0


def _rest(found: "Alignment") -> str:
    worst = f"nowhere in the recording is that known worse than to {rounded(MILLI * found.worst_std_s, 2)} ms"
    if found.scatter is None:
        return f"This was given, not found from what both saw; {worst}."
    count = len(found.stretches)
    if count == 1:
        return f"One minute was compared; {worst}."
    words = f"The {count} minutes that were compared scatter {plain(found.scatter, 2)} times as far as their "
    if found.scatter > UNEVEN:
        return f"{words}noise explains: the clock did not run evenly. Widened by as much, {worst}."
    return f"{words}noise explains; {worst}."


def _influence(found: "ClockInfluence") -> str:
    if not found.moved:
        return "The result does not hang on it: it moves none of set point, speed and torque against the others."
    outputs, degrees = _listed(found.moved), math.degrees(found.phase_rad)
    words = (
        f"An error of that size turns the phase of {outputs} over the set point by {rounded(degrees, 2)}° at "
        f"{found.line} ({rounded(found.frequency_hz, 3)} Hz), the highest line that was used. All lines together tell "
        f"such a delay to {rounded(MILLI * found.delay_std_s, 2)} ms, so that it moves no parameter by more than "
        f"{rounded(found.shift, 2)} of its standard deviation."
    )
    if found.shift > NOTABLE_SHIFT:
        return f"{words} The standard deviations of this report do not hold it and are too small."
    return f"{words} The standard deviations of this report do not hold it."


def _listed(names: Sequence[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"
