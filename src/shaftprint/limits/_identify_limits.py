"""The verb: which limits governor and engine have, and how large they are."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from shaftprint.campaign._campaign import Campaign
from shaftprint.catalogue._limited_governor import GovernorSymbol, limited_governor
from shaftprint.errors import SettingsError
from shaftprint.identify.fit._estimate import Estimate
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.limits._candidates import CANDIDATES, Kind
from shaftprint.limits._governor_fit import GOVERNOR, Fitted, fitted, identified, schwarz
from shaftprint.limits._limit_fit import LimitFit
from shaftprint.limits._numbers import (
    Units,
    doubt_of_line,
    exclusion,
    hardly_seen,
    messages_exclusion,
    numbers_of,
    quantum_exclusion,
    quantum_number,
    reached,
)
from shaftprint.limits._search import Scanned, Search, with_messages
from shaftprint.limits._set_point_quantum import quantum_of
from shaftprint.limits._uncertainty import LevelScatter, spread_of
from shaftprint.limits.prediction._governor_test import governor_test
from shaftprint.limits.prediction._held_set_point import Messages
from shaftprint.models._structure import Structure
from shaftprint.signals._signals import Signals
from shaftprint.vessel._vessel import Vessel

# Drive of the search [Hz]; levels do not depend on milliseconds, and the reported fit has twice as much.
COARSE_HZ = 100.0
# Offset of the set point's line at the working point, over its speed, that a good calibration leaves.
LEAST_OFFSET_STD = 5e-4
# A level that costs so much of twice the log-likelihood is excluded.
EXCLUDED = 15.0
# How many times further off the governor is than its noise model and the scatter state, root mean square of the worst
# number over 39 drawn ships with a smoke limit (t_d 2.5, t_sp 2.4, K_p and the actuation 1.7; benchmarks/boost.py): the
# measured speed has noise that the governor did not feel. Levels are as far off as stated.
GOVERNOR_OFF = 2.4
# Most steps of the fit that is reported.
FINE = 24
LIMITS = ("torque", "rate", "deadband", "ramp", "smoke")


def expect_engine(vessel: Vessel) -> None:
    """Refuse a line that a motor drives: what a converter limits is set in it, and no governor's limits are looked for.

    Raises SettingsError if a motor drives the line.
    """
    if vessel.motor is not None:
        raise SettingsError(
            f"vessel {vessel.name}: expected [engine], whose limits can be found, found [motor]; its limits are set in "
            "the converter, read them there, and identify the line without limits."
        )


def identify_limits(
    signals: Signals,
    campaign: Campaign,
    vessel: Vessel,
    *,
    progress: Callable[[str, str], None] | None = None,
) -> LimitFit:
    """Find the limits of governor and engine, and their levels, rates and widths with intervals.

    The governor is predicted on the measured speed, so that no law of the propeller and no disturbance of the speed is
    assumed; limits join it one after the other as long as the likelihood asks for them.

    Parameters
    ----------
    signals, campaign, vessel
        The prepared recording, what was asked, and the installation: inertia upstream of the gauge and full-load curve
        are taken from it.
    progress
        Called with the step that is being done, and with what of it.

    Raises
    ------
    SignalError
        If the recording does not hold the tests of the campaign.
    IdentificationError
        If no governor can be simulated on the measured speed.
    SettingsError
        If a motor drives the line.
    """
    expect_engine(vessel)
    say = progress or _silent
    test = governor_test(signals, campaign, vessel)
    units = Units.of(signals, vessel)
    governor = whole_governor()
    priors = set_point_priors(signals)
    looking = partial(say, "Looking for limits")
    search = Search.of(governor, test, campaign, drive_hz=COARSE_HZ, full=units.full, priors=priors, say=looking)
    here, scanned = search.run()
    say("Fitting the limits", "")
    test = with_messages(test, here.messages)
    rough = fitted(
        governor,
        test.record(),
        here.values,
        here.kinds,
        priors=priors,
        iterations=FINE,
        messages=here.messages,
        near=here,
        recent=search.recent,
    )
    best, identification = identified(rough)
    spread = spread_of(best, test, signals, vessel)
    numbers = numbers_of(best, spread, units, search.reach, say=partial(say, "Finding the intervals"))
    say("Comparing the limits", "")
    gains = _gains(search, here)
    not_seen = _not_seen(here, scanned, search.messages(here), units)
    quantum = quantum_of(best, test, campaign)
    if quantum is not None and quantum.acts:
        numbers, gains = (*numbers, quantum_number(quantum, units, best)), {**gains, Kind.QUANTUM: quantum.gain}
    else:
        not_seen = {**not_seen, Kind.QUANTUM: quantum_exclusion(quantum, units)}
    weak = hardly_seen(numbers, gains)
    return LimitFit(
        numbers=tuple(number for number in numbers if Kind(number.limit) not in weak),
        gains={kind: gain for kind, gain in gains.items() if kind not in weak},
        governor=_governor(best, spread, identification),
        not_seen={**not_seen, **weak},
        identification=identification,
        reached=reached(search.reach, units),
    )


def _governor(fit: Fitted, spread: LevelScatter, identification: Identification) -> tuple[Estimate, ...]:
    """Return governor and delays; none known where the line of the set point is not."""
    wider = np.inf if doubt_of_line(fit) else GOVERNOR_OFF
    return tuple(
        replace(estimate, std=wider * spread.std(estimate.name))
        for estimate in identification.parameters
        if estimate.name in GOVERNOR
    )


def set_point_priors(signals: Signals) -> dict[str, Prior]:
    """Return what the calibration says of scale and offset of the set point."""
    return {
        GovernorSymbol.SET_POINT_SCALE: Prior(1.0, max(signals.dc_scale_std / signals.dc_scale, 1e-4)),
        GovernorSymbol.SET_POINT_OFFSET: Prior(0.0, _offset_std(signals)),
    }


def _offset_std(signals: Signals) -> float:
    """Return the deviation of the set point's line at the working point, over its speed.

    The speed of the working point is that of the line. Where large sines meet a torque limit the mean speed falls
    behind the set point, and the line with it.
    """
    point = signals.working_point
    return float(np.hypot(point.engine_speed_std_rev_s / point.engine_speed_rev_s, LEAST_OFFSET_STD))


def whole_governor() -> Structure:
    """Return the governor with all limits, its actuation within what engines of ships have."""
    return limited_governor(*LIMITS).free_between(zeta=(0.1, 1.5), omega_n=(3.0, 40.0), t_sp=(0.0, 0.3))


def _gains(search: Search, here: Fitted) -> Mapping[Kind, float]:
    """Return what each limit brings to the others."""
    gains = {kind: schwarz(search.without(here, kind)) - schwarz(here) for kind in here.kinds}
    return dict(sorted(gains.items(), key=lambda pair: -pair[1]))


def _not_seen(here: Fitted, scanned: Sequence[Scanned], messages: Messages | None, units: Units) -> Mapping[Kind, str]:
    """Return up to which level each limit that does not act is excluded."""
    excluded = {}
    for candidate in CANDIDATES:
        tried = [one for one in scanned if one.candidate.kind is candidate.kind]
        if candidate.kind in here.kinds or not tried:
            continue
        level = None
        # the strongest limit comes first; of several starts of one level the one that costs least counts
        for value in dict.fromkeys(one.start[candidate.level] for one in tried):
            if max(one.gain for one in tried if one.start[candidate.level] == value) > -EXCLUDED:
                break
            level = value
        excluded[candidate.kind] = exclusion(candidate, level, units)
    if Kind.HELD not in here.kinds:
        excluded[Kind.HELD] = messages_exclusion(None if messages is None else messages.excluded_beyond(EXCLUDED))
    return excluded


def _silent(step: str, detail: str) -> None:
    """Say nothing."""
