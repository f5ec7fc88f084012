"""``shaftprint predict``: what a test would find, before it is made."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import click
import numpy as np

from shaftprint.campaign._campaign import Campaign, load_campaign
from shaftprint.catalogue._bent_line import with_bend
from shaftprint.catalogue._own_structure import TypedName, chosen_structures
from shaftprint.catalogue._shipped import shipped_structure
from shaftprint.cli._drive_judge import predict_on_the_bench
from shaftprint.cli._drive_options import drive_option, expect_not_given
from shaftprint.cli._known_values import hold_option, named_value, prior_option, rpm_per_volt_option
from shaftprint.cli._limit_uses import print_limit_uses
from shaftprint.cli._options import DEFAULT_HELP, NAMES, OWN_FILE_HELP, campaign_option
from shaftprint.cli._planned_pairs import planned_pairs
from shaftprint.cli._prediction_tables import print_prediction
from shaftprint.cli._ship_before_test import ShipBeforeTest, assumed_ship, recorded_ship
from shaftprint.cli._terminal import say
from shaftprint.cli._vessel_file import print_disagreements
from shaftprint.cli.output._progress import no_progress_option
from shaftprint.design.inputs._known_ship import ship_before_test
from shaftprint.design.operation._expected import expected_operation, inputs_left_out
from shaftprint.design.operation._limit_use import limit_uses, stated_limits
from shaftprint.errors import StructureError
from shaftprint.identify.likelihood._known import expected_from_vessel
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.identify.prediction._accuracy import predict_joint_accuracy
from shaftprint.identify.prediction._identifiability import identifiability
from shaftprint.identify.prediction._predicted_intervals import predict_joint_intervals
from shaftprint.models._structure import Structure
from shaftprint.spelling import meant
from shaftprint.survey._expected_of_ship import expected_of_ship
from shaftprint.survey._fits import stated_working_point
from shaftprint.survey._of_vessel import default_structure, of_vessel
from shaftprint.vessel._vessel import Vessel, load_vessel

# Where the sensitivity of a structure is taken; what can be found does not depend on it.
SEED = 1


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
@click.option("--structure", "name", metavar="NAME", help=f"Structure: {OWN_FILE_HELP}; {DEFAULT_HELP} by default.")
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
    planned = load_campaign(campaign)
    (chosen,) = chosen_structures([name or default_structure(known, planned)])
    chosen = (chosen if known is None else of_vessel(chosen, known)).held_at(**dict(held))
    alone = chosen
    if len({leg.level_v for leg in planned.legs} | ({planned.offset_v} if planned.sines else set())) > 1:
        chosen = with_bend(chosen)
    _expect_free(freed, chosen)
    if recording is not None:
        if known is None:
            raise click.UsageError("--from needs --vessel, which says what is in the recording.")
        ship = recorded_ship(recording, known, recorded or planned, chosen, planned, no_progress=no_progress)
    else:
        ship = assumed_ship(known, rpm_per_volt, chosen, planned)
    assumed_priors = {
        parameter: prior for parameter, prior in (dict(ship.priors) | dict(priors)).items() if parameter not in freed
    }
    assumed = _values_of(chosen, ship.vessel, assumed_priors, freed, values)
    pairs = planned_pairs(chosen, planned, ship)
    possible = identifiability(alone, rng=np.random.default_rng(SEED))
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
    planned: Campaign,
    vessel: Vessel,
    ship: ShipBeforeTest,
    priors: Mapping[str, Prior],
    values: Sequence[tuple[str, float]],
) -> None:
    """Print where the campaign would leave the limits of the vessel file, and how near it comes to each.

    Whatever structure the test is for, it moves the whole closed loop.
    """
    loop = of_vessel(shipped_structure(default_structure(vessel, planned)), vessel)
    assumed = _values_of(loop, vessel, priors, (), [one for one in values if one[0] in loop.names])
    operation = expected_operation(planned, vessel, assumed, slope_rpm_per_v=ship.slope_rpm_per_v)
    print_limit_uses(limit_uses(operation, stated_limits(vessel)), is_expected=True)
    for name in inputs_left_out(planned, vessel):
        say(f"What {name} does to engine and gauge is not in these limits: keep room for it.")


def _expect_free(freed: tuple[str, ...], chosen: Structure) -> None:
    free = [parameter.name for parameter in chosen.free]
    unknown = [name for name in freed if name not in free]
    if unknown:
        expected = f"expected a free parameter, one of {', '.join(free)}.{meant(unknown[0], free)}"
        raise StructureError(f"--free {', '.join(unknown)}: {expected}")


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
    of_ship = {} if vessel is None else expected_of_ship(chosen, vessel)
    stated = {name: value for name, value in of_ship.items() if name not in expected} | dict(values)
    return ship_before_test(chosen, expected | dict(known), stated).by_name
