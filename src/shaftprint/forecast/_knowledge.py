"""The verb ``knowledge_of``: what a plan takes of a ship, from vessel file, first test and recording."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from shaftprint.catalogue._own_structure import TypedName
from shaftprint.design.inputs._assumed_ship import AssumedShip
from shaftprint.design.inputs._knowledge import Knowledge
from shaftprint.design.inputs._known_ship import (
    limits_of_fingerprint,
    possible_ship,
    ship_before_test,
    ship_of_fingerprint,
)
from shaftprint.design.inputs._lever import lever_of_sensor
from shaftprint.design.inputs._limits import Limits, limits_from_vessel, usual_speeds
from shaftprint.design.inputs._set_point_line import SetPointLine, line_of_fingerprint, line_of_sensor
from shaftprint.design.inputs._stated_limits import StatedLimit, limits_with, set_point_rpm_of
from shaftprint.design.motion._motion import expect_motion
from shaftprint.errors import RequestError
from shaftprint.forecast._ship_before_test import ShipBeforeTest
from shaftprint.identify.likelihood._known import expected_from_vessel, priors_from_vessel
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.identify.prediction._noise_at_speeds import noise_at
from shaftprint.identify.prediction._noise_levels import NoiseLevels
from shaftprint.models._structure import Structure
from shaftprint.survey._assumed_noise import NOISE_SPREAD, RECORDED_SPREAD, continued_below, noise_of_unknown_ship
from shaftprint.survey._expected_of_ship import expected_of_ship
from shaftprint.survey._fits import stated_working_point
from shaftprint.survey._measurement import measure
from shaftprint.survey._noise import noise_at_speeds
from shaftprint.survey._of_vessel import at_speeds
from shaftprint.survey._progress import SILENT, Progress
from shaftprint.survey._trial import load_trial
from shaftprint.units import rpm_from_rev_s
from shaftprint.vessel._vessel import Vessel

FIRST_TEST_S = 160.0
"""Length of a first test [s]: two legs of 45 s, with ramps between them and back."""
_SET_POINT_LIMIT = (
    "--limit set-point=..., the largest deviation of the set point from the level of a leg, in V, rpm or the unit of "
    "the lever, such as --limit set-point=1.0V"
)


def knowledge_of(
    known: ShipBeforeTest,
    *,
    limits: Sequence[StatedLimit] = (),
    speeds: Sequence[float] | None = None,
    structure: TypedName | None = None,
    within_s: float | None = None,
    progress: Progress = SILENT,
) -> Knowledge:
    """Return what a plan of a test takes of a ship.

    Parameters
    ----------
    known
        What is known of the ship, with its vessel file.
    limits
        Limits instead of those of the vessel file; how far the set point may move, ``set-point``, nobody else knows.
    speeds
        Speeds of the legs over that of the vessel file's working point; as far apart as is usual where not given.
    structure
        The structure that the test is to find; that of the first test, or else the closed loop of what drives the line.
    within_s
        Length of the test that is planned [s], if it is stated.
    progress
        Is told what is being done.

    Raises
    ------
    ShaftprintError
        If a file cannot be used, or limits leave no room.
    RequestError
        If there is no vessel file, or the line from volts to speed or the range of the set point is not known.
    """
    if known.vessel is None:
        raise RequestError("expected --vessel, which says what ship and engine allow.")
    chosen = known.structure(structure)
    expect_motion(chosen)
    recorded = None if known.recording is None else _recorded(known, known.vessel, known.recording, progress)
    stated = _Stated(
        ship=known,
        vessel=known.vessel,
        structure=chosen,
        limits=tuple(limits),
        speeds=None if speeds is None else tuple(speeds),
        recorded=recorded,
    )
    line = _line(stated)
    allowed = _limits(stated, line)
    shares, point_rpm = _speeds(stated, allowed), allowed.engine_speed_rpm
    at_all = at_speeds(chosen, shares)
    point = stated_working_point(known.vessel)
    expected = known.known(expected_from_vessel(at_all, known.vessel, point))
    ship = _ship(stated, at_all, expected)
    possible = _possible(stated, at_all, expected, ship)
    levels, spread, source = _noise(stated, possible or ship)
    noise = {share: noise_at(levels, share * point_rpm) for share in shares}
    return Knowledge(
        vessel=known.vessel.name,
        ship=ship,
        limits=allowed,
        line=line,
        noise={share: level.of_outputs(*at_all.outputs) for share, level in noise.items()},
        noise_spread=spread,
        noise_is_assumed=recorded is None and not (known.first_test is not None and known.first_test.noise),
        possible=possible,
        noise_source=source,
        priors=known.known(priors_from_vessel(at_all, known.vessel, point)),
        remarks=(*_remarks(stated), *_first_test(stated, allowed, within_s)),
    )


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Stated:
    """What is known of the ship with what is asked of its plan."""

    ship: ShipBeforeTest
    vessel: Vessel
    structure: Structure
    limits: tuple[StatedLimit, ...]
    speeds: tuple[float, ...] | None
    recorded: "_Recorded | None"


def _remarks(stated: _Stated) -> tuple[str, ...]:
    """Return what a plan of the speed's lines leaves alone."""
    if stated.vessel.pitch is None or stated.vessel.combinator is not None:
        return ()
    return (
        f"The pitch stands at P/D {stated.vessel.propeller.pitch_ratio:g} while the speed is moved: the plan is for "
        f"{stated.structure.name}, and what the pitch does to the torque is not found; lines of both are a campaign by "
        "hand, such as the shipped pitch, which shaftprint predict takes.",
    )


def _first_test(stated: _Stated, limits: Limits, within_s: float | None) -> tuple[str, ...]:
    """Return what to do first where nothing was recorded of the ship."""
    is_first = within_s is not None and within_s < 2.0 * FIRST_TEST_S
    if is_first or stated.recorded is not None or stated.ship.first_test is not None:
        return ()
    third = f"{limits.set_point_rpm / 3.0:.0f}rpm"
    return (
        "Nobody has measured the noise of this ship. A first test of 90 s does: "
        f"`plan --within {FIRST_TEST_S:g}s --limit set-point={third}`, sail and identify it, and plan again with "
        "--after and its fingerprint; the noise of the plan is then that of this ship.",
    )


def _speeds(stated: _Stated, limits: Limits) -> tuple[float, ...]:
    """Return the speeds of the legs over that of the working point, which after a first test is that of the test.

    Raises RequestError if speeds are asked for where a ship has one.
    """
    shares, vessel_rpm = stated.speeds, stated.vessel.working_point.engine_speed_rpm
    if stated.vessel.why_one_speed:
        if shares not in (None, (1.0,)):
            raise RequestError(
                f"--speeds: expected none, so that all legs are at the {vessel_rpm:g} rpm of the vessel file, found "
                f"{', '.join(f'{share:g}' for share in shares)}; {stated.vessel.why_one_speed}: write a vessel file "
                "for another."
            )
        return (1.0,)
    if shares is None:
        return usual_speeds(limits, working_point_rpm=vessel_rpm)
    return tuple(share * vessel_rpm / limits.engine_speed_rpm for share in shares)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Recorded:
    """What a recording tells a plan."""

    line: SetPointLine
    """From volts to engine speed, about the vessel file's working point."""
    noise: Mapping[float, NoiseLevels]
    """Noise by engine speed [rpm]."""
    torque_ripple: float | None
    """Torque of orders and noise at the gauge over the load; None where it was not seen."""


def _recorded(known: ShipBeforeTest, vessel: Vessel, recording: Path, progress: Progress) -> _Recorded:
    if known.recorded is None:
        raise RequestError("--noise-from needs --noise-campaign, which says what was asked in that recording.")
    trial = load_trial(vessel, known.recorded)
    measurement = measure(recording, trial, mode="shaftprint", progress=progress)
    calibration = measurement.signals.calibration
    slope = calibration.slope_rev_s_per_v
    speed_rev_s = stated_working_point(trial.vessel).engine_speed_rev_s
    line = SetPointLine(
        slope_rpm_per_v=rpm_from_rev_s(slope),
        offset_v=(speed_rev_s - calibration.intercept_rev_s) / slope if slope else 0.0,
    )
    return _Recorded(
        line=line, noise=noise_at_speeds(measurement, trial.campaign), torque_ripple=measurement.torque_ripple
    )


def _noise(stated: _Stated, ship: AssumedShip) -> tuple[Mapping[float, NoiseLevels], float, str]:
    """Return the noise by engine speed [rpm], how far it may be from that, and where it is from.

    It is that of the recording, else of the first test, below their slowest line with the shape that is usual on ships
    of the kind; else what is usual.
    """
    point_rpm = stated.vessel.working_point.engine_speed_rpm
    assumed = noise_of_unknown_ship(stated.vessel, ship.structure, ship.by_name)
    usual = {share * point_rpm: level for share, level in assumed.legs.items()}
    if stated.recorded is not None and stated.ship.recording is not None:
        source = f"noise of {stated.ship.recording.name}"
        return continued_below(stated.recorded.noise, usual), RECORDED_SPREAD, source
    first_test = stated.ship.first_test
    if first_test is not None and first_test.noise:
        source = f"noise of the first test, {first_test.conditions.campaign}"
        return continued_below(first_test.noise_at_speeds, usual), RECORDED_SPREAD, source
    return usual, NOISE_SPREAD, assumed.words


def _line(stated: _Stated) -> SetPointLine:
    known = stated.recorded.line if stated.recorded is not None else None
    known = line_of_fingerprint(stated.ship.first_test) if stated.ship.first_test is not None else known
    known = line_of_sensor(stated.vessel) if known is None else known
    slope, offset_v = stated.ship.slope_rpm_per_v, stated.ship.offset_v
    slope = slope if slope is not None else getattr(known, "slope_rpm_per_v", None)
    offset_v = offset_v if offset_v is not None else getattr(known, "offset_v", None)
    if slope is None or offset_v is None:
        point = stated.vessel.working_point
        limited = any(limit.name == "set-point" for limit in stated.limits)
        raise RequestError(
            "expected --rpm-per-volt and --offset, what one volt of set point asks for and the voltage at "
            f"{point.engine_speed_rpm:g} rpm, such as --rpm-per-volt -251 --offset -5; or table_rpm of "
            "sensors.set_point in the vessel file; or a first test that has measured them, with --after or --noise-from"
            f"{'' if limited else f'; and {_SET_POINT_LIMIT}'}."
        )
    lever = lever_of_sensor(stated.vessel.sensors.set_point)
    return SetPointLine(slope_rpm_per_v=slope, offset_v=offset_v, lever=lever)


def _limits(stated: _Stated, line: SetPointLine) -> Limits:
    set_point_rpm = set_point_rpm_of(stated.limits, line)
    if set_point_rpm is None:
        raise RequestError(f"expected {_SET_POINT_LIMIT}.")
    limits = limits_from_vessel(stated.vessel, set_point_rpm=set_point_rpm)
    if stated.ship.first_test is not None:
        limits = limits_of_fingerprint(limits, stated.ship.first_test, stated.vessel)
    if stated.recorded is not None:
        limits = limits.with_ripple(stated.recorded.torque_ripple)
    return limits_with(limits, stated.limits)


def _ship(stated: _Stated, structure: Structure, expected: Mapping[str, Prior]) -> AssumedShip:
    if stated.ship.first_test is not None:
        return ship_of_fingerprint(stated.ship.first_test, stated.structure).extended(structure)
    return _usual(stated, structure, expected)


def _usual(stated: _Stated, structure: Structure, expected: Mapping[str, Prior]) -> AssumedShip:
    """Return what is usual on ships of the kind, before any test."""
    of_ship = expected_of_ship(structure, stated.vessel)
    unknown = {name: value for name, value in of_ship.items() if name not in expected}
    return ship_before_test(structure, expected, unknown | dict(stated.ship.values))


def _possible(
    stated: _Stated, structure: Structure, expected: Mapping[str, Prior], ship: AssumedShip
) -> AssumedShip | None:
    """Return the ships on which a test after a first one may be sailed; None where there was none."""
    if stated.ship.first_test is None:
        return None
    point = stated_working_point(stated.vessel)
    return possible_ship(
        ship,
        stated.ship.first_test,
        _usual(stated, structure, expected),
        engine_speed_rpm=rpm_from_rev_s(point.engine_speed_rev_s),
        shaft_torque_nm=point.shaft_torque_nm,
    )
