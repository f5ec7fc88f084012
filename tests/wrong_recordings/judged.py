"""What shaftprint answers to a wrong recording, and whether the answer is right."""

import re
from dataclasses import dataclass
from functools import cache
from typing import Literal

import numpy as np
from tests.wrong_recordings.case import Case
from tests.wrong_recordings.trial import Sailed, Trial, clean

from shaftprint.catalogue import structure
from shaftprint.distributions import NORMAL_95
from shaftprint.errors import ShaftprintError
from shaftprint.fingerprint import Fingerprint
from shaftprint.identify import Estimate, Settings
from shaftprint.models import Structure, margins
from shaftprint.survey import Measurement, priors_of, run
from shaftprint.survey import Trial as SurveyTrial

STARTS = 12
FIRST = 3
TOLERANCE, OF_SPEED = 0.02, 0.001
"""A number this near to the truth, as a share of it, is right whatever its interval says; the mean speed is sharper."""

Outcome = Literal[
    "refused", "refused, cause not named", "not trusted", "not trusted, cause not named", "right", "WRONG"
]


@dataclass(frozen=True, kw_only=True, slots=True)
class Answer:
    """What came of one case."""

    outcome: Outcome
    """In one word."""
    words: str
    """The error, the first reasons, or the assumption."""
    wrong: tuple[str, ...] = ()
    """Numbers that are wrong, trusted ones first with a star."""

    @property
    def passes(self) -> bool:
        """Whether the case is answered as it must be."""
        return self.outcome in ("refused", "not trusted", "right")


def fingerprint_of(trial: Trial) -> Fingerprint:
    """Return the fingerprint of a trial, as the program makes it."""
    return run(trial.recording, trial.vessel, trial.campaign, settings=_settings, judge=False).fingerprint


def _settings(structure: Structure, measurement: Measurement, trial: SurveyTrial) -> Settings:
    return Settings(starts=STARTS, priors=priors_of(structure, trial.vessel, measurement.signals))


@cache
def true_values(test: Sailed, shown_rpm: float | None = None) -> dict[str, float]:
    """Return the truth of the numbers that do not depend on the load of the day, at a working point of the test.

    Parameters
    ----------
    test
        The test.
    shown_rpm
        Speed of the working point as the fingerprint has it; that of the whole test where it is not given.
    """
    trial, truth = clean(test)
    speeds = test.speeds_rpm
    speed_rpm = speeds[0] if shown_rpm is None else min(speeds, key=lambda one: abs(one - shown_rpm))
    # along the propeller law gains and inertia times, normalised, go with speed over torque
    ratio = truth.engine_speed_rpm / speed_rpm
    normal = {
        name: value * (ratio if name in ("K_p", "K_i", "tau_dn", "tau_up", "g") else 1.0)
        for name, value in truth.normalised.items()
    }
    line = structure("GAUGE-CLOSED")
    margin = margins(line, line.vector({name: normal[name] for name in line.names if name in normal}))
    action = truth.shaft_torque_nm / truth.engine_speed_rpm
    return {
        "I_dn": truth.physical["inertia_downstream_kg_m2"],
        "I_up": truth.physical["inertia_upstream_kg_m2"],
        "K_Q": trial.vessel.propeller.torque_coefficient,
        "n_0": speed_rpm,
        "t_d + t_sp": normal["t_d"] + normal["t_sp"],
        "governor proportional action": truth.normalised["K_p"] * action,
        "governor integral action": truth.normalised["K_i"] * action,
        "K_p / K_i": normal["K_p"] / normal["K_i"],
        "gain margin": margin.gain_margin,
        "phase margin": float(np.degrees(abs(margin.phase_margin_rad))),
        "delay margin": margin.delay_margin_s,
    } | {name: normal[name] for name in ("g", "t_d", "t_sp", "omega_n", "zeta")}


def answer(case: Case) -> Answer:
    """Return what shaftprint answers to a case, and whether that is right."""
    trial, _ = clean(case.sailed)
    try:
        fingerprint = fingerprint_of(case.change(trial))
    except ShaftprintError as error:
        named = re.search(case.cause, str(error), re.IGNORECASE)
        return Answer(outcome="refused" if named else "refused, cause not named", words=str(error))
    return judged(fingerprint, case)


def judged(fingerprint: Fingerprint, case: Case) -> Answer:
    """Return whether wrong numbers are trusted, and whether the cause is among the first three reasons."""
    verdict = fingerprint.verdict
    values = true_values(case.sailed, fingerprint.conditions.engine_speed.value)
    truth = {name: value * case.truth.get(name, 1.0) for name, value in values.items()}
    numbers = {q.name: q for q in _numbers(fingerprint) if q.name in truth}
    wrong = [name for name, quantity in numbers.items() if not is_right(quantity, truth[name])]
    trusted = [name for name in wrong if verdict.trustworthy and name in verdict.trusted]
    reasons = " | ".join(reason.sentence for reason in verdict.reasons[:FIRST])
    told = _told(wrong, trusted, numbers)
    if not wrong:
        return Answer(outcome="right", words=reasons)
    named = re.search(case.cause, reasons, re.IGNORECASE)
    if named and not trusted:
        return Answer(outcome="not trusted", words=reasons, wrong=told)
    assumed = " | ".join(verdict.assumptions)
    if case.assumption and re.search(case.assumption, assumed, re.IGNORECASE):
        return Answer(outcome="right", words=f"assumption: {assumed}", wrong=told)
    return Answer(outcome="WRONG" if trusted else "not trusted, cause not named", words=reasons, wrong=told)


def is_right(quantity: Estimate, true: float) -> bool:
    """Return whether the truth lies in the 95 % interval of a number, or near it."""
    half = NORMAL_95 * quantity.std
    lower, upper = quantity.interval_95 or (quantity.value - half, quantity.value + half)
    near = (OF_SPEED if quantity.name == "n_0" else TOLERANCE) * abs(true)
    return bool(lower - near <= true <= upper + near)


def _numbers(fingerprint: Fingerprint) -> tuple[Estimate, ...]:
    where = fingerprint.conditions
    return (
        *fingerprint.parameters,
        *fingerprint.combinations,
        *fingerprint.physical,
        *fingerprint.margins,
        where.engine_speed,
    )


def _told(wrong: list[str], trusted: list[str], numbers: dict[str, Estimate]) -> tuple[str, ...]:
    order = sorted(wrong, key=lambda name: name not in trusted)
    return tuple(f"{name}{'*' * (name in trusted)} = {numbers[name].value:.4g}" for name in order)
