"""What ``plan`` knows of a ship: from its vessel file, a first test, a recording, and what the user states."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import click

from shaftprint.catalogue._own_structure import TypedName, chosen_structures
from shaftprint.cli._known_ship_options import KnownShipOptions
from shaftprint.cli._plan_options import limits_with, set_point_rpm_of
from shaftprint.cli.output._fingerprint_file import fingerprint_at
from shaftprint.cli.output._progress import Steps
from shaftprint.design.inputs._assumed_ship import AssumedShip
from shaftprint.design.inputs._knowledge import Knowledge
from shaftprint.design.inputs._known_ship import (
    limits_of_fingerprint,
    possible_ship,
    ship_before_test,
    ship_of_fingerprint,
)
from shaftprint.design.inputs._limits import Limits, limits_from_vessel, usual_speeds
from shaftprint.design.inputs._set_point_line import SetPointLine, line_of_fingerprint
from shaftprint.design.motion._motion import expect_motion
from shaftprint.fingerprint._fingerprint import Fingerprint
from shaftprint.fingerprint._model import structure_to_use
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
from shaftprint.survey._of_vessel import at_speeds, default_structure, of_vessel
from shaftprint.survey._trial import load_trial
from shaftprint.units import rpm_from_rev_s
from shaftprint.vessel._vessel import Vessel, load_vessel


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Stated:
    """What the user states of the ship and its limits."""

    structure: Structure
    """The structure that the test is to find, with what is held."""
    vessel: Vessel
    """The vessel file."""
    vessel_name: str
    """Path or name of the vessel file."""
    first_test: Fingerprint | None
    """Fingerprint of a first test; None where there was none."""
    options: KnownShipOptions
    """What is stated beside these."""


def stated_ship(vessel_name: str, structure_name: TypedName | None, options: KnownShipOptions) -> Stated:
    """Return what the user states, with its files read.

    Parameters
    ----------
    vessel_name
        Path or name of the vessel file.
    structure_name
        The structure; that of the first test, or else the closed loop of what drives the line, where it is None.
    options
        What is stated beside these.

    Raises
    ------
    ShaftprintError
        If a file cannot be used, or there is no such structure or parameter.
    """
    vessel = load_vessel(vessel_name)
    first_test = None if options.after is None else fingerprint_at(options.after)
    if first_test is None:
        (structure,) = chosen_structures([structure_name or default_structure(vessel)])
    else:
        structure = structure_to_use(structure_name, first_test)
    return Stated(
        structure=of_vessel(structure, vessel).held_at(**dict(options.held)),
        vessel=vessel,
        vessel_name=vessel_name,
        first_test=first_test,
        options=options,
    )


FIRST_TEST_S = 160.0
"""Length of a first test [s]: two legs of 45 s, with ramps between them and back."""
_SET_POINT_LIMIT = (
    "--limit set-point=..., the largest deviation of the set point from the level of a leg, in V or rpm, such as "
    "--limit set-point=1.0V"
)


def knowledge_of(stated: Stated, *, steps: Steps, within_s: float | None = None) -> Knowledge:
    """Return what is known of the ship.

    Parameters
    ----------
    stated
        What the user states.
    steps
        Is told what is being done.
    within_s
        Length of the test that is planned [s], if it is stated.

    Raises
    ------
    ShaftprintError
        If a file cannot be used, or limits leave no room.
    click.UsageError
        If the line from volts to speed is not known.
    """
    options = stated.options
    expect_motion(stated.structure)
    recorded = None if options.noise_from is None else _recorded(stated, steps)
    line = _line(stated, recorded)
    limits = _limits(stated, line, recorded)
    speeds, point_rpm = _speeds(stated, limits), limits.engine_speed_rpm
    structure = at_speeds(stated.structure, speeds)
    outputs = structure.outputs
    point = stated_working_point(stated.vessel)
    expected = _known(options, expected_from_vessel(structure, stated.vessel, point))
    ship = _ship(stated, structure, expected)
    possible = _possible(stated, structure, expected, ship)
    levels, spread, source = _noise(stated, recorded, possible or ship)
    noise = {share: noise_at(levels, share * point_rpm) for share in speeds}
    priors = _known(options, priors_from_vessel(structure, stated.vessel, point))
    return Knowledge(
        vessel=stated.vessel.name,
        ship=ship,
        limits=limits,
        line=line,
        noise={share: level.of_outputs(*outputs) for share, level in noise.items()},
        noise_spread=spread,
        noise_is_assumed=recorded is None and not (stated.first_test is not None and stated.first_test.noise),
        possible=possible,
        noise_source=source,
        priors=priors,
        remarks=(*_remarks(stated), *_first_test(stated, recorded, limits, within_s)),
    )


def _remarks(stated: Stated) -> tuple[str, ...]:
    """Return what a plan of the speed's lines leaves alone."""
    if stated.vessel.pitch is None or stated.vessel.combinator is not None:
        return ()
    return (
        f"The pitch stands at P/D {stated.vessel.propeller.pitch_ratio:g} while the speed is moved: the plan is for "
        f"{stated.structure.name}, and what the pitch does to the torque is not found; lines of both are a campaign by "
        "hand, such as the shipped pitch, which shaftprint predict takes.",
    )


def _first_test(
    stated: Stated, recorded: "_Recorded | None", limits: Limits, within_s: float | None
) -> tuple[str, ...]:
    """Return what to do first where nothing was recorded of the ship."""
    is_first = within_s is not None and within_s < 2.0 * FIRST_TEST_S
    if is_first or recorded is not None or stated.first_test is not None:
        return ()
    third = f"{limits.set_point_rpm / 3.0:.0f}rpm"
    return (
        "Nobody has measured the noise of this ship. A first test of 90 s does: plan "
        f"--within {FIRST_TEST_S:g}s --limit set-point={third}, sail and identify it, and plan again with --after and "
        "its fingerprint; the noise of the plan is then that of this ship.",
    )


def _speeds(stated: Stated, limits: Limits) -> tuple[float, ...]:
    """Return the speeds of the legs over that of the working point, which after a first test is that of the test.

    Raises
    ------
    click.UsageError
        If speeds are asked for where a ship has one.
    """
    shares, vessel_rpm = stated.options.speeds, stated.vessel.working_point.engine_speed_rpm
    if stated.vessel.why_one_speed:
        if shares not in (None, (1.0,)):
            raise click.UsageError(
                f"--speeds: expected none, so that all legs are at the {vessel_rpm:g} rpm of the vessel file, found "
                f"{', '.join(f'{share:g}' for share in shares)}; {stated.vessel.why_one_speed}: write a vessel file "
                "for another."
            )
        return (1.0,)
    if shares is None:
        return usual_speeds(limits, working_point_rpm=vessel_rpm)
    return tuple(share * vessel_rpm / limits.engine_speed_rpm for share in shares)


def _known(options: KnownShipOptions, of_vessel: Mapping[str, Prior]) -> dict[str, Prior]:
    """Return what the vessel file and the user know, without what the user frees."""
    return {name: one for name, one in (dict(of_vessel) | dict(options.priors)).items() if name not in options.freed}


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Recorded:
    """What a recording tells a plan."""

    line: SetPointLine
    """From volts to engine speed, about the vessel file's working point."""
    noise: Mapping[float, NoiseLevels]
    """Noise by engine speed [rpm]."""
    torque_ripple: float | None
    """Torque of orders and noise at the gauge over the load; None where it was not seen."""


def _recorded(stated: Stated, steps: Steps) -> _Recorded:
    if stated.options.noise_campaign is None:
        raise click.UsageError("--noise-from needs --noise-campaign, which says what was asked in that recording.")
    trial = load_trial(stated.vessel_name, stated.options.noise_campaign)
    measurement = measure(Path(str(stated.options.noise_from)), trial, mode="shaftprint", progress=steps)
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


def _noise(
    stated: Stated, recorded: _Recorded | None, ship: AssumedShip
) -> tuple[Mapping[float, NoiseLevels], float, str]:
    """Return the noise by engine speed [rpm], how far it may be from that, and where it is from.

    It is that of the recording, else of the first test, below their slowest line with the shape that is usual on ships
    of the kind; else what is usual.
    """
    point_rpm = stated.vessel.working_point.engine_speed_rpm
    assumed = noise_of_unknown_ship(stated.vessel, ship.structure, ship.by_name)
    usual = {share * point_rpm: level for share, level in assumed.legs.items()}
    if recorded is not None:
        return (
            continued_below(recorded.noise, usual),
            RECORDED_SPREAD,
            f"noise of {Path(str(stated.options.noise_from)).name}",
        )
    first_test = stated.first_test
    if first_test is not None and first_test.noise:
        source = f"noise of the first test, {first_test.conditions.campaign}"
        return continued_below(first_test.noise_at_speeds, usual), RECORDED_SPREAD, source
    return usual, NOISE_SPREAD, assumed.words


def _line(stated: Stated, recorded: _Recorded | None) -> SetPointLine:
    known = recorded.line if recorded is not None else None
    known = line_of_fingerprint(stated.first_test) if stated.first_test is not None else known
    slope, offset_v = stated.options.rpm_per_volt, stated.options.offset_v
    slope = slope if slope is not None else getattr(known, "slope_rpm_per_v", None)
    offset_v = offset_v if offset_v is not None else getattr(known, "offset_v", None)
    if slope is None or offset_v is None:
        point = stated.vessel.working_point
        limited = any(limit.name == "set-point" for limit in stated.options.limits)
        raise click.UsageError(
            "expected --rpm-per-volt and --offset, what one volt of set point asks for and the voltage at "
            f"{point.engine_speed_rpm:g} rpm, such as --rpm-per-volt -251 --offset -5; or a first test that has "
            "measured them, with --after or --noise-from"
            f"{'' if limited else f'; and {_SET_POINT_LIMIT}'}."
        )
    return SetPointLine(slope_rpm_per_v=slope, offset_v=offset_v)


def _limits(stated: Stated, line: SetPointLine, recorded: _Recorded | None) -> Limits:
    set_point_rpm = set_point_rpm_of(stated.options.limits, line.slope_rpm_per_v)
    if set_point_rpm is None:
        raise click.UsageError(f"expected {_SET_POINT_LIMIT}.")
    limits = limits_from_vessel(stated.vessel, set_point_rpm=set_point_rpm)
    if stated.first_test is not None:
        limits = limits_of_fingerprint(limits, stated.first_test, stated.vessel)
    if recorded is not None:
        limits = limits.with_ripple(recorded.torque_ripple)
    return limits_with(limits, stated.options.limits)


def _ship(stated: Stated, structure: Structure, expected: Mapping[str, Prior]) -> AssumedShip:
    if stated.first_test is not None:
        return ship_of_fingerprint(stated.first_test, stated.structure).extended(structure)
    return _usual(stated, structure, expected)


def _usual(stated: Stated, structure: Structure, expected: Mapping[str, Prior]) -> AssumedShip:
    """Return what is usual on ships of the kind, before any test."""
    of_ship = expected_of_ship(structure, stated.vessel)
    unknown = {name: value for name, value in of_ship.items() if name not in expected}
    return ship_before_test(structure, expected, unknown | dict(stated.options.values))


def _possible(
    stated: Stated, structure: Structure, expected: Mapping[str, Prior], ship: AssumedShip
) -> AssumedShip | None:
    """Return the ships on which a test after a first one may be sailed; None where there was none."""
    if stated.first_test is None:
        return None
    point = stated_working_point(stated.vessel)
    return possible_ship(
        ship,
        stated.first_test,
        _usual(stated, structure, expected),
        engine_speed_rpm=rpm_from_rev_s(point.engine_speed_rev_s),
        shaft_torque_nm=point.shaft_torque_nm,
    )
