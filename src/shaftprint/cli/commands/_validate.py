"""``shaftprint validate``: a model against chirps and steps that it was not identified from."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import click

from shaftprint.cli._after_test import reach_of
from shaftprint.cli._command_group import end_with_no
from shaftprint.cli._drive_judge import validate_on_the_bench
from shaftprint.cli._drive_options import drive_option, expect_not_given, only_recording
from shaftprint.cli._fit_options import fit_options
from shaftprint.cli._known_values import named_variable
from shaftprint.cli._next import free, plan_after, print_next
from shaftprint.cli._option_sections import SectionedCommand
from shaftprint.cli._options import DEFAULT_HELP, NEEDED_BESIDE_DRIVE, OWN_FILE_HELP, campaign_option, vessel_option
from shaftprint.cli._terminal import echo, is_detailed, print_findings, say
from shaftprint.cli.output._fingerprint_file import fingerprint_at
from shaftprint.cli.output._json import give
from shaftprint.cli.output._output_folder import force_option, output_folder
from shaftprint.cli.output._progress import no_progress_option, progress
from shaftprint.cli.output._tables import print_table, print_tables
from shaftprint.late import late

with late():
    import numpy as np

    from shaftprint.catalogue._own_structure import TypedName
    from shaftprint.fingerprint._model import structure_to_use
    from shaftprint.report._validation_pictures import write_validations
    from shaftprint.survey._fit_options import FitOptions
    from shaftprint.survey._fits import fit
    from shaftprint.survey._measurement import measure
    from shaftprint.survey._of_vessel import default_structure
    from shaftprint.survey._survey import settings_by_name
    from shaftprint.survey._trial import Trial, load_trial
    from shaftprint.survey._validate import Asked, validate_fingerprint
    from shaftprint.tables._validation import excerpt_name, misfit_table, models_table, step_number_table
    from shaftprint.validation._foreign import ForeignModel
    from shaftprint.validation._model import identified_model
    from shaftprint.validation._thesis_models import thesis_models
    from shaftprint.validation._validation import Validation


@click.command(
    "validate",
    cls=SectionedCommand,
    example="shaftprint validate log.csv --vessel mine.toml --campaign test.toml --fingerprint result",
    sections={
        NEEDED_BESIDE_DRIVE: ("--vessel", "--campaign", "--fingerprint", "--drive"),
        "Which records": ("--record", "--used", "--allow-in-sample"),
        "Model": ("--structure", "--model", "--model-variable", "--linear", "--linear-torque", "--thesis-sets"),
        "Fit, without a fingerprint": (
            "--prior", "--free", "--hold", "--mode", "--unweighted", "--starts", "--seed",
        ),
    },
)  # fmt: skip
@click.argument("recordings", metavar="RECORDING...", nargs=-1, required=True, type=click.Path(path_type=Path))
@drive_option
@vessel_option
@campaign_option
@click.option(
    "--fingerprint",
    type=click.Path(path_type=Path),
    help="Fingerprint to validate, a JSON file or its folder; without it one is identified from the sines first.",
)
@click.option(
    "--structure",
    metavar="NAME",
    help=f"Model structure: {OWN_FILE_HELP}. The fingerprint's, or {DEFAULT_HELP}, by default.",
)
@click.option(
    "--model",
    "foreign",
    type=click.Path(path_type=Path),
    help="FMU of another program (FMI 2 or 3, co-simulation) to validate instead. It is code, and is run: name none "
    "that you do not trust.",
)
@click.option(
    "--model-variable",
    "variables",
    metavar="ROLE=NAME",
    type=named_variable,
    multiple=True,
    help="Variable of --model for set_point, speed (the engine's) or torque (the shaft's), with its unit where the FMU "
    "has none, such as 'speed=w [rad/s]'; may be repeated.",
)
@click.option(
    "--record",
    "records",
    multiple=True,
    metavar="NAME",
    help="Chirp or staircase to validate on; by default all staircases and the chirp with the widest sweep.",
)
@click.option(
    "--used", multiple=True, metavar="NAME", help="Test that the model was identified from and that is not to be used."
)
@click.option("--allow-in-sample", is_flag=True, help="Show records of the identification too; they do not count.")
@click.option(
    "--linear",
    is_flag=True,
    help="Validate the model for small signals, although the fingerprint has the line with its limits.",
)
@click.option("--linear-torque", is_flag=True, help="Leave the torque linear in the speed, as the thesis did.")
@click.option(
    "--thesis-sets", is_flag=True, help="Put CL4, CL3, OL1+OL5, OL1+OL4 and the benchmark of the thesis beside."
)
@fit_options
@click.option("-o", "--output", type=click.Path(path_type=Path), help="Folder for the figures.")
@force_option
@no_progress_option
def command(
    recordings: tuple[Path, ...],
    drive_file: Path | None,
    vessel: str,
    campaign: str,
    fingerprint: Path | None,
    structure: TypedName | None,
    foreign: Path | None,
    variables: tuple[tuple[str, tuple[str, str]], ...],
    records: tuple[str, ...],
    used: tuple[str, ...],
    allow_in_sample: bool,
    linear: bool,
    linear_torque: bool,
    thesis_sets: bool,
    options: FitOptions,
    output: Path | None,
    force: bool,
    no_progress: bool,
) -> None:
    """Validate a model on chirps and steps that it was not identified from.

    Prints for each stretch how much of the motion the model misses beyond noise, the delay that is left,
    overshoot, rise and settling of steps beside those that the model predicts, and whether the model passes. A
    fingerprint that has the line with its limits is validated with them, each stretch by a fit without it.
    --record, --used, --prior, --free and --hold may be repeated. --model holds an FMU of another program
    against the recording instead. With --drive, the model of --fingerprint is
    held against other records of the drive.
    """
    if drive_file is not None:
        expect_not_given(
            "foreign",
            "variables",
            "records",
            "used",
            "allow_in_sample",
            "linear_torque",
            "thesis_sets",
            "output",
        )
        validate_on_the_bench(recordings, drive_file, fingerprint, structure, no_progress=no_progress)
        return
    if foreign is None and variables:
        raise click.UsageError("--model-variable is of a model that is named by --model; name it too.")
    if foreign is not None and (fingerprint is not None or structure is not None):
        raise click.UsageError("--model is validated instead of --fingerprint and --structure: leave those out.")
    recording = only_recording(recordings)
    trial = load_trial(vessel, campaign)
    kept = None if fingerprint is None else fingerprint_at(fingerprint)
    if kept is None:
        structures = options.structures([structure or default_structure(trial.vessel, trial.campaign)], trial.vessel)
    else:
        structures = options.holding([structure_to_use(structure, kept)])
    with progress(hidden=no_progress) as steps:
        measurement = measure(recording, trial, mode=options.mode, progress=steps)
        asked = Asked(records=records, used=used, allow_in_sample=allow_in_sample, seed=options.seed)
        if foreign is not None:
            point = measurement.signals.working_point
            other = ForeignModel(path=foreign, working_point=point, variables=dict(variables))
            first = asked.validated(
                other.model, measurement.signals, trial, quadratic_propeller=False, predict=other.predict
            )
        elif kept is not None:
            first = validate_fingerprint(
                kept,
                measurement,
                trial,
                asked,
                structure=structures[0],
                linear=linear or structure is not None,
                quadratic_propeller=not linear_torque,
                progress=steps,
            )
        else:
            settings = settings_by_name(structures, measurement, trial, options.settings(structures))
            rng = np.random.default_rng(options.seed)
            fitted = fit(structures, measurement, settings=settings, rng=rng, progress=steps)[0]
            model = identified_model(fitted)
            first = asked.validated(model, measurement.signals, trial, quadratic_propeller=not linear_torque)
        steps.begin("Validating the sets of the thesis")
        beside = [
            asked.validated(one, measurement.signals, trial, quadratic_propeller=not linear_torque)
            for one in (thesis_models() if thesis_sets else ())
        ]
        validations = [first, *beside]
    if output is not None:
        with output_folder(output, of="validate", force=force) as folder, progress(hidden=no_progress) as steps:
            write_validations(folder, validations, progress=steps)
    print_validation(first)
    if thesis_sets:
        print_table(models_table(validations))
    if output is not None:
        echo(f"Figures: {output}")
    _print_next(recording, vessel, campaign, fingerprint, trial, first)
    if first.outcome == "fails":
        end_with_no()


def _print_next(
    recording: Path, vessel: str, campaign: str, fingerprint: Path | None, trial: Trial, found: Validation
) -> None:
    """Print the next command: what identifies, what the model lacks where it fails, or the next test."""
    files = (recording, "--vessel", vessel, "--campaign", campaign)
    if fingerprint is None:
        print_next("identify", *files, "-o", free("result"))
    elif found.outcome == "fails":
        print_next("limits", *files)
    else:
        print_next(*plan_after(fingerprint, vessel, trial.vessel, reach_of(campaign, trial.campaign)))


def print_validation(validation: Validation) -> None:
    """Print the verdict, every excerpt that says something, the numbers of its steps, and how it was found."""
    give("misfits", {excerpt_name(c): c.misfits for c in validation.comparisons})
    print_findings(f"Validation: {validation.headline}", validation.sentences, is_answer=True)
    told = [one for one in validation.comparisons if one.outcome != "undecided" or one.excerpt.in_sample]
    hidden = 0 if is_detailed() else len(validation.comparisons) - len(told)
    shown = replace(validation, comparisons=tuple(told)) if hidden else validation
    if shown.comparisons:
        print_tables([misfit_table(shown), step_number_table(shown)])
    if hidden:
        say(
            f"{hidden} {'excerpt' if hidden == 1 else 'excerpts'} of which noise hides how well the model meets "
            f"{'it' if hidden == 1 else 'them'}: --verbose.\n"
        )
    print_findings("How this was found", validation.findings)
