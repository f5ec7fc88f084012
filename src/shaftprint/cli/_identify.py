"""``shaftprint identify``: from a recording to a fingerprint."""

from dataclasses import replace
from pathlib import Path

import click

from shaftprint.cli._chain import fingerprint_of, fit, known_beforehand, measure, response_of
from shaftprint.cli._fingerprint_tables import print_fingerprint
from shaftprint.cli._fit_tables import print_fits
from shaftprint.cli._inputs import campaign_option, load_trial, structure_sources, vessel_option
from shaftprint.cli._known_values import named_prior, named_value
from shaftprint.cli._output_folder import force_option, output_folder
from shaftprint.cli._own_structure import OWN_FILE_HELP, chosen_structures
from shaftprint.cli._progress import no_progress_option, progress
from shaftprint.cli._results import where, write_results
from shaftprint.errors import StructureError
from shaftprint.identify import MaximumLikelihood, Prior, Settings, Unweighted
from shaftprint.models import Structure
from shaftprint.signals import Mode


@click.command("identify")
@click.argument("recording", type=click.Path(path_type=Path))
@vessel_option
@campaign_option
@click.option(
    "--structure",
    "names",
    multiple=True,
    default=("GAUGE-CLOSED",),
    show_default=True,
    metavar="NAME",
    help=f"Model structure: {OWN_FILE_HELP}. The fingerprint is of the first, others are fitted beside it.",
)
@click.option(
    "--prior",
    "priors",
    metavar="NAME=MEAN+-STD",
    type=named_prior,
    multiple=True,
    help="What is known of a parameter beforehand, such as g=0+-0.1; instead of what the vessel file knows.",
)
@click.option(
    "--free",
    "freed",
    metavar="NAME",
    multiple=True,
    help="Take nothing as known of a parameter, such as tau_up, of which the vessel file knows the inertia.",
)
@click.option(
    "--hold", "held", metavar="NAME=VALUE", type=named_value, multiple=True, help="Hold a parameter at a value."
)
@click.option(
    "--mode",
    type=click.Choice(["shaftprint", "thesis"]),
    default="shaftprint",
    show_default=True,
    help="How signals and lines are prepared; the thesis' way is there to compare.",
)
@click.option("--unweighted", is_flag=True, help="Weigh all lines alike, as the thesis did; intervals are wider.")
@click.option("--starts", type=click.IntRange(min=1), default=50, show_default=True, help="Starts of each search.")
@click.option("--seed", type=click.IntRange(min=0), default=1, show_default=True, help="Seed of the starts.")
@click.option("-o", "--output", required=True, type=click.Path(path_type=Path), help="Folder for the results.")
@force_option
@no_progress_option
def command(
    recording: Path,
    vessel: str,
    campaign: str,
    names: tuple[str, ...],
    priors: tuple[tuple[str, Prior], ...],
    freed: tuple[str, ...],
    held: tuple[tuple[str, float], ...],
    mode: Mode,
    unweighted: bool,
    starts: int,
    seed: int,
    output: Path,
    force: bool,
    no_progress: bool,
) -> None:
    """Identify the fingerprint from a recording.

    Writes the fingerprint as JSON, the figures and a report into a folder, and prints the tables.
    --structure, --prior, --free and --hold may be repeated.
    """
    structures = _structures(names, dict(held))
    _expect_free(freed, structures)
    trial = load_trial(vessel, campaign)
    trial = replace(trial, sources=(*trial.sources, *structure_sources(names)))
    weighting = Unweighted() if unweighted else MaximumLikelihood()
    with output_folder(output, force=force) as folder, progress(hidden=no_progress) as steps:
        measurement = measure(recording, trial, mode=mode, steps=steps)
        settings = {}
        for chosen in structures:
            response_of(chosen, measurement.responses)
            given = _given(chosen, structures, dict(priors))
            known = known_beforehand(chosen, trial.vessel, measurement.signals, given)
            settings[chosen.name] = Settings(
                weighting=weighting,
                starts=starts,
                priors={name: prior for name, prior in known.items() if name not in freed},
            )
        fits = fit(structures, measurement, settings=settings, seed=seed, steps=steps)
        steps.begin("Finding the intervals")
        fingerprint = fingerprint_of(fits[0], measurement, trial)
        write_results(folder, recording, trial, measurement, fits, fingerprint, steps=steps)
    print_fingerprint(fingerprint)
    if len(fits) > 1:
        print_fits("All structures", fits)
    click.echo(where(output))


def _structures(names: tuple[str, ...], held: dict[str, float]) -> tuple[Structure, ...]:
    """Return the structures with what is held in those that have it; each value must be of use in one."""
    chosen = chosen_structures(names)
    unused = [name for name in held if not any(name in found.names for found in chosen)]
    if unused:
        raise StructureError(
            f"--hold {', '.join(unused)}: expected a parameter of {', '.join(found.name for found in chosen)}, "
            f"which have {', '.join(sorted({name for found in chosen for name in found.names}))}."
        )
    return tuple(
        found.held_at(**{name: value for name, value in held.items() if name in found.names}) for found in chosen
    )


def _expect_free(freed: tuple[str, ...], structures: tuple[Structure, ...]) -> None:
    anywhere = sorted({parameter.name for found in structures for parameter in found.free})
    unknown = [name for name in freed if name not in anywhere]
    if unknown:
        raise StructureError(f"--free {', '.join(unknown)}: expected a free parameter, one of {', '.join(anywhere)}.")


def _given(chosen: Structure, structures: tuple[Structure, ...], given: dict[str, Prior]) -> dict[str, Prior]:
    """Return the priors that concern a structure; one that no structure has is passed on, to be refused."""
    free = {parameter.name for parameter in chosen.free}
    anywhere = {parameter.name for found in structures for parameter in found.free}
    return {name: prior for name, prior in given.items() if name in free or name not in anywhere}
