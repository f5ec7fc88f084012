"""``shaftprint sensitivity``: what each parameter does to the response."""

from __future__ import annotations

import math
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

import click

from shaftprint.cli._options import SettingsPath
from shaftprint.cli._terminal import answer
from shaftprint.cli.output._results_options import Results, results_options
from shaftprint.escape import plain_name
from shaftprint.late import late

with late():
    from shaftprint.catalogue._own_structure import TypedName, chosen_structures
    from shaftprint.catalogue._thesis_figures import thesis_families
    from shaftprint.report.charts._chart import Chart
    from shaftprint.report.charts._pictures import save_chart
    from shaftprint.report.figures import _sensitivity
    from shaftprint.spectra._frequency_response import FrequencyResponse
    from shaftprint.spectra._open_loop import open_loop
    from shaftprint.survey._measurement import measure
    from shaftprint.survey._trial import load_trial


if TYPE_CHECKING:
    Drawings: TypeAlias = dict[str, partial[Chart]]

ALL_OF_THE_THESIS = "THESIS"


def ascending(context: click.Context, parameter: click.Parameter, span: tuple[float, float]) -> tuple[float, float]:
    """Return the span of frequencies as it was given.

    Raises click.BadParameter if it is not ascending.
    """
    if not 0.0 < span[0] < span[1] < math.inf:
        raise click.BadParameter(f"expected ascending frequencies above 0 rad/s, found {span[0]:g} and {span[1]:g}.")
    return span


@click.command("sensitivity")
@click.argument("name", metavar="STRUCTURE")
@click.option(
    "--format", "suffix", type=click.Choice(["svg", "png", "pdf"]), default="svg", show_default=True,
    help="Kind of picture.",
)  # fmt: skip
@click.option(
    "--between",
    "span",
    type=float,
    nargs=2,
    metavar="LOWEST HIGHEST",
    default=(0.01, 300.0),
    show_default=True,
    callback=ascending,
    help="Frequencies to draw [rad/s]; not for the figures of the thesis.",
)
@click.option(
    "--recording",
    type=click.Path(path_type=Path),
    help="Recording whose measured responses are drawn into figures 4.4 to 4.8 of the thesis; needs --vessel and "
    "--campaign.",
)
@click.option("--vessel", type=SettingsPath("vessel", "stan-tug-1205"), help="Vessel file of the recording.")
@click.option("--campaign", type=SettingsPath("campaign", "thesis"), help="Campaign file of the recording.")
@results_options("Folder for the figures.")
def command(
    name: TypedName,
    suffix: str,
    span: tuple[float, float],
    recording: Path | None,
    vessel: str | None,
    campaign: str | None,
    results: Results,
) -> None:
    """Draw the effect of each parameter of a structure on its response.

    One figure an output and input: the Bode families of STRUCTURE with each free parameter varied between its bounds. A
    STRUCTURE such as my_ship.py:my_loop is one in a file of your own, which is Python and is run. With `thesis` for
    STRUCTURE, the sensitivity figures of the thesis (4.2 to 4.8, B.1 to B.4, D.1).
    """
    of_the_thesis = name.upper() == ALL_OF_THE_THESIS
    if recording is not None and not of_the_thesis:
        raise click.UsageError("--recording goes with the figures of the thesis only: shaftprint sensitivity thesis.")
    responses = _measured(recording, vessel, campaign)
    drawings = _of_the_thesis(responses) if of_the_thesis else _of_structure(name, span)
    with results.folder("sensitivity") as folder, results.progress() as steps:
        steps.begin("Drawing", total=float(len(drawings)))
        for stem, draw in drawings.items():
            save_chart(draw(), folder / f"{stem}.{suffix}")
            steps.advance(1.0)
    for stem in drawings:
        answer(results.output / f"{stem}.{suffix}")


def _of_structure(name: TypedName, span: tuple[float, float]) -> Drawings:
    (chosen,) = chosen_structures([name])
    drawings = {}
    for output, cause in chosen.channels:
        stem = f"{chosen.name}_{output}" + (f"_{cause}" if len(chosen.inputs) > 1 else "")
        drawings[plain_name(stem)] = partial(
            _sensitivity.sensitivity_chart, chosen, output=output, cause=cause, span_rad_s=span
        )
    return drawings


def _measured(recording: Path | None, vessel: str | None, campaign: str | None) -> dict[str, FrequencyResponse]:
    """Return the open-loop responses of a recording as ``Family.data`` names them; none without a recording.

    Raises click.UsageError if recording, vessel and campaign are not stated together.
    """
    stated = {"--recording": recording, "--vessel": vessel, "--campaign": campaign}
    missing = [option for option, value in stated.items() if value is None]
    if len(missing) == len(stated):
        return {}
    if recording is None or vessel is None or campaign is None:
        raise click.UsageError(f"Measured responses need {', '.join(stated)}; missing: {', '.join(missing)}.")
    governor, core = open_loop(measure(recording, load_trial(vessel, campaign)).spectra.response)
    return {"governor": governor, "core": core}


def _of_the_thesis(responses: dict[str, FrequencyResponse]) -> Drawings:
    return {
        f"figure_{family.figure}": partial(
            _sensitivity.sensitivity_chart,
            family.structure,
            output=family.output,
            vary=family.vary,
            data=responses.get(family.data or ""),
        )
        for family in thesis_families()
    }
