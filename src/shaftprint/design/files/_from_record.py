"""What stands in ``plan.json`` as a planned test; what is predicted is computed again from its legs."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import frozen_float
from shaftprint.design.inputs._assumed_ship import AssumedShip
from shaftprint.design.inputs._set_point_line import SetPointLine
from shaftprint.design.inputs._wish import Wish
from shaftprint.design.plan._band import Band
from shaftprint.design.plan._leg import Leg
from shaftprint.design.plan._plan import Plan, predicted_accuracy
from shaftprint.design.planned_test._planned_test import PlannedTest, SailedLeg
from shaftprint.design.planned_test._rehearsal import Rehearsal
from shaftprint.design.planned_test._remedies import Remedy
from shaftprint.errors import DesignError
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.identify.prediction._noise_levels import NoiseLevels
from shaftprint.models._structure import Structure
from shaftprint.models._working_point import at_working_point
from shaftprint.spectra._frequency_response import FrequencyResponse

if TYPE_CHECKING:
    from shaftprint.design.files._records import (
        NoiseRecord,
        PlannedLegRecord,
        PlanRecord,
        RehearsalRecord,
        SailedRecord,
        ShipRecord,
    )


def planned_test_of(record: "PlanRecord", structure: Structure) -> PlannedTest:
    """Return the planned test of a record.

    Parameters
    ----------
    record
        What stands in the file.
    structure
        The structure of its name, free where the plan has it free.

    Raises
    ------
    ShaftprintError
        If the numbers of the file do not make a plan.
    """
    sailed = tuple(map(_sailed, record.sailed))
    return PlannedTest(
        name=record.name,
        vessel=record.vessel,
        plan=_plan(record, structure, sailed),
        line=SetPointLine(slope_rpm_per_v=record.slope_rpm_per_v, offset_v=record.offset_v),
        created=record.created,
        noise_source=record.noise_source,
        version=record.shaftprint_version,
        rehearsal=None if record.rehearsal is None else _rehearsal(record.rehearsal),
        remarks=record.remarks,
        remedies=tuple(Remedy(name=one.name, worst=one.worst, ratios=one.ratios) for one in record.remedies),
        sailed=sailed,
    )


def _plan(record: "PlanRecord", structure: Structure, sailed: tuple[SailedLeg, ...]) -> Plan:
    ship = _ship(record.ship, structure)
    legs = tuple(map(_leg, record.legs))
    noise = tuple(_noise(leg.noise) for leg in record.legs)
    structures = tuple(at_working_point(structure, speed_share=leg.speed_share) for leg in legs)
    priors = {name: Prior(mean, std) for name, (mean, std) in record.priors.items()}
    earlier = tuple(
        (at_working_point(structure, speed_share=one.speed_share, torque_share=one.torque_share), one.response)
        for one in sailed
    )
    return Plan(
        ship=ship,
        wish=Wish(relative=record.wish_relative, absolute=record.wish_absolute),
        limits=record.limits,
        priors=priors,
        timetable=record.timetable,
        noise=noise,
        structures=structures,
        legs=legs,
        stairs_rpm=record.stairs_rpm,
        band=None
        if record.band is None
        else Band(deviations=record.band.deviations, middle=record.band.middle, seconds=record.band.seconds),
        peaks=tuple(leg.peaks for leg in record.legs),
        earlier=earlier,
        predicted=predicted_accuracy(structures, legs, noise, values=ship.by_name, priors=priors, earlier=earlier),
    )


def _ship(record: "ShipRecord", structure: Structure) -> AssumedShip:
    values = structure.vector(record.values)
    size = len(structure.names)
    if tuple(record.values) != structure.names or [len(row) for row in record.covariance] != [size] * size:
        raise DesignError(
            f"ship: expected values and covariance of {', '.join(structure.names)}, found "
            f"{', '.join(record.values) or 'none'}."
        )
    return AssumedShip(structure=structure, values=frozen_float(values), covariance=frozen_float(record.covariance))


def _leg(record: "PlannedLegRecord") -> Leg:
    count = len(record.harmonics)
    ascending = all(later > earlier for earlier, later in zip(record.harmonics, record.harmonics[1:], strict=False))
    if not (count and record.harmonics[0] > 0 and ascending) or [len(row) for row in record.amplitudes] != [count] * 2:
        raise DesignError(
            "leg: expected ascending harmonics and two rows of as many amplitudes, found "
            f"{count} harmonics and rows of {', '.join(str(len(row)) for row in record.amplitudes) or 'nothing'}."
        )
    if not min(record.speed_share, record.level_rpm, record.period_s) > 0.0 or record.settle_s < 0.0:
        raise DesignError("leg: expected positive speed_share, level_rpm and period_s, found others.")
    real, imaginary = np.array(record.amplitudes, dtype=np.float64)
    return Leg(
        speed_share=record.speed_share,
        level_rpm=record.level_rpm,
        period_s=record.period_s,
        harmonics=record.harmonics,
        amplitudes=real + 1j * imaginary,
        periods=record.periods,
        settle_s=record.settle_s,
    )


def _noise(record: "NoiseRecord") -> NoiseLevels:
    return NoiseLevels(
        frequency_hz=frozen_float(record.frequency_hz),
        density=np.array(record.density) + 1j * np.array(record.density_im),
        outputs=record.outputs,
        set_point_per_v=record.set_point_per_v,
    )


def _rehearsal(record: "RehearsalRecord") -> Rehearsal:
    count = len(record.names)
    rows = (*record.errors, *record.stated, record.planned)
    if any(len(row) != count for row in rows) or not len(record.errors) == len(record.stated) == len(record.limited):
        raise DesignError(f"rehearsal: expected rows of {count} numbers, as many as names, found others.")
    return Rehearsal(
        names=record.names,
        errors=frozen_float(record.errors),
        stated=frozen_float(record.stated),
        planned=frozen_float(record.planned),
        limited=frozen_float(record.limited),
        failures=record.failures,
    )


def _sailed(record: "SailedRecord") -> SailedLeg:
    values = np.array(record.response) + 1j * np.array(record.response_im)
    response = FrequencyResponse(
        frequency_hz=frozen_float(record.frequency_hz),
        response=values.reshape(len(record.outputs), len(record.inputs), -1),
        covariance=frozen_float(record.covariance),
        inputs=record.inputs,
        outputs=record.outputs,
        lines=record.lines,
        degrees_of_freedom=frozen_float(record.degrees_of_freedom),
        used=np.array(record.used, dtype=np.bool_),
        averaging_s=record.averaging_s,
        hold_s=record.hold_s,
        pick_up_delay_s=record.pick_up_delay_s,
    )
    return SailedLeg(
        name=record.name, speed_share=record.speed_share, torque_share=record.torque_share, response=response
    )
