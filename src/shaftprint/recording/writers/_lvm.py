"""LabVIEW's measurement text, as its Write To Measurement File writes it: a head for each segment of ten seconds."""

import itertools
from collections.abc import Iterable
from datetime import datetime, timedelta
from pathlib import Path
from typing import TextIO

import numpy as np

from shaftprint.errors import RecordingError
from shaftprint.escape import printable
from shaftprint.files import written_whole
from shaftprint.recording._channel import Channel
from shaftprint.recording.writers._refused import told_as_refused
from shaftprint.recording.writers._shared_clock import by_clock, expect_channels, in_parts

_SEGMENT_S = 10.0
_TAKEN = ("x_value", "comment", "")
_ROUNDED = "Values, times and steps are rounded to six decimals, as LabVIEW prints them."


def write_lvm(
    path: str | Path, channels: Iterable[Channel], *, began: datetime | None = None, overwrite: bool = False
) -> tuple[str, ...]:
    """Write channels as .lvm: one column of times where they share a clock, else times before each channel.

    Parameters, what is returned and errors are those of ``write_by_ending``; the date is by the clock of the place.
    There has to be a channel, and none may be called what means something else in such a file.
    """
    path, written = Path(path), list(channels)
    expect_channels(path, written)
    taken = next((one.name for one in written if one.name.lower() in _TAKEN), None)
    if taken is not None:
        raise RecordingError(f'{path}: expected names of channels other than X_Value and Comment, found "{taken}".')
    is_one = len(by_clock(written)) == 1
    with (
        told_as_refused(path),
        written_whole(path, overwrite=overwrite) as part,
        part.open("w", encoding="utf-8", newline="\n") as file,
    ):
        file.write(_head(began, is_one=is_one))
        for segment in in_parts(written, _SEGMENT_S):
            _write_segment(file, segment, began, is_one=is_one)
    return (_ROUNDED,)


def _head(began: datetime | None, *, is_one: bool) -> str:
    lines = ["LabVIEW Measurement", "Writer_Version\t2", "Reader_Version\t2", "Separator\tTab", "Decimal_Separator\t."]
    lines += ["Multi_Headings\tYes", f"X_Columns\t{'One' if is_one else 'Multi'}", "Time_Pref\tRelative"]
    lines += ["Operator\tshaftprint"]
    if began is not None:
        lines += [f"Date\t{began:%Y/%m/%d}", f"Time\t{began:%H:%M:%S.%f}"]
    return "\n".join([*lines, "***End_of_Header***\t", "\t", ""])


def _write_segment(file: TextIO, channels: list[Channel], began: datetime | None, *, is_one: bool) -> None:
    if not any(one.count for one in channels):
        return
    head: dict[str, list[str]] = {"Samples": [str(one.count) for one in channels]}
    if began is not None:
        # the first sample that is taken in a segment dates it
        dates = [began + timedelta(seconds=one.start_s) for one in channels]
        head |= {"Date": [f"{one:%Y/%m/%d}" for one in dates], "Time": [f"{one:%H:%M:%S.%f}" for one in dates]}
    head |= {
        "Y_Unit_Label": [printable(one.unit) for one in channels],
        "X_Dimension": ["Time" for _ in channels],
        "X0": [f"{one.start_s:.16E}" for one in channels],
        "Delta_X": [f"{1.0 / one.rate_hz:.6f}" for one in channels],
    }
    apart = "\t" if is_one else "\t\t"
    file.write(f"Channels\t{len(channels)}\t\n")
    file.writelines(f"{key}\t{apart.join(values)}\t\n" for key, values in head.items())
    file.write("***End_of_Header***\t\n")
    names = [printable(one.name) for one in channels]
    titles = ["X_Value", *names] if is_one else [title for name in names for title in ("X_Value", name)]
    file.write("\t".join([*titles, "Comment"]) + "\n")
    if is_one:
        columns = [channels[0].stamps_s(0, channels[0].count), *(one.values(0, one.count) for one in channels)]
        row = "\t".join(["%.6f"] * len(columns)) + "\n"
        file.write(row * len(columns[0]) % tuple(np.column_stack(columns).ravel().tolist()))
    else:
        pairs = (zip(one.stamps_s(0, one.count), one.values(0, one.count), strict=True) for one in channels)
        cells = ([f"{time:.6f}\t{value:.6f}" for time, value in pair] for pair in pairs)
        file.writelines("\t".join(row) + "\n" for row in itertools.zip_longest(*cells, fillvalue="\t"))
    file.write("\n")
