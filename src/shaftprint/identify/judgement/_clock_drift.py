"""Whether one channel runs on a clock of its own: lines that were tested later come later, or earlier.

The delay of a sensor is found by a fit, or rests on an assumption; that it grows from line to line is neither. How the
rest of a fit falls with it is a score test of one degree of freedom (see ``_suspects.py``), which sees a drift that a
test of all lines together does not. It is believed where no other cause would explain as much.
"""

from dataclasses import dataclass

import numpy as np

from shaftprint.distributions import chi_square_tail
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.judgement._misfit import REJECTED
from shaftprint.identify.judgement._suspects import OWN, gathered_causes, misfit_of
from shaftprint.reasons import Reason
from shaftprint.units import MILLI, PPM

# Of three clocks one stands out by so many standard deviations by chance once in 5,000 tests.
DEVIATIONS = 4.0
# No clock is off by more, and no test of this kind would reach this far if it were.
LARGEST = 2e-3
# A drift against the campaign file from which it is one, the fall of chi-square that says that the clock is that of the
# channel, and the deviations that say it is not.
LEAST, LIKELY, EXCLUDED = 5e-6, 6.0, 3.0


@dataclass(frozen=True, kw_only=True, slots=True)
class ClockDrift:
    """By how much the clock of one channel may run apart from those of the others."""

    channel: str
    """Symbol of what the channel shows."""
    share: float
    """Time that it loses a second [-]: positive where it shows things ever later."""
    std: float
    """Its standard deviation."""
    fall: float
    """Fall of chi-square with it."""
    stands_out: bool
    """Whether it is no chance, and no other cause explains as much."""


def clock_drifts(identification: Identification) -> tuple[ClockDrift, ...]:
    """Return by how much each clock may run apart; nothing where the lines do not tell, or records are fitted too."""
    if not identification.is_likelihood or identification.objective.others:
        return ()
    misfit, basis = misfit_of(identification)
    causes = gathered_causes(identification)
    directions = np.array([direction for _, direction in causes])
    across = directions - (directions @ basis) @ basis.T
    lengths = np.linalg.norm(across, axis=1)
    lengths[lengths < OWN * np.linalg.norm(directions, axis=1)] = np.inf
    pulls = across @ misfit / lengths
    falls = np.where(np.array([cause.one_sided for cause, _ in causes]) & (pulls < 0.0), 0.0, pulls**2)
    best = float(falls.max())
    spare = identification.degrees_of_freedom - 1
    rest = chi_square_tail(max(identification.chi_square - best, 0.0), spare) if spare > 0 else 0.0
    return tuple(
        ClockDrift(
            channel=cause.clock,
            share=float(pull / length),
            std=float(1.0 / length),
            fall=float(fall),
            stands_out=bool(fall == best and fall > DEVIATIONS**2 and rest > REJECTED and abs(pull / length) < LARGEST),
        )
        for (cause, _), pull, length, fall in zip(causes, pulls, lengths, falls, strict=True)
        if cause.clock and np.isfinite(length)
    )


def drift_reasons(identification: Identification) -> tuple[Reason, ...]:
    """Return a reason where one clock runs apart."""
    return tuple(
        _reason(drift, identification)
        for drift in clock_drifts(identification)
        if drift.stands_out or _is_that_of_campaign(drift, identification)
    )


def unseen_drift(identification: Identification) -> float:
    """Return by how much the clock of the input may run apart though nothing speaks for it [-].

    Where its sines keep the times of the campaign file, it is by what those are known to; where they do not, by the
    difference, unless the other channels say that it is that of whoever put them out; without a campaign file by two
    standard deviations of what the lines tell.
    """
    response = identification.response
    asked, own = response.input_drift, _own_drift(identification)
    if asked is None:
        return 0.0 if own is None else abs(own.share) + 2.0 * own.std
    if own is not None and _gain(own, asked) < -(EXCLUDED**2):
        return 0.0
    return abs(asked)


def _own_drift(identification: Identification) -> ClockDrift | None:
    name = identification.response.inputs[0]
    return next((drift for drift in clock_drifts(identification) if drift.channel == name), None)


def _is_that_of_campaign(drift: ClockDrift, identification: Identification) -> bool:
    """Return whether the other channels say that the input runs beside the campaign file by its own clock.

    Both are stated by how much: one difference is held against none, not against all that are possible.
    """
    response = identification.response
    asked = response.input_drift
    if asked is None or drift.channel != response.inputs[0] or not LEAST < abs(asked) < LARGEST:
        return False
    return _gain(drift, asked) > LIKELY and abs(drift.share - asked) < EXCLUDED * drift.std


def _gain(drift: ClockDrift, share: float) -> float:
    """Return by how much chi-square falls where the clock runs apart by a known share instead of not at all."""
    return (2.0 * share * drift.share - share**2) / drift.std**2


def _reason(drift: ClockDrift, identification: Identification) -> Reason:
    timed = [part for part in identification.experiments if part.response.middle_s.size]
    middle_s = [part.response.middle_s[part.fitted] for part in timed]
    span_s = float(np.ptp(np.concatenate(middle_s)))
    return Reason(
        kind="channel clock",
        where=drift.channel,
        sentence=(
            f"The clock of {drift.channel} is in doubt: from the first line to the last it comes "
            f"{MILLI * abs(drift.share) * span_s:.0f} ms {'later' if drift.share > 0.0 else 'earlier'} against the "
            f"other channels, as with a clock of its own that is off by {PPM * abs(drift.share):.0f} +/- "
            f"{PPM * drift.std:.0f} ppm; check whether one logger recorded all channels, and merge by a channel that "
            "both have where two did."
        ),
    )
