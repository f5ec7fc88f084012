"""``shaftprint limits``: which limits a line has, and how large they are."""

from collections.abc import Sequence
from pathlib import Path

import click
import numpy as np

from shaftprint.cli._chain import measure
from shaftprint.cli._fingerprint_tables import print_findings
from shaftprint.cli._inputs import campaign_option, load_trial, vessel_option
from shaftprint.cli._numbers import with_uncertainty
from shaftprint.cli._progress import no_progress_option, progress
from shaftprint.cli._tables import print_table
from shaftprint.identify import Identification, assess
from shaftprint.nonlinearity import detect
from shaftprint.time_domain import (
    LimitedModel,
    NonlinearFit,
    NonlinearSettings,
    RecordFit,
    identify_nonlinear,
    structure_for,
)

AUTOMATIC = "auto"
DEADBAND = (
    "A deadband comes out too narrow where disturbances of the speed are as large as it, for they carry the error out "
    "of it: the width that inspect finds on the measured speed does not have this error."
)


@click.command("limits")
@click.argument("recording", type=click.Path(path_type=Path))
@vessel_option
@campaign_option
@click.option(
    "--limits",
    "wanted",
    default=AUTOMATIC,
    show_default=True,
    metavar="NAMES",
    help="Limits to fit, such as torque,rate: of torque, rate, deadband and smoke; auto looks which ones there are.",
)
@click.option(
    "--record",
    "records",
    multiple=True,
    metavar="NAME",
    help="Staircase or chirp to fit; by default all. Leave some out to validate on them.",
)
@click.option("--starts", type=click.IntRange(min=1), default=50, show_default=True, help="Starts of the search.")
@click.option("--seed", type=click.IntRange(min=0), default=1, show_default=True, help="Seed of the starts.")
@no_progress_option
def command(
    recording: Path,
    vessel: str,
    campaign: str,
    wanted: str,
    records: tuple[str, ...],
    starts: int,
    seed: int,
    no_progress: bool,
) -> None:
    """Find which limits a line has, and their levels and rates with uncertainty.

    Sines that no limit reaches, staircases and chirps are fitted together, in one likelihood: the line with its torque
    limit, rate limit, deadband or smoke limiter, and everything that the sines tell of it. --record may be repeated.
    """
    trial = load_trial(vessel, campaign)
    with progress(hidden=no_progress) as steps:
        measurement = measure(recording, trial, mode="shaftprint", steps=steps)
        signals = measurement.signals
        findings: tuple[str, ...] = ()
        if wanted == AUTOMATIC:
            steps.begin("Looking for nonlinearities")
            found = detect(signals, trial.campaign, trial.vessel)
            findings = (found.sentence, *(finding.evidence for finding in found.findings))
            if all(finding.kind == "quadratic propeller only" for finding in found.findings):
                print_findings("Nonlinearities", findings)
                return
            model = structure_for(found.findings, trial.vessel, signals.working_point)
        else:
            model = structure_for(_named(wanted), trial.vessel, signals.working_point)
        steps.begin("Fitting the limits")
        fit = identify_nonlinear(
            signals,
            trial.campaign,
            trial.vessel,
            model,
            rng=np.random.default_rng(seed),
            records=records or None,
            settings=NonlinearSettings(starts=starts),
        )
    if findings:
        print_findings("Nonlinearities", findings)
    _print_fit(model, fit)


def _named(wanted: str) -> list[str]:
    return [name.strip() for name in wanted.split(",") if name.strip()]


def _print_fit(model: LimitedModel, fit: NonlinearFit) -> None:
    """Print limits, parameters, FitPercent and how it was found."""
    rows = [
        (number.name, with_uncertainty(number.value, number.std), number.unit, number.meaning) for number in fit.limits
    ]
    print_table(
        f"Limits of the line: {', '.join(model.limits)}", ("symbol", "value +/- 1 std", "unit", "meaning"), rows
    )
    _print_parameters(fit.identification, fit.linear)
    _print_records(fit.identification)
    print_findings("How this was found", _sentences(fit))
    print_findings("Verdict", assess(fit.identification).sentences)


def _print_parameters(found: Identification, linear: Identification) -> None:
    before = {estimate.name: with_uncertainty(estimate.value, estimate.std) for estimate in linear.parameters}
    rows = [
        (e.name, with_uncertainty(e.value, e.std), before.get(e.name, ""), e.unit, "at its bound" if e.at_bound else "")
        for e in found.parameters
    ]
    print_table("Parameters", ("symbol", "value +/- 1 std", "from sines alone", "unit", ""), rows)


def _print_records(found: Identification) -> None:
    rows = [
        (part.record.name, output, f"{part.fit_percent[output]:.2f}", f"{part.fit_ceiling[output]:.2f}")
        for part in found.parts
        if isinstance(part, RecordFit)
        for output in part.fit_percent
    ]
    print_table("Records", ("record", "output", "FitPercent", "perfect model"), rows, numbers=(2, 3))


def _sentences(fit: NonlinearFit) -> Sequence[str]:
    lines = f"Small signals: {', '.join(fit.lines)}." if fit.lines else "No sine is free of the limits."
    left_out = [f"Not in the model: {', '.join(fit.left_out)}."] if fit.left_out else []
    narrow = [DEADBAND] if any(number.name == "d_e" for number in fit.limits) else []
    fragile = [
        f"Not fitted: {stretch.record} from {stretch.begin_s:.0f} to {stretch.end_s:.0f} s, where small disturbances "
        "decide what a limited line does (jump resonance)."
        for stretch in fit.fragile
    ]
    return (
        f"{lines} In time: {', '.join(fit.records)}.",
        f"Of {fit.starts} starts the best {fit.reached[1]} went on, and {fit.reached[0]} of these reached the optimum "
        "that led to this one.",
        *left_out,
        *fragile,
        *narrow,
    )
