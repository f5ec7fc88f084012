"""Findings in words with numbers, and the sentence over all of them."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.nonlinearity._nonlinearities import Estimate, Finding
from shaftprint.units import rpm_from_rev_s

if TYPE_CHECKING:
    from collections.abc import Sequence

    from shaftprint.nonlinearity._limit_evidence import LimitEvidence
    from shaftprint.nonlinearity._search import Outcome, Present

_KNOWN_SHARE = 0.5


def finding_of(one: "Present", outcome: "Outcome", limits: "LimitEvidence") -> Finding:
    """Return a finding with its estimates and what speaks for it."""
    match one.kind:
        case "torque limit":
            estimates, evidence = _torque_limit(outcome, limits)
        case "motoring limit":
            estimates, evidence = _motoring_limit(outcome, limits)
        case "rate limit of the fuel rack":
            estimates, evidence = _rack_rate(outcome)
        case "rate limit of the set point":
            estimates, evidence = _set_point_rate(outcome)
        case "deadband":
            estimates, evidence = _deadband(outcome)
        case "quantised set point":
            estimates, evidence = _quantised(outcome)
        case "turbocharger lag":
            estimates, evidence = _turbocharger(outcome)
        case _:
            estimates, evidence = _windup(outcome)
    chance = "below 1e-12" if one.p_value < 1e-12 else f"{one.p_value:.1e}"
    return Finding(
        kind=one.kind,
        evidence=f"{evidence} Likelihood-ratio statistic {one.statistic:.0f}, by chance {chance}.",
        estimates=estimates,
        statistic=one.statistic,
        p_value=one.p_value,
    )


def nothing_found(outcome: "Outcome") -> Finding:
    """Return the finding of a line in which the propeller alone is nonlinear."""
    strongest = max(outcome.absent, key=lambda one: one[1])
    return Finding(
        kind="quadratic propeller only",
        evidence=(
            "A linear governor replayed on the measured speed gives the torque of the engine at all levels; the "
            f"strongest of {len(outcome.absent)} suspicions, {strongest[0]}, has the statistic {strongest[1]:.1f} "
            f"(by chance {strongest[2]:.2g})."
        ),
        statistic=0.0,
        p_value=1.0,
    )


def sentence_of(findings: "Sequence[Finding]") -> str:
    """Return all findings in a sentence."""
    if findings[0].kind == "quadratic propeller only":
        return "The line is linear but for its propeller: no limit, deadband or asymmetry stands out of the noise."
    named = [_named(finding) for finding in findings]
    listed = named[0] if len(named) == 1 else f"{', '.join(named[:-1])} and {named[-1]}"
    return f"Beyond the quadratic propeller this line shows {listed}: a linear model does not hold where they act."


def _named(finding: Finding) -> str:
    article = "an" if finding.kind[0] in "aeiou" else "a"
    if not finding.estimates:
        return f"{article} {finding.kind}"
    first = finding.estimates[0]
    unit = "" if first.unit == "-" else f" {first.unit}"
    return f"{article} {finding.kind} ({first.name} = {first.value:.3g} ± {first.std:.1g}{unit})"


def _torque_limit(outcome: "Outcome", limits: "LimitEvidence") -> tuple[tuple[Estimate, ...], str]:
    record, fit = outcome.record, outcome.fit
    factor, std = fit.values["limit"], fit.std("limit")
    full = float(np.interp(0.0, record.curve_speed, record.curve_torque))
    over_rated = record.brake_torque_nm / record.rated_torque_nm
    upper = limits.torque > 0.0
    estimates = (
        _estimate("m_max", factor * full, std * full, "-", "highest torque over M_b0 at the working speed"),
        _estimate("limit", factor, std, "-", "highest torque over the full-load curve of the vessel file"),
        _estimate("m_rated", factor * full * over_rated, std * full * over_rated, "-", "the same over rated torque"),
    )
    held = limits.duration_s[upper]
    speed = rpm_from_rev_s(record.engine_speed_rev_s * (1.0 + limits.speed[upper]))
    level = f"{factor:.3f} ± {std:.3f} of the full-load curve"
    if not held.size:
        return estimates, (
            f"What the governor asks for is cut off at {level}, too shortly for the torque of the engine to stay "
            "there; how the speed comes back shows it."
        )
    return estimates, (
        f"In {_stretches(held)} between {speed.min():.0f} and {speed.max():.0f} rpm the torque of the engine stays on "
        f"a level while the governor asks for more: {level}."
    )


def _motoring_limit(outcome: "Outcome", limits: "LimitEvidence") -> tuple[tuple[Estimate, ...], str]:
    estimate = _own("m_min", outcome, "m_min", "-", "torque of the motored engine over M_b0, as a positive number")
    held = limits.duration_s[limits.torque <= 0.0]
    level = f"{estimate.value:.2f} ± {estimate.std:.2f} M_b0 below zero"
    if not held.size:
        return (estimate,), (
            f"What the governor takes away is cut off at {level}, too shortly for the torque of the engine to stay "
            "there; how the speed comes back shows it."
        )
    return (estimate,), (
        f"In {_stretches(held)} the torque falls no further than {level}: no fuel is left to take away."
    )


def _stretches(held: FloatArray) -> str:
    many = f"{held.size} stretches of together" if held.size > 1 else "one stretch of"
    return f"{many} {held.sum():.2f} s"


def _rack_rate(outcome: "Outcome") -> tuple[tuple[Estimate, ...], str]:
    slope = outcome.record.rack_slope
    estimate = _own("r_x", outcome, "r_x", "1/s", "fastest change of the rack over X_0", scale=1.0 / slope)
    return (estimate,), (
        f"However large the step, the fuel rack changes by no more than {estimate.value:.3g} ± {estimate.std:.2g} of "
        "its working point a second."
    )


def _set_point_rate(outcome: "Outcome") -> tuple[tuple[Estimate, ...], str]:
    rpm = rpm_from_rev_s(outcome.record.engine_speed_rev_s)
    estimate = _own("r_s", outcome, "r_s", "1/s", "fastest change of the set point over n_0")
    in_rpm = _own("r_s_rpm", outcome, "r_s", "rpm/s", "the same in engine speed", scale=rpm)
    return (estimate, in_rpm), (
        f"The governor follows a set point that changes by no more than {in_rpm.value:.0f} ± {in_rpm.std:.0f} rpm/s, "
        "though the one that was asked for jumps."
    )


def _deadband(outcome: "Outcome") -> tuple[tuple[Estimate, ...], str]:
    rpm = rpm_from_rev_s(outcome.record.engine_speed_rev_s)
    estimate = _own("d_e", outcome, "d_e", "-", "speed error over n_0 within which nothing happens, half of the band")
    in_rpm = _own("d_e_rpm", outcome, "d_e", "rpm", "the same in engine speed", scale=rpm)
    return (estimate, in_rpm), (
        f"The torque does not answer speed errors within {in_rpm.value:.1f} ± {in_rpm.std:.1g} rpm of zero: small "
        "tests see less gain than large ones."
    )


def _quantised(outcome: "Outcome") -> tuple[tuple[Estimate, ...], str]:
    rpm = rpm_from_rev_s(outcome.record.engine_speed_rev_s)
    found = outcome.quantisation
    if found is None:
        raise ValueError("a quantised set point without its step")
    estimates = (
        _estimate("q", found.step, found.step_std, "-", "step of the set point over n_0"),
        _estimate("q_rpm", found.step * rpm, found.step_std * rpm, "rpm", "the same in engine speed"),
    )
    return estimates, (
        f"The torque answers jumps wherever the set point passes a multiple of {found.step * rpm:.2f} rpm; they are "
        f"{found.share:.2f} of those of a set point rounded to it."
    )


def _turbocharger(outcome: "Outcome") -> tuple[tuple[Estimate, ...], str]:
    air = _own("air", outcome, "air", "-", "torque without boost over the full-load curve")
    lag = _own("tau_tc", outcome, "boost_s", "s", "time in which the boost follows the torque")
    return (air, lag), (
        f"Rising torque waits at {air.value:.2f} ± {air.std:.2f} of the full-load curve without boost, and then for "
        f"the boost, {lag.value:.2f} ± {lag.std:.2f} s; falling torque does not: slow up, fast down."
    )


def _windup(outcome: "Outcome") -> tuple[tuple[Estimate, ...], str]:
    estimate = _own("T_aw", outcome, "windup_s", "s", "time constant with which the integrator is emptied at a limit")
    known = estimate.std < _KNOWN_SHARE * estimate.value
    slow = f"in {estimate.value:.2g} ± {estimate.std:.2g} s" if known else "so slowly that the time cannot be told"
    return (
        estimate,
    ), f"The integrator goes on while a limit acts and is emptied {slow}: the speed overshoots for longer."


def _own(name: str, outcome: "Outcome", term: str, unit: str, meaning: str, *, scale: float = 1.0) -> Estimate:
    return _estimate(name, scale * outcome.fit.values[term], scale * outcome.fit.std(term), unit, meaning)


def _estimate(name: str, value: float, std: float, unit: str, meaning: str) -> Estimate:
    return Estimate(name=name, value=float(value), std=float(std), unit=unit, meaning=meaning)
