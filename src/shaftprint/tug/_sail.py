"""Sailing: a voyage through the measurement chain into a raw logger file."""

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path

from shaftprint.arguments import refusing_none
from shaftprint.campaign._campaign import Campaign
from shaftprint.campaign._lever_course import LeverCourse
from shaftprint.errors import RecordingError, SettingsError
from shaftprint.files import reason, written_whole
from shaftprint.notebook._progress import cell_bar
from shaftprint.recording._writer import RecordingWriter
from shaftprint.tug._crew import Crew
from shaftprint.tug._truth import Truth, truth_path, truth_text
from shaftprint.tug._tug import Tug
from shaftprint.tug.plant._clutch import declutched
from shaftprint.tug.plant._disturbance import Disturbance
from shaftprint.tug.plant._voyage import voyage
from shaftprint.vessel._vessel import Vessel

CHUNK = 262_144
"""Samples in one compressed block of the container: no block is copied."""


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
    try:
        with (
            written_whole(truth_path(path), overwrite=overwrite) as part,
            RecordingWriter(path, attributes={"vessel": vessel.name}, overwrite=overwrite) as writer,
        ):
            _record(crew, tug, vessel, campaign, writer, progress or cell_bar("Simulating the test"))
            truth = crew.truth()
            part.write_text(truth_text(truth), encoding="utf-8")
    except OSError as error:
        raise RecordingError(f"{path}: the recording cannot be written: {reason(error)}") from None
    return truth


def _record(
    crew: Crew,
    tug: Tug,
    vessel: Vessel,
    campaign: Campaign,
    writer: RecordingWriter,
    progress: Callable[[float], None],
) -> None:
    """Sail and write; the sensors and the file work in a second thread while the ship sails on."""
    crew.declare(writer)
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
    done = 0
    waiting: Future[None] | None = None
    with ThreadPoolExecutor(max_workers=1) as second_thread:
        for stretch in stretches:
            if waiting is not None:
                waiting.result()
            waiting = second_thread.submit(crew.write, writer, declutched(stretch, out_s) if out_s else stretch)
            done += stretch.time_s.size
            progress(done / crew.samples)
    if waiting is not None:
        waiting.result()
