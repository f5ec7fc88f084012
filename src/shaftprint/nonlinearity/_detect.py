"""The verb of the room: which nonlinearities a recording shows."""

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from shaftprint.arguments import refusing_none
from shaftprint.errors import SignalError
from shaftprint.nonlinearity._fit import GOVERNOR, fit_governor
from shaftprint.nonlinearity._harmonic_evidence import harmonic_evidence
from shaftprint.nonlinearity._level_evidence import level_evidence
from shaftprint.nonlinearity._limit_evidence import limit_evidence
from shaftprint.nonlinearity._nonlinearities import Nonlinearities, Suspicion
from shaftprint.nonlinearity._record import make_record
from shaftprint.nonlinearity._search import Outcome, Present, search, windup_statistic
from shaftprint.nonlinearity._step_evidence import step_evidence
from shaftprint.nonlinearity._systematic import with_systematic
from shaftprint.nonlinearity._tails import chi_square_tail
from shaftprint.nonlinearity._words import finding_of, nothing_found, sentence_of

if TYPE_CHECKING:
    from shaftprint.campaign import Campaign
    from shaftprint.signals import Signals
    from shaftprint.vessel import Vessel

FALSE_ALARM = 1e-3
"""How often a linear line may show a finding."""

_PROMPT_WINDUP_S = 2.0


@refusing_none(SignalError)
def detect(
    signals: "Signals",
    campaign: "Campaign",
    vessel: "Vessel",
    *,
    governor: Mapping[str, float] | None = None,
    false_alarm: float = FALSE_ALARM,
) -> Nonlinearities:
    """Say which nonlinearities a recording shows beyond the quadratic propeller.

    The governor is replayed on the measured speed, where the propeller's law cannot pass for a finding; every
    nonlinearity is one more term of that replay, and joins it where the likelihood ratio says so.

    Parameters
    ----------
    signals, campaign, vessel
        The prepared recording at a multiple of 100 Hz, what was asked, and the installation: inertia upstream of the
        gauge and full-load curve are taken from it.
    governor
        Start values ``K_p``, ``K_i``, ``t_d``, ``omega_n``, ``zeta``, ``t_sp`` where something is known of it.
    false_alarm
        Probability with which a linear line may show anything.

    Raises
    ------
    SignalError
        If the signals have another rate or hold no test of the campaign.
    """
    record = make_record(signals, campaign, vessel)
    start = None if governor is None else {name: governor[name] for name in GOVERNOR}
    outcome = _with_windup(search(record, fit_governor(record, start), false_alarm=false_alarm), false_alarm)
    found = with_systematic(outcome.record, outcome.fit, signals, vessel)
    outcome = replace(outcome, fit=found)
    limits = limit_evidence(outcome.record, found, signals)
    findings = tuple(finding_of(one, outcome, limits) for one in outcome.present) or (nothing_found(outcome),)
    return Nonlinearities(
        findings=findings,
        sentence=sentence_of(findings),
        suspicions=tuple(Suspicion(kind=kind, statistic=value, p_value=p) for kind, value, p in outcome.absent),
        false_alarm=false_alarm,
        governor={name: found.values[name] for name in GOVERNOR},
        governor_std={name: found.std(name) for name in GOVERNOR},
        harmonics=harmonic_evidence(record, found, signals, campaign.sines),
        levels=level_evidence(record, outcome.linear, campaign),
        steps=step_evidence(record, found, campaign),
        limits=limits,
    )


def _with_windup(outcome: Outcome, false_alarm: float) -> Outcome:
    """Add governor windup where the integrator is emptied slower than within two seconds."""
    if outcome.fit.values["windup_s"] <= _PROMPT_WINDUP_S or "windup_s" not in outcome.fit.free:
        return outcome
    statistic = windup_statistic(outcome.record, outcome.fit, _PROMPT_WINDUP_S)
    p_value = chi_square_tail(statistic, 1)
    if p_value >= false_alarm:
        return outcome
    windup = Present(kind="governor windup", terms=("windup_s",), statistic=statistic, p_value=p_value)
    return replace(outcome, present=(*outcome.present, windup))
