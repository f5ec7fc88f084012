"""Sailing: a voyage through the measurement chain into a raw logger file."""

from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import TypeVar

from shaftprint.arguments import refusing_none
from shaftprint.campaign._campaign import Campaign
from shaftprint.campaign._lever_course import LeverCourse
from shaftprint.errors import RecordingError, SettingsError
from shaftprint.files import reason, written_whole
from shaftprint.notebook._progress import cell_bar
from shaftprint.notebook._shown import Shown
from shaftprint.recording._writer import RecordingWriter
from shaftprint.tug._crew import Crew
from shaftprint.tug._truth import Truth, truth_path, truth_text
from shaftprint.tug._tug import Tug
from shaftprint.tug.plant._clutch import declutched
from shaftprint.tug.plant._disturbance import Disturbance
from shaftprint.tug.plant._voyage import Stretch, voyage
from shaftprint.vessel._vessel import Vessel

CHUNK = 262_144
"""Samples in one compressed block of the container: no block is copied."""

SomeTruth = TypeVar("SomeTruth", bound=Shown)
"""The truth of one line or of both."""


@refusing_none(SettingsError)
def sail(
    vessel: Vessel,
    campaign: Campaign,
    path: str | Path,
    *,
    tug: Tug | None = None,
    seed: int,
    overwrite: bool = False,
    progress: Callable[[float], None] | None = None,
) -> Truth:
    """Simulate a campaign and write the raw recording as a logger would, with its truth in a file beside it.

    Memory does not grow with the length of the campaign. The same seed gives the same bytes.

    Parameters
    ----------
    vessel, campaign
        The installation and what is asked of it.
    path
        Recording to write, in the native container; the truth goes to ``NAME.truth.json`` beside it. Both are written
        whole or not at all.
    tug
        The truth with the sizes of its noise; the reference truth when not given.
    seed
        Seed of all randomness.
    overwrite
        Whether existing files may be replaced.
    progress
        Called with the share of the campaign that is done, 0 to 1; a line below the cell of a notebook where it is not
        given.

    Returns
    -------
    truth
        What was put into the recording.

    Raises
    ------
    SettingsError
        If the truth is not physical.
    RecordingError
        If a file exists and may not be replaced, or cannot be written.
    """
    tug = Tug.stan_tug_1205() if tug is None else tug
    crew = Crew(tug, vessel, campaign, seed=seed)
    stretches = voyage(
        tug,
        vessel,
        campaign,
        step_s=1.0 / crew.rate_hz,
        steps=crew.samples,
        chunk=CHUNK,
        disturbance=Disturbance(tug.noise, 1.0 / crew.rate_hz, crew.process),
    )
    out_s = campaign.declutched_s if isinstance(campaign, LeverCourse) else ()
    return recorded(
        path,
        [crew],
        ((declutched(stretch, out_s) if out_s else stretch,) for stretch in stretches),
        truth_of=crew.truth,
        vessel=vessel.name,
        overwrite=overwrite,
        progress=progress or cell_bar("Simulating the test"),
    )


def recorded(
    path: str | Path,
    crews: Sequence[Crew],
    stretches: Iterable[tuple[Stretch, ...]],
    *,
    truth_of: Callable[[], SomeTruth],
    vessel: str,
    overwrite: bool,
    progress: Callable[[float], None] | None,
) -> SomeTruth:
    """Write what crews measure, each of its own line, into one recording with the truth beside it; return the truth.

    Sensors and file work in a second thread while the ship sails on.
    """
    done, waiting = 0, None
    try:
        with (
            written_whole(truth_path(path), overwrite=overwrite) as part,
            RecordingWriter(path, attributes={"vessel": vessel}, overwrite=overwrite) as writer,
        ):
            for crew in crews:
                crew.declare(writer)

            def write(measured: tuple[Stretch, ...]) -> None:
                for crew, stretch in zip(crews, measured, strict=True):
                    crew.write(writer, stretch)

            with ThreadPoolExecutor(max_workers=1) as second_thread:
                for of_lines in stretches:
                    if waiting is not None:
                        waiting.result()
                    waiting = second_thread.submit(write, of_lines)
                    done += of_lines[0].time_s.size
                    if progress is not None:
                        progress(done / crews[0].samples)
            if waiting is not None:
                waiting.result()
            truth = truth_of()
            part.write_text(truth_text(truth), encoding="utf-8")
    except OSError as error:
        raise RecordingError(f"{path}: the recording cannot be written: {reason(error)}") from None
    return truth
