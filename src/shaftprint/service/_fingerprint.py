"""The fingerprint of a line from its service: in the layout of a test's, with ``ordinary service`` as its test.

Its working point has the speed of the vessel file and the mean load of the service. Numbers are those of the closed
loop for small signals, GAUGE-CLOSED; what they rest on, and no log shows, is said in the verdict.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

import shaftprint
from shaftprint.arrays import FloatArray
from shaftprint.catalogue._gauge import K_Q, TAU_UP
from shaftprint.catalogue._roles import ShipRole
from shaftprint.catalogue._shipped import shipped_structure
from shaftprint.choices import CLOSED_LOOPS, SAILING_LOOP
from shaftprint.digits import stated
from shaftprint.errors import ServiceError
from shaftprint.fingerprint._conditions import Conditions, conditions_stated
from shaftprint.fingerprint._fingerprint import Fingerprint, Quality
from shaftprint.fingerprint._sources import source_of
from shaftprint.fingerprint._vessel_fields import TVC, vessel_fields
from shaftprint.identify.fit._estimate import Estimate
from shaftprint.identify.judgement._verdict import Verdict, trusted_in_words
from shaftprint.identify.likelihood._prior import PRIOR_OF, Prior
from shaftprint.identify.uncertainty._budget import Budget
from shaftprint.models._nyquist import is_stable
from shaftprint.service._fit import ServiceFit
from shaftprint.service._model import OVER_TORQUE, ServiceModel
from shaftprint.service._segment import LeverLine, Segment
from shaftprint.service._ship_numbers import (
    GAUGE_SCALE,
    GAUGE_ZERO,
    SERVICE,
    budget_row,
    combination_numbers,
    joint_of,
    margin_numbers_of,
    parameter_numbers,
    physical_numbers_of,
    quantity_of,
)
from shaftprint.signals._load_reasons import FAR
from shaftprint.units import SECONDS_PER_MINUTE

if TYPE_CHECKING:
    from shaftprint.campaign._trial_conditions import TrialConditions
    from shaftprint.vessel._vessel import Vessel

ORDINARY_SERVICE = "ordinary service"
"""What stands in a fingerprint in place of the name of a test."""
STRUCTURE, STRUCTURE_UNDERWAY = CLOSED_LOOPS["engine"], SAILING_LOOP
# A number is known well enough to this share of it; a set-point scale or a slope near nothing to this much.
_WELL_ENOUGH, _WELL_ENOUGH_NEAR_NOTHING = 0.15, 0.1
# From so many standard deviations on what the vessel file expects is worth a word.
_STRANGE = 2.5
_ASSUMED = (
    "Nobody trims the lever against the load at the moments at which he moves it anyway: no log shows that.",
    "The set point that was logged is what the control unit follows, with no rate limit of its own.",
    "The delay of the governor is one at all speeds: few hours hardly show one that counts in turns of the engine.",
)
_AT_THE_QUAY = "The ship lies at the quay or makes little way, and its propeller takes the square of the speed."
_UNDERWAY = (
    "The ship makes way ahead through calm, deep water all the time, its shafts follow one lever, and coefficients of "
    "thrust and torque fall in a line with the advance ratio."
)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Load:
    """What the propeller takes at the speed of the working point over its torque there, mean of the service."""

    value: float
    """The load."""
    std: float
    """Its standard deviation by what differs from segment to segment."""
    slope: FloatArray
    """Its change for one unit of each free parameter, shape (free,)."""

    def deviation(self, covariance: FloatArray) -> float:
        """Return its standard deviation with the ``covariance`` of the free parameters, shape (free, free)."""
        return float(np.sqrt(self.std**2 + self.slope @ covariance @ self.slope))


def fingerprint_of_service(
    fit: ServiceFit,
    model: ServiceModel,
    vessel: "Vessel",
    *,
    line: LeverLine,
    segments: Sequence[Segment],
    of: int,
    load: "Load",
    tables: Sequence[Path],
    now: datetime,
    tested_at: datetime | None = None,
    trial: "TrialConditions | None" = None,
) -> Fingerprint:
    """Return the fingerprint of a line from its service.

    ``fit``, ``model``: the fit, normalised at the working point of the vessel file, and its model. ``vessel``: the
    installation. ``line``: what the lever asks for. ``segments``, ``of``: the segments that were fitted, and how many
    moves there were. ``load``: mean load over that of the working point. ``tables``: the
    tables of segments. ``now``: time of making, with time zone. ``tested_at``: when the first log began, where that is
    known. ``trial``: draught and water, where somebody states them. Raises ServiceError if ``now`` has no time zone.
    """
    if now.tzinfo is None:
        raise ServiceError("now: expected a time with time zone, such as datetime.now(UTC), found one without.")
    in_water = vessel
    if trial is not None and trial.water_density_kg_m3 is not None:
        in_water = vessel.model_copy(update={"water_density_kg_m3": trial.water_density_kg_m3})
    free = model.free
    structure = shipped_structure(STRUCTURE_UNDERWAY if model.sails else STRUCTURE, set(free))
    scale = np.array([1.0 / load.value if name in OVER_TORQUE else 1.0 for name in free])
    theta = fit.theta * scale
    # what hangs on the torque of the point hangs on all that the load there hangs on
    over = theta * np.array([name in OVER_TORQUE for name in free])
    turn = np.diag(scale) - np.outer(over, load.slope / load.value)
    covariance = turn @ fit.covariance @ turn.T
    of_prior = _of_prior(fit, model, turn)
    held = {p.name: p.value for p in structure.parameters if p.name not in free} | {K_Q.name: 2.0}
    torque_nm = load.value * model.shaft_torque_nm
    parameters = parameter_numbers(structure, theta, free)
    combinations = combination_numbers(structure, theta, held, free)
    physical = physical_numbers_of(
        structure,
        theta,
        model,
        in_water,
        torque_nm=torque_nm,
        load_std=load.std / load.value,
        load_slope=load.slope / load.value,
        turn=turn,
    )
    margins = margin_numbers_of(structure, theta, held, free)
    numbers = [*parameters, *combinations, *physical, *margins]
    budget = Budget(
        sources=tuple(dict.fromkeys((SERVICE, *of_prior, GAUGE_SCALE, GAUGE_ZERO))),
        rows=tuple(budget_row(one, covariance, of_prior) for one in numbers),
    )
    groups = {"parameters": parameters, "combinations": combinations, "physical": physical, "margins": margins}
    quantities = {
        kind: tuple(quantity_of(one, covariance, of_prior) for one in group) for kind, group in groups.items()
    }
    stable = is_stable(structure, structure.vector(dict(zip(free, theta.tolist(), strict=True)) | held))
    every = [one for group in quantities.values() for one in group]
    seconds = sum(one.seconds for one in segments)
    return Fingerprint(
        shaftprint_version=shaftprint.__version__,
        created=now,
        sources=tuple(source_of("recording", table) for table in tables),
        conditions=_conditions(
            vessel,
            model,
            line,
            torque_nm=torque_nm,
            torque_std_nm=load.deviation(fit.covariance) * model.shaft_torque_nm,
            tested_at=tested_at,
            trial=trial,
        ),
        structure=structure.name,
        held=held,
        priors={
            name: Prior(model.known[name] * factor, std * factor)
            for name, std in model.prior_std.items()
            for factor in (float(scale[free.index(name)]),)
        },
        covariance=tuple(tuple(row) for row in covariance.tolist()),
        **quantities,
        joint=joint_of(physical, parameters, covariance, of_prior),
        budget=budget,
        vessel_fields=vessel_fields(vessel),
        calibration=(),
        quality=_quality(fit),
        verdict=_verdict(
            every,
            used=len(segments),
            of=of,
            seconds=seconds,
            stable=stable,
            misfit=fit.misfit.reason,
            sails=model.sails,
        ),
        findings=_findings(fit, segments, of, line),
    )


def _of_prior(fit: ServiceFit, model: ServiceModel, turn: FloatArray) -> dict[str, FloatArray]:
    """Return what the numbers change for one deviation of what was known beforehand, by the source of its error.

    ``turn``: from changes at the working point of the vessel file to those at the load of the service, (free, free).

    The inertia ahead of the gauge is the vessel file's, by the name that it has in tests: in a history of tests and
    days its error is one. Over the torque of the point it hangs on the gauge too, which a stated inertia does not.
    """
    changes: dict[str, FloatArray] = {}
    for name, change in fit.of_prior.items():
        if name == TAU_UP.name:
            changes[TVC] = turn @ change * np.sqrt(1.0 - model.gauge_share**2)
            changes[GAUGE_SCALE] = -(turn @ change) * model.gauge_share
        else:
            changes[PRIOR_OF + name] = turn @ change
    return changes


def _conditions(
    vessel: "Vessel",
    model: ServiceModel,
    line: LeverLine,
    *,
    torque_nm: float,
    torque_std_nm: float,
    tested_at: datetime | None,
    trial: "TrialConditions | None",
) -> Conditions:
    at_v = line.middle_v + (model.engine_speed_rev_s - line.middle_rev_s) / line.slope_rev_s_per_v
    return Conditions(
        **conditions_stated(vessel, ORDINARY_SERVICE, None, trial, tested_at),
        engine_speed=Estimate(
            name="n_0",
            unit="rpm",
            value=model.engine_speed_rev_s * SECONDS_PER_MINUTE,
            std=0.0,
            meaning=f"{vessel.machine.word} speed of the working point",
            role=ShipRole.SPEED,
        ),
        shaft_torque=Estimate(
            name="M_s0",
            unit="N m",
            value=torque_nm,
            std=torque_std_nm,
            meaning="shaft torque of the working point, by the mean load of the service",
            role=ShipRole.TORQUE,
        ),
        set_point_v=at_v,
        speed_channel=vessel.sensors.speed[0].name,
        mode="shaftprint",
        lines_used=(),
        lines_left_out={},
    )


def _quality(fit: ServiceFit) -> Quality:
    count = sum(one.count for one in fit.scores)
    met = int(np.count_nonzero(~fit.counts))
    remark = f"In {met} of {fit.counts.size} segments a limit of the torque acted; they are left out."
    return Quality(
        weighting="segments of service",
        fit_percent={},
        fit_ceiling={},
        chi_square=None,
        p_value=None,
        degrees_of_freedom=count - fit.theta.size,
        starts=1,
        starts_at_optimum=1,
        snr_overall={},
        snr_local_db={},
        repairs={},
        remarks=(remark,) if met else (),
    )


def _verdict(
    numbers: Sequence[Estimate], *, used: int, of: int, seconds: float, stable: bool, misfit: str, sails: bool
) -> Verdict:
    assumptions = (*_ASSUMED, _UNDERWAY if sails else _AT_THE_QUAY)
    doubts, cautions = {}, []
    for one in numbers:
        share = one.std / abs(one.value) if one.value else np.inf
        if share > _WELL_ENOUGH and one.std > _WELL_ENOUGH_NEAR_NOTHING * (one.unit == "-" and abs(one.value) < 1.0):
            doubts[one.name] = f"known to {100.0 * share:.0f} % only" if np.isfinite(share) else "not known"
        far = (one.deviations_from_expected or 0.0) if one.expected_std else 0.0
        if far > _STRANGE:
            cautions.append(
                f"{one.name} is {stated(one.value, one.std, one.unit)} where the vessel file has "
                f"{stated(one.expected or 0.0, one.expected_std or 0.0, one.unit)}, {far:.1f} standard deviations "
                "away: check the gear ratio, the scale of the torque gauge and the propeller."
            )
        if far > FAR:
            doubts[one.name] = f"{far:.1f} standard deviations from the vessel file"
    trusted = tuple(one.name for one in numbers if one.name not in doubts)
    of_line = any(one.name in trusted and one.role is not None and one.role.is_of_line for one in numbers)
    usable = of_line and stable and not misfit
    words = f"{used} segments of {seconds:.0f} s around {of} moves of the lever in ordinary service"
    if not stable:
        reason = f"The loop that explains {words} is not stable, as a line in service is."
    elif misfit:
        reason = (
            f"The model is not this line: {misfit} ({words}). Make a test (shaftprint plan), whose lines tell which "
            "structure holds."
        )
    elif not of_line:
        reason = f"No number of the line is known well enough by {words}; give more logs."
    else:
        reason = f"Numbers from {words} can be used within their intervals."
    return Verdict(
        trustworthy=usable,
        reason=reason,
        sentences=(
            reason,
            *(trusted_in_words(trusted, doubts) if usable else ()),
            *cautions,
            *(f"Assumed: {assumption}" for assumption in assumptions),
        ),
        trusted=trusted if usable else (),
        not_trusted=doubts if usable else {one.name: "no number may be used" for one in numbers},
        loop=None,
        assumptions=assumptions,
    )


def _findings(fit: ServiceFit, segments: Sequence[Segment], of: int, line: LeverLine) -> tuple[str, ...]:
    return (
        f"From ordinary service: {len(segments)} of {of} moves of the lever were used, no test was made.",
        f"Where the lever stands still, the speed is within {line.spread_rpm:.2g} rpm of its line "
        f"({line.stretches} stretches).",
        f"The scatter of the segments tells the deviations with {np.min(fit.freedom):.0f} degrees of freedom and more; "
        "intervals are as much wider.",
        f"What is left of speed and torque follows the lever {fit.misfit.speed:.1f} and {fit.misfit.torque:.1f} times "
        "as much as noise does.",
        f"The fit took {fit.steps} steps; the last was {fit.last_step:.1g} standard deviations long.",
    )
