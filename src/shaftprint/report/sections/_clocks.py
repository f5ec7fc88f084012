"""The clocks of loggers that were merged, in words: how they were, how well that is known, and what it does."""

import math
from typing import TYPE_CHECKING

from shaftprint.digits import plain, rounded, with_deviation
from shaftprint.fingerprint._clock_influence import NOTABLE_SHIFT
from shaftprint.spelling import listed
from shaftprint.tables._recording import clock_deviations
from shaftprint.units import MILLI, PPM

if TYPE_CHECKING:
    from shaftprint.clocks._alignment import Alignment
    from shaftprint.clocks._logger_clock import LoggerClock
    from shaftprint.fingerprint._clock_influence import ClockInfluence

# Minutes that scatter so many times further than their noise explains lie on no straight line.
UNEVEN = 2.0


def clock_sentences(clock: "LoggerClock", influence: "ClockInfluence") -> str:
    """Return in words how the clock of one logger was, how well that is known, and what it does to the result."""
    fit = clock.alignment
    offset_std, drift_std, _ = clock_deviations(fit)
    offset = with_deviation(MILLI * abs(fit.map.offset_s), MILLI * offset_std)
    drift = with_deviation(PPM * abs(fit.map.drift), PPM * drift_std)
    behind = "behind" if fit.map.offset_s >= 0.0 else "ahead of"
    slow = "slow" if fit.map.drift >= 0.0 else "fast"
    return (
        f"{listed(clock.channels)} {'was' if len(clock.channels) == 1 else 'were'} logged by {clock.logger}, whose "
        f"clock was {offset} ms {behind} that of {clock.reference} at {plain(fit.map.middle_s, 0)} s and ran {drift} "
        f"ppm {slow}. {_rest(fit)} {_influence(influence)}"
    )


def _rest(fit: "Alignment") -> str:
    worst = f"nowhere in the recording is that known worse than to {rounded(MILLI * fit.worst_std_s, 2)} ms"
    if not fit.stretches:
        return f"This was given, not found from what both saw; {worst}."
    count = len(fit.stretches)
    if fit.scatter is None or count == 1:
        return f"One stretch was compared; {worst}."
    words = f"The {count} minutes that were compared scatter {plain(fit.scatter, 2)} times as far as their "
    if fit.scatter > UNEVEN:
        return f"{words}noise explains: the clock did not run evenly. Widened by as much, {worst}."
    return f"{words}noise explains; {worst}."


def _influence(effect: "ClockInfluence") -> str:
    if not effect.moved:
        return "The result does not depend on it: it moves none of set point, speed and torque against the others."
    outputs, degrees = listed(effect.moved), math.degrees(effect.phase_rad)
    words = (
        f"An error of that size turns the phase of {outputs} over the set point by {rounded(degrees, 2)}° at "
        f"{effect.line} ({rounded(effect.frequency_hz, 3)} Hz), the highest line that was used. All lines together "
        f"determine such a delay to {rounded(MILLI * effect.delay_std_s, 2)} ms, so that it moves no parameter by more "
        f"than {rounded(effect.shift, 2)} of its standard deviation."
    )
    if effect.shift > NOTABLE_SHIFT:
        return f"{words} The standard deviations of this report do not hold it and are too small."
    return f"{words} The standard deviations of this report do not hold it."
