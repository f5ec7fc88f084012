"""A planned test as what stands in ``plan.json``."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.design.files._records import (
    BandRecord,
    NoiseRecord,
    PlannedLegRecord,
    PlanRecord,
    RehearsalRecord,
    RemedyRecord,
    SailedRecord,
    ShipRecord,
)

if TYPE_CHECKING:
    from shaftprint.design.plan._leg import Leg
    from shaftprint.design.plan._plan import Peaks, Plan
    from shaftprint.design.planned_test._planned_test import PlannedTest, SailedLeg
    from shaftprint.design.planned_test._rehearsal import Rehearsal
    from shaftprint.identify.prediction._noise_levels import NoiseLevels


def record_of(test: "PlannedTest") -> PlanRecord:
    """Return a planned test as the record that stands in its file."""
    plan = test.plan
    return PlanRecord(
        shaftprint_version=test.version,
        created=test.created,
        name=test.name,
        vessel=test.vessel,
        noise_source=test.noise_source,
        slope_rpm_per_v=test.line.slope_rpm_per_v,
        offset_v=test.line.offset_v,
        rehearsed=test.rehearsal is not None,
        duration_s=plan.duration_s,
        predicted=_predicted(plan),
        ship=ShipRecord(
            structure=plan.ship.structure.name,
            values=plan.ship.by_name,
            covariance=_rows(plan.ship.covariance),
            held=tuple(p.name for p in plan.ship.structure.parameters if p.held),
        ),
        wish_relative=dict(plan.wish.relative),
        wish_absolute=dict(plan.wish.absolute),
        limits=plan.limits,
        priors={name: (prior.mean, prior.std) for name, prior in plan.priors.items()},
        timetable=plan.timetable,
        stairs_rpm=plan.stairs_rpm,
        legs=tuple(_leg(*one) for one in zip(plan.legs, plan.noise, plan.peaks, strict=True)),
        band=None
        if plan.band is None
        else BandRecord(
            deviations=dict(plan.band.deviations), middle=dict(plan.band.middle), seconds=plan.band.seconds
        ),
        rehearsal=None if test.rehearsal is None else _rehearsal(test.rehearsal),
        remarks=test.remarks,
        remedies=tuple(RemedyRecord(name=one.name, worst=one.worst, ratios=dict(one.ratios)) for one in test.remedies),
        sailed=tuple(map(_sailed, test.sailed)),
    )


def _predicted(plan: "Plan") -> dict[str, dict[str, float | str | None]]:
    return {
        one.name: {"value": one.value, "std": one.std, "wished_std": plan.targets.get(one.name), "unit": one.unit}
        for one in plan.promised.values()
    }


def _leg(leg: "Leg", noise: "NoiseLevels", peaks: "Peaks") -> PlannedLegRecord:
    return PlannedLegRecord(
        speed_share=leg.speed_share,
        level_rpm=leg.level_rpm,
        period_s=leg.period_s,
        harmonics=leg.harmonics,
        amplitudes=_rows(np.stack([leg.amplitudes.real, leg.amplitudes.imag])),
        periods=leg.periods,
        settle_s=leg.settle_s,
        noise=NoiseRecord(
            frequency_hz=tuple(noise.frequency_hz.tolist()),
            density=_tables(noise.density.real),
            density_im=_tables(noise.density.imag),
            outputs=noise.outputs,
            set_point_per_v=noise.set_point_per_v,
        ),
        peaks=peaks,
    )


def _rehearsal(rehearsal: "Rehearsal") -> RehearsalRecord:
    return RehearsalRecord(
        names=rehearsal.names,
        errors=_rows(rehearsal.errors),
        stated=_rows(rehearsal.stated),
        planned=tuple(rehearsal.planned.tolist()),
        limited=tuple(rehearsal.limited.tolist()),
        failures=rehearsal.failures,
    )


def _sailed(leg: "SailedLeg") -> SailedRecord:
    response = leg.response
    values: ComplexArray = response.response.reshape(-1, len(response.lines))
    return SailedRecord(
        name=leg.name,
        speed_share=leg.speed_share,
        torque_share=leg.torque_share,
        lines=response.lines,
        used=tuple(response.used.tolist()),
        frequency_hz=tuple(response.frequency_hz.tolist()),
        response=_rows(values.real),
        response_im=_rows(values.imag),
        covariance=_tables(response.covariance),
        degrees_of_freedom=tuple(response.degrees_of_freedom.tolist()),
        inputs=response.inputs,
        outputs=response.outputs,
        averaging_s=response.averaging_s,
        hold_s=response.hold_s,
        pick_up_delay_s=response.pick_up_delay_s,
    )


def _rows(values: FloatArray) -> tuple[tuple[float, ...], ...]:
    return tuple(tuple(row) for row in values.tolist())


def _tables(values: FloatArray) -> tuple[tuple[tuple[float, ...], ...], ...]:
    return tuple(_rows(matrix) for matrix in values)
