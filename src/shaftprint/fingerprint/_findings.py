"""What a reader of a fingerprint must know, in words."""

from collections.abc import Collection, Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.catalogue._roles import ShipRole
from shaftprint.digits import after_number, p_value_text, plain_letters, stated
from shaftprint.fingerprint._physical import GAUGE_ZERO
from shaftprint.fingerprint._working_point_share import LOAD_WANDER
from shaftprint.identify.fit._estimate import Estimate
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.judgement._number_precision import doubts_of
from shaftprint.identify.likelihood._prior import PRIOR_OF
from shaftprint.identify.uncertainty._budget import Budget
from shaftprint.identify.uncertainty._profile import Profile
from shaftprint.reasons import Reason
from shaftprint.units import PERCENT

if TYPE_CHECKING:
    from shaftprint.vessel._vessel import Vessel

# A combination is named when it is determined this much better, relative to its size, than a parameter in it.
BETTER_KNOWN = 0.4
# A misfit that chance alone makes in fewer than this share of the tests is none of chance.
UNLIKELY = 0.01
# A search that fewer of its starts agree on than this share may have missed the optimum.
FEW_STARTS = 0.1
# So many standard deviations from what was expected are worth a sentence.
SURPRISING = 2.5
# So many standard deviations of the gauge's zero from none are.
OFF_ZERO = 2.0
# A number rests on priors when more than this share of its variance is from there.
MOSTLY = 0.5
# So many of them are named in a sentence.
MOST_NAMED = 4
# What the test itself measures: sources whose names begin so.
MEASURED = ("noise of ", "working-point ", LOAD_WANDER)
_NONE: Mapping[str, Estimate] = MappingProxyType({})
AMPLE, SMALL = 2.0, 1.3
GAIN_MARGIN = "gain margin"
WHY = {
    "I": " A torque gauge shows only the inertia downstream of it: compare with that, or fit a gauge-aware structure.",
    "K_Q": " The propeller, its inflow or the torque gauge has changed.",
}


def findings_of(
    identification: Identification,
    physical: tuple[Estimate, ...],
    uncertainty: Budget,
    left_out: dict[str, str],
    profile: Profile | None = None,
    *,
    numbers: Mapping[str, Estimate] = _NONE,
    not_trusted: Collection[str] = (),
    vessel: "Vessel | None" = None,
    reasons: Sequence[Reason] = (),
) -> tuple[str, ...]:
    """Return the findings of one identification, most important first.

    What is poorly determined is decided by the rule of the verdict, with the same profile likelihood; it is written as
    ``numbers`` have it, those of the fingerprint by name. ``not_trusted``: names of the verdict. With a vessel
    whose file states the torque coefficient of both directions, one that is that of the other is said to be. What
    reasons explain by a scale of the files is no fault of the ship.
    """
    return (
        *_stability(identification, not_trusted),
        *_misfit(identification),
        *_bounds(identification),
        *_search(identification),
        *_poorly_determined(identification, profile, numbers),
        *_resting_on_priors(identification, uncertainty),
        *_gauge_zero(physical),
        *_against_expected(physical, vessel, by_scale=bool(reasons)),
        *(f"Line {name} is left out: {reason}." for name, reason in left_out.items()),
    )


def _stability(identification: Identification, not_trusted: Collection[str]) -> list[str]:
    margin = identification.margins
    if margin is None:
        return []
    if not margin.stable:
        return [f"The identified line is unstable: {margin.unstable_poles} poles in the right half plane."]
    if not np.isfinite(margin.gain_margin):
        return ["The governed line is stable, and no gain of the governor makes it hunt."]
    reserve = max(margin.gain_margin, 1.0 / margin.gain_margin)
    words = "ample" if reserve >= AMPLE else "small" if reserve >= SMALL else "very small"
    known = f"is {words}" if GAIN_MARGIN not in not_trusted else "is not known well enough to call it small or ample"
    return [
        f"The governed line is stable; its gain margin of {margin.gain_margin:.2f} at "
        f"{margin.gain_margin_rad_s:.1f} rad/s {known}."
    ]


def _misfit(identification: Identification) -> list[str]:
    chance = identification.p_value
    if chance is None or chance >= UNLIKELY:
        return []
    return [
        "The structure does not explain the data within their noise: chi-square is "
        f"{identification.chi_square:.0f} for {identification.degrees_of_freedom} degrees of freedom (p = "
        f"{plain_letters(p_value_text(chance))}); the standard deviations are too small for it."
    ]


def _bounds(identification: Identification) -> list[str]:
    return [
        f"{e.name} stopped at its bound {e.value:g} {e.unit}: use its 95 % interval, a standard "
        "deviation means little there; the test does not determine it, or the structure does not fit."
        for e in identification.parameters
        if e.at_bound
    ]


def _search(identification: Identification) -> list[str]:
    starts, reached = identification.settings.starts, identification.reached
    if reached > FEW_STARTS * starts:
        return []
    return [f"Only {reached} of {starts} starts reached the optimum: use more starts."]


def _poorly_determined(
    identification: Identification, profile: Profile | None, numbers: Mapping[str, Estimate]
) -> list[str]:
    """Return the parameters that the verdict does not trust, with the combinations that are determined better."""
    doubts = doubts_of(identification, identification.parameters, profile)
    findings = []
    for estimate in identification.parameters:
        if estimate.name not in doubts or estimate.name in identification.settings.priors or estimate.at_bound:
            continue
        text = f"{estimate.name} = {numbers.get(estimate.name, estimate).in_words} is poorly determined by this test"
        better = [c for c in identification.combinations if _is_better(c, estimate, identification)]
        precise = ", ".join(f"{c.name} = {numbers.get(c.name, c).in_words}" for c in better)
        findings.append(text + (f"; better determined: {precise}." if better else "."))
    return findings


def _is_better(combination: Estimate, estimate: Estimate, identification: Identification) -> bool:
    if not np.isfinite(combination.value):  # K_p / K_i of a governor without integral action
        return False
    of = next(c.of for c in identification.structure.combinations if c.name == combination.name)
    values = identification.objective.named(identification.values)
    index = identification.objective.names.index(estimate.name)
    moved = identification.values.copy()
    moved[index] += max(1e-3, 1e-3 * abs(moved[index]))
    if of(identification.objective.named(moved)) == of(values):
        return False
    share = combination.std / max(abs(combination.value), 1e-300)
    return share < BETTER_KNOWN * estimate.std / max(abs(estimate.value), 1e-300)


def _resting_on_priors(identification: Identification, budget: Budget) -> list[str]:
    """Return which numbers more or better lines would hardly improve, by the assumption that most of them rest on."""
    assumed = [name for name in budget.sources if not name.startswith(MEASURED) and name not in _common(identification)]
    resting: dict[str, dict[str, float]] = {}
    for row in budget.rows:
        shares = {source: row.shares.get(source, 0.0) for source in assumed}
        if row.name not in identification.settings.priors and sum(shares.values()) > MOSTLY:
            largest = max(shares, key=lambda source: shares[source])
            resting.setdefault(largest, {})[row.name] = shares[largest]
    return [
        f"More than half of the variance of {_numbers_resting(shares)} is not from the noise of this test but from "
        f"what is assumed, most of it {_assumption(source, identification)}."
        for source, shares in sorted(resting.items(), key=lambda item: -len(item[1]))
    ]


def _numbers_resting(shares: dict[str, float]) -> str:
    """Return a few numbers with their shares; many are counted, the budget has them all."""
    largest = sorted(shares, key=lambda name: -shares[name])
    named = ", ".join(f"{name} ({PERCENT * shares[name]:.0f} %)" for name in largest[:MOST_NAMED])
    return named if len(shares) <= MOST_NAMED else f"{len(shares)} numbers, the largest parts {named},"


def _assumption(source: str, identification: Identification) -> str:
    """Return a source of the budget, that of a prior with its numbers."""
    name = source.removeprefix(PRIOR_OF)
    prior = identification.settings.priors.get(name)
    if prior is None or not source.startswith(PRIOR_OF):
        return source
    units = {parameter.name: parameter.unit for parameter in identification.structure.parameters}
    return f"the prior {name} = {stated(prior.mean, prior.std, units[name])}"


def _common(identification: Identification) -> set[str]:
    return {name for part in identification.experiments for name in part.response.common}


def _gauge_zero(physical: tuple[Estimate, ...]) -> list[str]:
    return [
        f"{q.name} = {stated(q.value, q.std, q.unit)}: the torque gauge has a zero offset, there is constant friction, "
        "or the inflow is not zero."
        for q in physical
        if q.name == GAUGE_ZERO and abs(q.value) > OFF_ZERO * q.std
    ]


def _against_expected(physical: tuple[Estimate, ...], vessel: "Vessel | None", *, by_scale: bool) -> list[str]:
    findings = []
    for quantity in physical:
        # the zero of the gauge, expected at zero, has its own sentence
        if not quantity.expected:
            continue
        spread = np.hypot(quantity.std, quantity.expected_std or 0.0)
        if abs(quantity.value - quantity.expected) > SURPRISING * spread:
            unit = after_number(quantity.unit)
            why = "" if by_scale else _other_direction(quantity, vessel) or WHY.get(quantity.name, "")
            findings.append(
                f"{quantity.name} = {quantity.value:.4g}{unit} against {quantity.expected:.4g}{unit} of the vessel "
                f"file{_factor(quantity.value / quantity.expected)}.{why}"
            )
    return findings


def _factor(ratio: float) -> str:
    """Return by which factor two numbers differ; nothing where one is zero, as at a bound, or of the other sign."""
    return f": a factor {max(ratio, 1.0 / ratio):.2f}" if ratio > 0.0 else ""


def _other_direction(quantity: Estimate, vessel: "Vessel | None") -> str:
    """Return that the torque coefficient is the one of the other direction, where it is; empty where not."""
    if vessel is None or quantity.role != ShipRole.TORQUE:
        return ""
    propeller, found_astern = vessel.propeller, not vessel.working_point.is_astern
    other = propeller.astern_torque_coefficient if found_astern else propeller.torque_coefficient
    other_std = propeller.astern_torque_coefficient_std if found_astern else propeller.torque_coefficient_std
    if other is None or abs(quantity.value - other) > SURPRISING * float(np.hypot(quantity.std, other_std or 0.0)):
        return ""
    way = "astern" if found_astern else "ahead"
    return f" Of a shaft that turns {way} it states {other:.4g}: check direction of its working point."
