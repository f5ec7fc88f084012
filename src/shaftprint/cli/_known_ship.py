"""What ``plan`` knows of a ship: from its vessel file, a first test, a recording, and what the user states."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import click

from shaftprint.cli._plan_options import StatedLimit, limits_with, set_point_rpm_of
from shaftprint.cli.output import Steps, fingerprint_at
from shaftprint.design import (
    AssumedShip,
    Knowledge,
    Limits,
    SetPointLine,
    limits_from_vessel,
    limits_of_fingerprint,
    line_of_fingerprint,
    ship_before_test,
    ship_of_fingerprint,
    usual_speeds,
)
from shaftprint.fingerprint import Fingerprint
from shaftprint.identify import STAN_TUG_NOISE_AT_SPEEDS, NoiseLevels, Prior, noise_at, priors_from_vessel
from shaftprint.models import Structure
from shaftprint.survey import load_trial, measure, noise_at_speeds, stated_working_point
from shaftprint.units import rpm_from_rev_s
from shaftprint.vessel import Vessel


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Stated:
    """What the user states of the ship and its limits."""

    structure: Structure
    """The structure that the test is to find, with what is held."""
    vessel: Vessel
    """The vessel file."""
    limits: Sequence[StatedLimit]
    """Limits instead of those of the vessel file."""
    speeds: tuple[float, ...] | None
    """Speeds of the legs over that of the vessel file's working point; None for the usual ones."""
    rpm_per_volt: float | None
    """Slope of the set point [rpm/V]."""
    offset_v: float | None
    """Set point at the working point [V]."""
    priors: Mapping[str, Prior]
    """Priors instead of those of the vessel file."""
    freed: Sequence[str]
    """Parameters of which nothing is taken as known."""
    values: Mapping[str, float]
    """Assumed values."""
    after: Path | None
    """Fingerprint of a first test."""
    noise_from: Path | None
    """Recording that shows the noise."""
    noise_campaign: str | None
    """Its campaign."""
    vessel_name: str
    """Path or name of the vessel file."""


def knowledge_of(stated: Stated, *, steps: Steps) -> Knowledge:
    """Return what is known of the ship.

    Raises
    ------
    ShaftprintError
        If a file cannot be used, or limits leave no room.
    click.UsageError
        If the line from volts to speed is not known.
    """
    first_test = None if stated.after is None else fingerprint_at(stated.after)
    recorded = None if stated.noise_from is None else _recorded(stated, steps)
    line = _line(stated, first_test, recorded)
    limits = _limits(stated, line, first_test)
    point_rpm, vessel_rpm = limits.engine_speed_rpm, stated.vessel.working_point.engine_speed_rpm
    shares = stated.speeds
    # after a first test the working point is that of the test, at which its numbers are normalised
    speeds = usual_speeds(limits) if shares is None else tuple(share * vessel_rpm / point_rpm for share in shares)
    outputs = stated.structure.outputs
    levels, source = _noise(stated, first_test, recorded)
    noise = {share: noise_at(levels, share * point_rpm) for share in speeds}
    priors = priors_from_vessel(stated.structure, stated.vessel, stated_working_point(stated.vessel))
    priors = {name: prior for name, prior in (priors | dict(stated.priors)).items() if name not in stated.freed}
    return Knowledge(
        vessel=stated.vessel.name,
        ship=_ship(stated, first_test, priors),
        limits=limits,
        line=line,
        noise={share: level.of_outputs(*outputs) for share, level in noise.items()},
        noise_source=source,
        priors=priors,
    )


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Recorded:
    """What a recording tells a plan."""

    line: SetPointLine
    """From volts to engine speed, about the vessel file's working point."""
    noise: Mapping[float, NoiseLevels]
    """Noise by engine speed [rpm]."""


def _recorded(stated: Stated, steps: Steps) -> _Recorded:
    if stated.noise_campaign is None:
        raise click.UsageError("--noise-from needs --noise-campaign, which says what was asked in that recording.")
    trial = load_trial(stated.vessel_name, stated.noise_campaign)
    measurement = measure(Path(str(stated.noise_from)), trial, mode="shaftprint", progress=steps)
    calibration = measurement.signals.calibration
    slope = calibration.slope_rev_s_per_v
    speed_rev_s = stated_working_point(trial.vessel).engine_speed_rev_s
    line = SetPointLine(
        slope_rpm_per_v=rpm_from_rev_s(slope),
        offset_v=(speed_rev_s - calibration.intercept_rev_s) / slope if slope else 0.0,
    )
    return _Recorded(line=line, noise=noise_at_speeds(measurement, trial.campaign))


def _noise(
    stated: Stated, first_test: Fingerprint | None, recorded: _Recorded | None
) -> tuple[Mapping[float, NoiseLevels], str]:
    """Return the noise by engine speed [rpm] and where it is from: the recording, else the first test, else assumed."""
    if recorded is not None:
        return recorded.noise, f"noise of {Path(str(stated.noise_from)).name}"
    if first_test is not None and first_test.noise:
        return first_test.noise_at_speeds, f"noise of the first test, {first_test.conditions.campaign}"
    point_rpm = stated.vessel.working_point.engine_speed_rpm
    assumed = {share * point_rpm: level for share, level in STAN_TUG_NOISE_AT_SPEEDS.items()}
    return assumed, f"noise of the Stan Tug 1205 assumed for {stated.vessel.name}"


def _line(stated: Stated, first_test: Fingerprint | None, recorded: _Recorded | None) -> SetPointLine:
    known = recorded.line if recorded is not None else None
    known = line_of_fingerprint(first_test) if first_test is not None else known
    slope = stated.rpm_per_volt if stated.rpm_per_volt is not None else getattr(known, "slope_rpm_per_v", None)
    offset_v = stated.offset_v if stated.offset_v is not None else getattr(known, "offset_v", None)
    if slope is None or offset_v is None:
        point = stated.vessel.working_point
        raise click.UsageError(
            "expected --rpm-per-volt and --offset, what one volt of set point asks for and the voltage at "
            f"{point.engine_speed_rpm:g} rpm, such as --rpm-per-volt -251 --offset -5; or a first test that has "
            "measured them, with --after or --noise-from."
        )
    return SetPointLine(slope_rpm_per_v=slope, offset_v=offset_v)


def _limits(stated: Stated, line: SetPointLine, first_test: Fingerprint | None) -> Limits:
    set_point_rpm = set_point_rpm_of(stated.limits, line.slope_rpm_per_v)
    if set_point_rpm is None:
        raise click.UsageError(
            "expected --limit set-point=..., the largest deviation of the set point from the level of a leg, in V or "
            "rpm, such as --limit set-point=1.0V."
        )
    limits = limits_from_vessel(stated.vessel, set_point_rpm=set_point_rpm)
    if first_test is not None:
        limits = limits_of_fingerprint(limits, first_test, stated.vessel)
    return limits_with(limits, stated.limits)


def _ship(stated: Stated, first_test: Fingerprint | None, priors: Mapping[str, Prior]) -> AssumedShip:
    if first_test is not None:
        return ship_of_fingerprint(first_test, stated.structure)
    return ship_before_test(stated.structure, priors, stated.values)
