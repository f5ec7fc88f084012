"""The verb of the room: from an identification to the record that is kept."""

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import datetime
from typing import TYPE_CHECKING

import numpy as np

import shaftprint
from shaftprint.arguments import refusing_none
from shaftprint.arrays import FloatArray
from shaftprint.catalogue._roles import ShipRole
from shaftprint.errors import FingerprintError
from shaftprint.fingerprint._assumptions import assumptions_of
from shaftprint.fingerprint._calibration import calibration_quantities
from shaftprint.fingerprint._conditions import Conditions, conditions_stated
from shaftprint.fingerprint._contradictions import contradictions, strange_beside_file
from shaftprint.fingerprint._findings import findings_of
from shaftprint.fingerprint._fingerprint import Fingerprint, Quality
from shaftprint.fingerprint._joint_numbers import joint_numbers
from shaftprint.fingerprint._leg_records import LegRecord, NoiseSpectrum
from shaftprint.fingerprint._line_fingerprint import SourceFile
from shaftprint.fingerprint._margin_numbers import margin_numbers
from shaftprint.fingerprint._margins import margin_quantities
from shaftprint.fingerprint._physical import physical_numbers, physical_quantities
from shaftprint.fingerprint._speed_age import shifts_of_speed_age, with_speed_age
from shaftprint.fingerprint._vessel_fields import vessel_fields
from shaftprint.fingerprint._working_point_share import (
    shifts_of_working_point,
    std_beside_fit,
    widened,
    widened_covariance,
)
from shaftprint.identify.fit._estimate import Estimate
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.fit._late_set_point import let_go
from shaftprint.identify.judgement._verdict import assess
from shaftprint.identify.uncertainty._budget import Budget, budget
from shaftprint.identify.uncertainty._profile import Interval, profile
from shaftprint.models._combination import Combination
from shaftprint.reasons import Note, Reason, doubt_scales
from shaftprint.units import SECONDS_PER_MINUTE

if TYPE_CHECKING:
    from shaftprint.campaign._campaign import Campaign
    from shaftprint.campaign._trial_conditions import TrialConditions
    from shaftprint.signals._signals import Signals
    from shaftprint.signals._working_points import WorkingPoint
    from shaftprint.spectra.lines._signal_to_noise import SignalToNoise
    from shaftprint.vessel._vessel import Vessel


@refusing_none(FingerprintError)
def take_fingerprint(
    identification: Identification,
    *,
    signals: "Signals",
    signal_to_noise: "SignalToNoise",
    vessel: "Vessel",
    campaign: "Campaign",
    settings_files: tuple[SourceFile, ...],
    now: datetime,
    tested_at: datetime | None = None,
    trial_conditions: "TrialConditions | None" = None,
    legs: Sequence[LegRecord] = (),
    reasons: Sequence[Reason] = (),
    cautions: Sequence[str] = (),
    noise: Sequence[NoiseSpectrum] = (),
    torque_ripple: float | None = None,
    ship: Sequence[Estimate] = (),
    explained_share: float = 0.0,
) -> Fingerprint:
    """Return the fingerprint of an identified line.

    Parameters
    ----------
    identification
        The fit whose parameters are kept.
    signals, signal_to_noise, vessel, campaign
        What the fit was made from.
    settings_files
        Vessel and campaign file with their hashes.
    now
        Time of making, with time zone.
    tested_at
        When the recording began, where that is known.
    trial_conditions
        Where and in what water the test was made, as far as that is known.
    legs, noise
        Legs that were fitted, and the noise at each speed, where they are known.
    torque_ripple
        What orders and noise put on top of the shaft torque over the load, where it was measured.
    reasons
        What else speaks against the fit, such as legs that do not belong to one model.
    cautions
        What is no reason against its numbers, but close to one.
    ship
        What a test underway says of the ship, which is kept with the physical values.
    explained_share
        Share of the misfit that another structure takes away, which one of the reasons names.

    Raises
    ------
    FingerprintError
        If ``now`` has no time zone.
    """
    if now.tzinfo is None:
        raise FingerprintError("now: expected a time with time zone, such as datetime.now(UTC), found one without.")
    values = identification.structure_values()
    margins = margin_numbers(identification.structure, values)
    rack = signals.channels.get("X")
    rack_share = 0.0 if rack is None else rack.reference_std / rack.reference
    main = signals.working_point
    kept = {leg.name for leg in legs}
    points = (leg.working_point for leg in signals.legs if leg.name in kept)
    of_legs = sorted(points, key=lambda point: point != main)
    shifts = shifts_of_working_point(identification, main, rack_share, of_legs if main in of_legs else ())
    shifts |= shifts_of_speed_age(identification)
    stated = _budget(identification, signals.working_point, vessel, margins, shifts)
    profiled = profile(let_go(identification), margins) if identification.is_likelihood else None
    intervals = {} if profiled is None else profiled.intervals
    physical = (*physical_quantities(identification, signals.working_point, vessel, stated, intervals), *ship)
    left_out = _left_out(identification)
    reported = _Reported(stated, intervals)
    parameters = tuple(reported.quantity(e) for e in identification.parameters)
    combinations = tuple(reported.quantity(e) for e in identification.combinations)
    stated_conditions = conditions_stated(vessel, campaign.name, campaign.place, trial_conditions, tested_at)
    conditions = _conditions(identification, signals, vessel, left_out, stated_conditions)
    margin = margin_quantities(identification, profiled, stated)
    off = contradictions(physical, signals, vessel, campaign)
    judged = with_speed_age(profiled, stated)
    # a reason says more of what a wrong scale makes of lever, torque and engine
    in_doubt = doubt_scales((*off, *reasons, *signals.reasons))
    verdict = assess(
        identification,
        profile=judged,
        signal_to_noise=signal_to_noise,
        reasons=(*off, *reasons),
        further=[*physical, *margin, conditions.engine_speed, conditions.shaft_torque],
        assumptions=assumptions_of(identification, vessel, margins, intervals),
        cautions=() if in_doubt else (*strange_beside_file(signals, vessel), *cautions),
        explained_share=explained_share,
    )
    return Fingerprint(
        shaftprint_version=shaftprint.__version__,
        created=now,
        sources=(
            SourceFile(role="recording", name=signals.recording_name, sha256=signals.recording_sha256),
            *settings_files,
        ),
        conditions=conditions,
        legs=tuple(legs),
        noise=tuple(noise),
        torque_ripple=torque_ripple,
        structure=identification.structure.name,
        parameters=parameters,
        held={p.name: p.value for p in identification.structure.parameters if p.held},
        priors=dict(identification.settings.priors),
        covariance=_rows(widened_covariance(identification.covariance, identification, shifts)),
        combinations=combinations,
        physical=physical,
        margins=margin,
        joint=joint_numbers(identification, signals.working_point, vessel, shifts),
        budget=Budget(sources=stated.sources, rows=tuple(row for row in stated.rows if row.variances)),
        vessel_fields=vessel_fields(vessel),
        calibration=calibration_quantities(signals, machine=vessel.machine.word),
        quality=_quality(identification, signals, signal_to_noise),
        verdict=verdict,
        findings=(
            *findings_of(
                identification,
                physical,
                stated,
                left_out,
                judged,
                numbers={one.name: one for one in (*parameters, *combinations)},
                not_trusted=verdict.not_trusted,
                vessel=vessel,
                reasons=off,
            ),
            *(str(one) for one in signals.findings if isinstance(one, Note)),
        ),
    )


def _budget(
    identification: Identification,
    working_point: "WorkingPoint",
    vessel: "Vessel",
    margins: tuple[Combination, ...],
    shifts: Mapping[str, Mapping[str, float]],
) -> Budget:
    """Return the budget of parameters, combinations, physical values and margins."""
    numbers = physical_numbers(identification, working_point, vessel)
    direct = {item.number.name: item.direct for item in numbers}
    return budget(identification, (*(item.number for item in numbers), *margins), direct=direct, shifts=shifts)


def _rows(matrix: FloatArray) -> tuple[tuple[float, ...], ...]:
    return tuple(tuple(row) for row in matrix.tolist())


def _left_out(identification: Identification) -> dict[str, str]:
    """Return why lines are fitted in no response, by name, those of all legs."""
    return {
        name: part.response.remarks.get(name, "not chosen")
        for part in identification.experiments
        for name in part.response.lines
        if name not in _used(identification)
    }


def _used(identification: Identification) -> dict[str, None]:
    """Return the lines that are fitted, those of all legs, in their order."""
    return {
        name: None
        for part in identification.experiments
        for name, fitted in zip(part.response.lines, part.fitted, strict=True)
        if fitted
    }


def _conditions(
    identification: Identification,
    signals: "Signals",
    vessel: "Vessel",
    left_out: dict[str, str],
    stated: Mapping[str, object],
) -> Conditions:
    speed, torque = _working_point(signals.working_point, vessel)
    return Conditions(
        **stated,
        engine_speed=speed,
        shaft_torque=torque,
        set_point_v=signals.working_point.set_point_v,
        speed_channel=signals.engine_speed.name,
        mode=signals.mode,
        lines_used=tuple(_used(identification)),
        lines_left_out=left_out,
    )


def _working_point(point: "WorkingPoint", vessel: "Vessel") -> tuple[Estimate, Estimate]:
    """Return speed and torque of the working point; what the gauge shows is off by its scale and its zero as well."""
    gauge = vessel.sensors.shaft_torque
    of_gauge = (gauge.scale_std * point.shaft_torque_nm, gauge.zero_std * point.zero_share)
    return (
        Estimate(
            name="n_0",
            unit="rpm",
            value=point.engine_speed_rev_s * SECONDS_PER_MINUTE,
            std=point.engine_speed_std_rev_s * SECONDS_PER_MINUTE,
            meaning=f"{vessel.machine.word} speed of the working point",
            role=ShipRole.SPEED,
        ),
        Estimate(
            name="M_s0",
            unit="N m",
            value=point.shaft_torque_nm,
            std=math.hypot(point.shaft_torque_std_nm, *of_gauge),
            meaning=f"shaft torque of the working point{', which drives astern' * vessel.working_point.is_astern}",
            role=ShipRole.TORQUE,
        ),
    )


@dataclass(frozen=True, slots=True)
class _Reported:
    """Turns estimates of the fit into what is reported: with the error of the working point."""

    stated: Budget
    intervals: Mapping[str, Interval]

    def quantity(self, estimate: Estimate) -> Estimate:
        """Return a parameter or combination with its standard deviation and interval."""
        interval = self.intervals.get(estimate.name)
        further = std_beside_fit(self.stated, estimate.name)
        is_open = (False, False) if interval is None else (interval.lower_open, interval.upper_open)
        return replace(
            estimate,
            std=float(np.hypot(estimate.std, further)),
            interval_95=None
            if interval is None
            else widened((interval.lower, interval.upper), estimate.value, further, is_open),
            interval_open=is_open,
        )


def _quality(identification: Identification, signals: "Signals", signal_to_noise: "SignalToNoise") -> Quality:
    counts = Counter(f"{repair.channel}: {repair.kind}" for repair in signals.repairs)
    response = identification.response
    remarks = (
        f"Line {name} is fitted, but: {response.remarks[name]}."
        for name, fitted in zip(response.lines, identification.fitted, strict=True)
        if fitted and name in response.remarks
    )
    return Quality(
        weighting=type(identification.settings.weighting).__name__,
        fit_percent=dict(identification.fit_percent),
        fit_ceiling=dict(identification.fit_ceiling),
        chi_square=identification.chi_square if identification.is_likelihood else None,
        p_value=identification.p_value,
        degrees_of_freedom=identification.degrees_of_freedom,
        starts=identification.settings.starts,
        starts_at_optimum=identification.reached,
        snr_overall=dict(zip(signal_to_noise.channels, signal_to_noise.overall.tolist(), strict=True)),
        snr_local_db={
            channel: dict(zip(signal_to_noise.lines, column, strict=True))
            for channel, column in zip(signal_to_noise.channels, signal_to_noise.local_db.T.tolist(), strict=True)
        },
        repairs=dict(sorted(counts.items())),
        remarks=(*(one for one in signals.findings if not isinstance(one, Note)), *remarks),
    )
