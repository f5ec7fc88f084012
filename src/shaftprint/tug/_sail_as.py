"""Sailing into the file format of another logger."""

import shutil
import tempfile
from collections.abc import Callable
from pathlib import Path

from shaftprint.campaign._campaign import Campaign
from shaftprint.choices import NATIVE_ENDINGS
from shaftprint.errors import RecordingError
from shaftprint.files import reason, written_whole
from shaftprint.recording._read import read_recording
from shaftprint.recording.writers._by_ending import expect_known_ending, write_by_ending
from shaftprint.tug._sail import sail
from shaftprint.tug._truth import Truth, truth_path
from shaftprint.tug._tug import Tug
from shaftprint.vessel._vessel import Vessel


def sail_as(
    vessel: Vessel,
    campaign: Campaign,
    path: str | Path,
    *,
    tug: Tug | None = None,
    seed: int,
    overwrite: bool = False,
    progress: Callable[[float], None] | None = None,
    format: str | None = None,
    told: Callable[[str], None] | None = None,
) -> Truth:
    """Sail a campaign as ``sail`` does and write its recording as another logger does.

    ``vessel``, ``campaign``, ``tug``, ``seed``, ``overwrite``, ``progress``: as for ``sail``. ``path``: recording to
    write; its ending is one of ``recording.WRITTEN_ENDINGS``. The truth goes to ``NAME.truth.json`` beside it.
    ``format``: one of ``recording.WRITTEN_FORMATS`` where the ending stands for several. ``told``: is told what the
    format loses, and what was written beside, a sentence each. Raises SettingsError if the truth is not physical;
    RecordingError if the ending is of no format, a file exists and may not be replaced, the format cannot hold channels
    with clocks of their own, or a file cannot be written.
    """
    path = Path(path)
    expect_known_ending(path, format=format)
    if path.suffix.lower() in NATIVE_ENDINGS:
        return sail(vessel, campaign, path, tug=tug, seed=seed, overwrite=overwrite, progress=progress)
    for file in (path, truth_path(path)):
        if file.exists() and not overwrite:
            raise RecordingError(
                f"{file} exists already; choose another name, or replace it: overwrite=True (--force)."
            )
    try:
        with tempfile.TemporaryDirectory(prefix=".shaftprint-", dir=path.parent) as folder:
            native = Path(folder) / "recording.nc"
            truth = sail(vessel, campaign, native, tug=tug, seed=seed, progress=progress)
            with (
                written_whole(truth_path(path), overwrite=overwrite) as part,
                read_recording(native) as recording,
            ):
                shutil.copyfile(truth_path(native), part)
                remarks = write_by_ending(path, recording.channels.values(), overwrite=overwrite, format=format)
    except OSError as error:
        raise RecordingError(f"{path}: the recording cannot be written: {reason(error)}") from None
    if told is not None:
        for remark in remarks:
            told(remark)
    return truth
