"""Text with one row a sample."""

import io
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from shaftprint.errors import RecordingError
from shaftprint.files import written_whole
from shaftprint.recording._recording import Channel
from shaftprint.recording.writers._shared_clock import on_one_clock

_BLOCK = 100_000

# Twelve digits keep 16-bit counts and microseconds of a day-long test.
_FORMAT = "%.12g"


def write_csv(
    path: str | Path,
    channels: Iterable[Channel],
    *,
    delimiter: str = ",",
    decimal: str = ".",
    overwrite: bool = False,
) -> None:
    """Write channels as text: ``time [s],M_s [V],...`` and one row a sample.

    Parameters
    ----------
    path
        The file to write, whole or not at all.
    channels
        Channels on one clock.
    delimiter
        What stands between two columns.
    decimal
        Decimal point or comma.
    overwrite
        Whether a file of that name may be replaced.

    Raises
    ------
    RecordingError
        If the clocks differ, delimiter and decimal sign are equal, a title contains the delimiter, or
        the file cannot be written.
    """
    path = Path(path)
    found = on_one_clock(path, channels)
    titles = ["time [s]", *(f"{channel.name} [{channel.unit}]" for channel in found)]
    if delimiter == decimal or any(delimiter in title for title in titles):
        raise RecordingError(f'{path}: expected a delimiter found in no number or title, found "{delimiter}".')
    try:
        with written_whole(path, overwrite=overwrite) as part, part.open("w", encoding="utf-8", newline="\n") as file:
            file.write(delimiter.join(titles) + "\n")
            for start in range(0, found[0].count, _BLOCK):
                stop = min(start + _BLOCK, found[0].count)
                columns = [found[0].time_s(start, stop), *(channel.values(start, stop) for channel in found)]
                block = io.StringIO()
                np.savetxt(block, np.column_stack(columns), fmt=_FORMAT, delimiter=delimiter)
                text = block.getvalue()
                file.write(text if decimal == "." else text.replace(".", decimal))
    except OSError as error:
        raise RecordingError(f"{path}: the file cannot be written: {error}") from None
