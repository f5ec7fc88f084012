"""The headline of ``inspect``: what is worst of a recording, and how much of its test may be used.

It is made when everything has been looked at, so that nothing that stands below it says otherwise.
"""

from __future__ import annotations

from collections.abc import Sequence

from shaftprint.late import late

with late():
    import numpy as np

    from shaftprint.campaign._campaign import Campaign
    from shaftprint.identify.judgement._line_quality import good_lines
    from shaftprint.reasons import Reason
    from shaftprint.signals._load_reasons import points_of, propeller_reason, torque_to_look_at
    from shaftprint.signals._signals import Signals
    from shaftprint.spectra._spectra import Spectra
    from shaftprint.spelling import listed
    from shaftprint.vessel._vessel import Vessel


# GAUGE-CLOSED has about ten free parameters and a line gives four numbers: twice what is needed at the least.
FEWEST_LINES = 5
# Where governed lines of this size cross over: there delay, lag and proportional gain show.
CROSSOVER_RAD_S = (1.0, 12.0)
FEWEST_AT_CROSSOVER = 2
_NO_NAMES = ("channel", "expected", "sensors", "the ")
"""How sentences begin that may begin with a capital; others begin with the name of a file or a sensor."""


def headline(parts: Sequence[Spectra], *, planned: int = 0, worst: str = "", lost: Sequence[str] = ()) -> str:
    """Return in a few sentences whether a test is good enough to identify a propulsion line.

    ``parts``: spectra of the sines, or of every leg; empty where they are refused. ``planned``: number of lines of the
    campaign, those of all legs. ``worst``: what is worst of all that was found, in one sentence; empty where nothing
    speaks against the recording. ``lost``: what the recording does not hold of its campaign, from ``lost_parts``.
    """
    worst = f"{worst[:1].upper()}{worst[1:]}" if worst.startswith(_NO_NAMES) else worst
    if not parts:
        return f"Not good enough. {worst}"
    counts, missing, advice = _counted(parts, planned)
    of_lost = f" Not all of the campaign is there: {listed(lost)}." if lost else ""
    if missing:
        return f"Not good enough: {counts}{missing}.{of_lost or advice}{f' {worst}' if worst else ''}"
    if worst:
        return f"Not as it is. {worst} Else {counts}, where the loop crosses over.{of_lost}"
    return f"Good enough{', as far as it goes' if lost else ''}: {counts}, where the loop crosses over.{of_lost}"


def is_good_enough(parts: Sequence[Spectra], *, worst: str = "") -> bool:
    """Return whether a recording may be identified as it is; arguments as of ``headline``."""
    return bool(parts) and not worst and not _counted(parts, 0)[1]


def lost_parts(campaign: Campaign, signals: Signals, parts: Sequence[Spectra]) -> tuple[str, ...]:
    """Return which sines and legs of a campaign are lost, and how much is left of those that are lost in part."""
    measured = {line for one in parts for line, used in zip(one.response.lines, one.response.used, strict=True) if used}
    sines = [sine.name for sine in campaign.of_input().sines if sine.name not in measured]
    left = {state.name: state.periods for state in signals.legs}
    words = [f"{listed(sines)} {'is' if len(sines) == 1 else 'are'} lost"] if sines else []
    for leg in campaign.legs:
        if leg.name not in left:
            words.append(f"{leg.name} is lost")
        elif left[leg.name] < leg.periods:
            words.append(f"{leg.name} has {left[leg.name]} of its {leg.periods} periods")
    return tuple(words)


def of_propeller(signals: Signals, ship: Vessel) -> tuple[Reason, ...]:
    """Return that the torque belongs to a propeller of another size, or to another gear ratio."""
    point = signals.working_point
    reason = propeller_reason(ship.coefficient_of(point.shaft_torque_nm, point.engine_speed_rev_s), point, ship)
    return () if reason is None else (reason,)


def of_torque(signals: Signals, ship: Vessel) -> tuple[str, ...]:
    """Return that the torque is not that of the vessel file's propeller: the recording is as good as it is."""
    of_size = tuple(one.sentence for one in of_propeller(signals, ship))
    sentence = torque_to_look_at(points_of(signals), ship)
    return of_size or ((sentence,) if sentence else ())


def lines_of(campaign: Campaign) -> int:
    """Return how many lines a campaign asks for, those of all legs."""
    return len(campaign.of_input().sines) + sum(len(leg.lines) for leg in campaign.legs)


def _counted(parts: Sequence[Spectra], planned: int) -> tuple[str, str, str]:
    """Return how many lines are good, those of all legs, what is missing and what to do; empty where nothing is."""
    good = [good_lines(one.response, one.signal_to_noise) for one in parts]
    omega = np.concatenate([one.response.omega_rad_s[which] for one, which in zip(parts, good, strict=True)])
    crossover = int(np.count_nonzero((omega >= CROSSOVER_RAD_S[0]) & (omega <= CROSSOVER_RAD_S[1])))
    between = f"{crossover} of them between {CROSSOVER_RAD_S[0]:g} and {CROSSOVER_RAD_S[1]:g} rad/s"
    counts = f"{omega.size} of {max(planned, sum(which.size for which in good))} lines are good, {between}"
    if omega.size < FEWEST_LINES:
        return counts, f"; at least {FEWEST_LINES} are needed", " Use a larger amplitude or more lines."
    if crossover < FEWEST_AT_CROSSOVER:
        needed = f"at least {FEWEST_AT_CROSSOVER} are needed there to find delay, lag and gain"
        return counts, f", where the loop crosses over; {needed}", ""
    return counts, "", ""
