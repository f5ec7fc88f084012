"""``shaftprint predict``: what a test would find, before it is made."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import click
import numpy as np

from shaftprint.campaign import Campaign, load_campaign
from shaftprint.catalogue import structure
from shaftprint.cli._drive_judge import predict_on_the_bench
from shaftprint.cli._drive_options import drive_option, expect_not_given
from shaftprint.cli._known_values import hold_option, named_value, prior_option, rpm_per_volt_option
from shaftprint.cli._limit_uses import print_limit_uses
from shaftprint.cli._options import NAMES, campaign_option
from shaftprint.cli._own_structure import CLOSED_LOOP_HELP, OWN_FILE_HELP, TypedName, chosen_structures, closed_loop_of
from shaftprint.cli._prediction_tables import print_prediction
from shaftprint.cli._vessel_file import print_disagreements
from shaftprint.cli.output import no_progress_option, progress
from shaftprint.design import expected_operation, limit_uses, ship_before_test, stated_limits
from shaftprint.errors import StructureError
from shaftprint.identify import (
    STAN_TUG_NOISE,
    STAN_TUG_NOISE_AT_SPEEDS,
    NoiseLevels,
    Prior,
    expected_from_vessel,
    expected_response,
    identifiability,
    noise_at,
    planned_response,
    priors_from_vessel,
)
from shaftprint.identify.prediction import first_leg, planned_legs, predict_joint_accuracy, predict_joint_intervals
from shaftprint.models import Structure
from shaftprint.spectra import FrequencyResponse, open_loop
from shaftprint.spelling import meant
from shaftprint.survey import load_trial, measure, noise_at_speeds, priors_of, stated_working_point
from shaftprint.units import rpm_from_rev_s
from shaftprint.vessel import Vessel, load_vessel

# Where the sensitivity of a structure is taken; what can be found does not depend on it.
SEED = 1


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Ship:
    """What is known of the ship before the test."""

    priors: Mapping[str, Prior]
    noise: NoiseLevels
    noise_of_legs: Mapping[float, NoiseLevels]
    """By the speed of a leg over that of the first."""
    slope_rpm_per_v: float
    words: str
    vessel: Vessel | None = None


@click.command("predict")
@drive_option
@click.option(
    "--input",
    "inputs",
    multiple=True,
    type=click.Path(path_type=Path),
    help="With --drive: a file with the planned inputs, a column each; may be repeated.",
)
@click.option(
    "--noise",
    "noise",
    multiple=True,
    metavar="NAME=STD",
    type=named_value,
    help="With --drive: noise of one sample of an output; may be repeated.",
)
@click.option(
    "--fingerprint",
    type=click.Path(path_type=Path),
    help="With --drive: a result of identify, for values and noise.",
)
@campaign_option
@click.option("--structure", "name", metavar="NAME", help=f"Structure: {OWN_FILE_HELP}; {CLOSED_LOOP_HELP} by default.")
@click.option("--vessel", help=f"Vessel file, for what it knows of parameters: {NAMES} stan-tug-1205.")
@click.option(
    "--from",
    "recording",
    type=click.Path(path_type=Path),
    help="A recording of the ship, for its noise; without it the noise of the Stan Tug 1205 is assumed.",
)
@click.option("--from-campaign", "recorded", help="Campaign of that recording; --campaign when not given.")
@rpm_per_volt_option
@prior_option
@click.option(
    "--free", "freed", metavar="NAME", multiple=True, help="Take nothing as known of a parameter, such as tau_up."
)
@hold_option
@click.option(
    "--value",
    "values",
    metavar="NAME=VALUE",
    type=named_value,
    multiple=True,
    help="Value at which to predict; the prior's mean or the structure's default when not given.",
)
@no_progress_option
def command(
    drive_file: Path | None,
    inputs: tuple[Path, ...],
    noise: tuple[tuple[str, float], ...],
    fingerprint: Path | None,
    campaign: str,
    name: TypedName | None,
    vessel: str | None,
    recording: Path | None,
    recorded: str | None,
    rpm_per_volt: float | None,
    priors: tuple[tuple[str, Prior], ...],
    freed: tuple[str, ...],
    held: tuple[tuple[str, float], ...],
    values: tuple[tuple[str, float], ...],
    no_progress: bool,
) -> None:
    """Predict the accuracy of a planned test.

    Prints the standard deviation of every parameter that the lines of a campaign would give, what they cannot
    separate, and what no test of these outputs can find. With --vessel also where the test would leave the limits of
    ship and engine. --prior, --free, --hold and --value may be repeated.
    With --drive, the records of planned inputs are predicted instead.
    """
    if drive_file is not None:
        expect_not_given("campaign", "vessel", "recording", "recorded", "rpm_per_volt", "freed")
        chosen_names = () if name is None else (name,)
        predict_on_the_bench(
            drive_file, inputs, chosen_names, dict(noise), fingerprint, dict(values), dict(priors), dict(held)
        )
        return
    if inputs or noise or fingerprint is not None:
        raise click.UsageError("--input, --noise and --fingerprint need --drive.")
    known = None
    if vessel is not None:
        known = load_vessel(vessel)
        print_disagreements(known, vessel)
    (chosen,) = chosen_structures([name or closed_loop_of(known)])
    chosen = chosen.held_at(**dict(held))
    planned = load_campaign(campaign)
    _expect_free(freed, chosen)
    if recording is not None:
        if known is None:
            raise click.UsageError("--from needs --vessel, which says what is in the recording.")
        ship = _recorded(recording, known, recorded or planned, chosen, planned, no_progress=no_progress)
    else:
        ship = _assumed(known, rpm_per_volt, chosen, planned)
    assumed_priors = {
        parameter: prior for parameter, prior in (dict(ship.priors) | dict(priors)).items() if parameter not in freed
    }
    assumed = _values_of(chosen, ship.vessel, assumed_priors, freed, values)
    pairs = _planned(chosen, planned, ship)
    possible = identifiability(chosen, rng=np.random.default_rng(SEED))
    print_prediction(
        planned,
        [response for _, response in pairs],
        ship.words,
        possible,
        predict_joint_accuracy(pairs, values=assumed, priors=assumed_priors, combinations=possible.combinations),
        predict_joint_intervals(pairs, values=assumed, priors=assumed_priors),
    )
    if ship.vessel is not None:
        _print_limits(planned, ship.vessel, ship, dict(priors), values)


def _print_limits(
    planned: Campaign, vessel: Vessel, ship: _Ship, priors: Mapping[str, Prior], values: Sequence[tuple[str, float]]
) -> None:
    """Print where the campaign would leave the limits of the vessel file, and how near it comes to each.

    Whatever structure the test is for, it moves the whole closed loop.
    """
    loop = structure(closed_loop_of(vessel))
    assumed = _values_of(loop, vessel, priors, (), values)
    operation = expected_operation(planned, vessel, assumed, slope_rpm_per_v=ship.slope_rpm_per_v)
    print_limit_uses(limit_uses(operation, stated_limits(vessel)), is_expected=True)


def _expect_free(freed: tuple[str, ...], chosen: Structure) -> None:
    free = [parameter.name for parameter in chosen.free]
    unknown = [name for name in freed if name not in free]
    if unknown:
        expected = f"expected a free parameter, one of {', '.join(free)}.{meant(unknown[0], free)}"
        raise StructureError(f"--free {', '.join(unknown)}: {expected}")


def _recorded(
    path: Path, vessel: Vessel, campaign: str | Campaign, chosen: Structure, planned: Campaign, *, no_progress: bool
) -> _Ship:
    """Return what a recording tells of the noise, and what it and the vessel file know."""
    trial = load_trial(vessel, campaign)
    with progress(hidden=no_progress) as steps:
        measurement = measure(path, trial, mode="shaftprint", progress=steps)
    signals = measurement.signals
    slope = signals.calibration.slope_rev_s_per_v * signals.dc_scale
    levels = noise_at_speeds(measurement, trial.campaign)
    point_rpm = rpm_from_rev_s(signals.working_point.engine_speed_rev_s)
    noise = noise_at(levels, point_rpm)
    from_point_v = first_leg(planned).level_v - signals.working_point.set_point_v if planned.legs else 0.0
    first_rpm = point_rpm + rpm_from_rev_s(slope) * from_point_v
    priors = priors_of(chosen, trial.vessel, signals)
    return _Ship(
        priors=priors,
        noise=noise,
        noise_of_legs={rpm / first_rpm: level for rpm, level in levels.items()},
        slope_rpm_per_v=rpm_from_rev_s(slope),
        words=f"noise of {path.name}",
        vessel=trial.vessel,
    )


def _assumed(ship: Vessel | None, rpm_per_volt: float | None, chosen: Structure, planned: Campaign) -> _Ship:
    """Return the noise of the Stan Tug, and what the vessel file knows where there is one."""
    if ship is None:
        if rpm_per_volt is not None:
            raise click.UsageError("--rpm-per-volt needs --vessel, which says at what speed.")
        # with less voltage the tug goes faster; its speed plays no part without a vessel
        return _Ship(
            priors={},
            noise=STAN_TUG_NOISE,
            noise_of_legs=_assumed_of_legs(planned, -STAN_TUG_NOISE.set_point_per_v),
            slope_rpm_per_v=-1.0,
            words="noise of the Stan Tug 1205 assumed",
        )
    speed_rpm = ship.working_point.engine_speed_rpm
    slope = -STAN_TUG_NOISE.set_point_per_v * speed_rpm if rpm_per_volt is None else rpm_per_volt
    noise = replace(STAN_TUG_NOISE, set_point_per_v=abs(slope) / speed_rpm)
    priors = priors_from_vessel(chosen, ship, stated_working_point(ship))
    words = f"noise of the Stan Tug 1205 assumed for {ship.name}"
    of_legs = _assumed_of_legs(planned, slope / speed_rpm)
    return _Ship(priors=priors, noise=noise, noise_of_legs=of_legs, slope_rpm_per_v=slope, words=words, vessel=ship)


def _assumed_of_legs(planned: Campaign, per_v: float) -> dict[float, NoiseLevels]:
    """Return the noise of the Stan Tug by the speed of a leg over that of the first, the working point at the offset.

    Raises
    ------
    StructureError
        If the first leg would stand still.
    """
    first = 1.0 + per_v * (first_leg(planned).level_v - planned.offset_v) if planned.legs else 1.0
    if not first > 0.0:
        raise StructureError(
            f"campaign {planned.name}: expected legs at which the engine turns, found a first leg at "
            f"{first:.2g} of the working speed; check level_v and the line from volts to speed, --rpm-per-volt."
        )
    return {
        share / first: replace(level, set_point_per_v=abs(per_v) / share)
        for share, level in STAN_TUG_NOISE_AT_SPEEDS.items()
    }


def _values_of(
    chosen: Structure,
    vessel: Vessel | None,
    known: Mapping[str, Prior],
    freed: Sequence[str],
    values: Sequence[tuple[str, float]],
) -> dict[str, float]:
    """Return the values that are assumed: what is stated, what the vessel file expects, the structure's own."""
    expected = {} if vessel is None else expected_from_vessel(chosen, vessel, stated_working_point(vessel))
    expected = {name: one for name, one in expected.items() if name not in freed}
    return ship_before_test(chosen, expected | dict(known), dict(values)).by_name


def _planned(chosen: Structure, campaign: Campaign, ship: _Ship) -> list[tuple[Structure, FrequencyResponse]]:
    """Return the structure with the planned lines from its input to its outputs, at each working point.

    Raises
    ------
    StructureError
        If the lines of a campaign do not give these.
    """
    loop = structure(closed_loop_of(ship.vessel))
    tests = [(chosen, loop, planned_response(campaign, ship.noise))] if campaign.sines or not campaign.legs else []
    tests += [
        (leg.structure(chosen), leg.structure(loop), leg.response)
        for leg in planned_legs(campaign, ship.noise_of_legs, rises=ship.slope_rpm_per_v > 0.0)
    ]
    return [(at_leg, _from_input(at_leg, loop_there, closed)) for at_leg, loop_there, closed in tests]


def _from_input(chosen: Structure, loop: Structure, closed: FrequencyResponse) -> FrequencyResponse:
    """Return planned lines from a structure's input to its outputs, of those from the set point."""
    responses = {"n_set": closed}
    if chosen.inputs in (("e",), ("M_s",)):
        governor, core = open_loop(expected_response(closed.of_outputs("n", "M_s"), loop))
        responses |= {"e": governor, "M_s": core}
    response = responses.get(chosen.input) if len(chosen.inputs) == 1 else None
    if response is None or not set(chosen.outputs) <= set(response.outputs):
        raise StructureError(
            f"structure {chosen.name} goes from {', '.join(chosen.inputs)} to {', '.join(chosen.outputs)}; the noise "
            f"is known of {', '.join(closed.outputs)} under the set point only. Give a recording of the other channels "
            "with --from."
        )
    return response
