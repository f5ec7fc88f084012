"""Universal files: a data set 58 a channel, in binary, by pyuff."""

import warnings
from collections.abc import Iterable
from datetime import datetime
from pathlib import Path
from typing import Any

import numpy as np

from shaftprint.errors import RecordingError
from shaftprint.escape import printable
from shaftprint.files import written_whole
from shaftprint.recording._channel import Channel
from shaftprint.recording.readers._extra import library
from shaftprint.recording.readers._printed_rate import rate_of_step
from shaftprint.recording.writers._refused import told_as_refused

_TIME, _GENERAL = 17, 0
_LONGEST, _LONGEST_LABEL = 80, 20
_DATE = "%Y-%m-%d %H:%M:%S"


def write_uff(
    path: str | Path, channels: Iterable[Channel], *, began: datetime | None = None, overwrite: bool = False
) -> tuple[str, ...]:
    """Write channels as functions of time, each with its clock, or with the time of each sample.

    The head of a function prints start and step with six digits. Where these do not tell the clock, and where samples
    are no numbers, which the format does not know, each sample gets its time.

    Parameters, what is returned and errors are those of ``write_by_ending``; the date is by the clock of the place, to
    the second. pyuff has to be installed, and each channel to have two numbers.
    """
    path = Path(path)
    pyuff = library(path, "pyuff", "universal")
    remarks = []
    if began is not None and began.microsecond:
        remarks.append("The date of second 0 is cut off at the second.")
    with told_as_refused(path), written_whole(path, overwrite=overwrite) as part, warnings.catch_warnings():
        # the library leaves binary files to be closed by Python
        warnings.simplefilter("ignore", ResourceWarning)
        # the library's "overwrite" leaves seven bytes of a binary file
        part.touch()
        for channel in channels:
            function = _function(path, channel, began)
            remarks += [f"{channel.name}: {loss}" for loss in _losses(channel)]
            pyuff.UFF(str(part)).write_sets([function], "add")
    return tuple(remarks)


def _function(path: Path, channel: Channel, began: datetime | None) -> dict[str, Any]:
    values = channel.values(0, channel.count)
    is_number = np.isfinite(values)
    times = channel.stamps_s(0, channel.count)
    if np.count_nonzero(is_number) < 2:
        raise RecordingError(f"{path}, channel {channel.name}: expected at least two numbers, found fewer.")
    start, step = float(f"{channel.start_s:.5e}"), f"{1.0 / channel.rate_hz:.5e}"
    is_even = channel.stamps is None and start == channel.start_s and rate_of_step(step) == channel.rate_hz
    return {
        "type": 58,
        "binary": 1,
        "func_type": 1,
        "rsp_node": 0,
        "rsp_dir": 0,
        "ref_node": 0,
        "ref_dir": 0,
        "id1": printable(channel.name)[:_LONGEST],
        "id2": printable(channel.long_name)[:_LONGEST] or "NONE",
        "id3": "NONE" if began is None else began.strftime(_DATE),
        "id4": "NONE",
        "id5": "NONE",
        "rsp_ent_name": "NONE",
        "ref_ent_name": "NONE",
        "abscissa_spacing": int(is_even and bool(is_number.all())),
        "abscissa_spec_data_type": _TIME,
        "abscissa_axis_lab": "Time",
        "abscissa_axis_units_lab": "s",
        "ordinate_spec_data_type": _GENERAL,
        "ordinate_axis_lab": printable(channel.long_name)[:_LONGEST_LABEL] or "NONE",
        "ordinate_axis_units_lab": printable(channel.unit)[:_LONGEST_LABEL] or "NONE",
        "orddenom_spec_data_type": _GENERAL,
        "z_axis_spec_data_type": _GENERAL,
        "x": times[is_number],
        "data": values[is_number],
    }


def _losses(channel: Channel) -> list[str]:
    losses = []
    if len(channel.name) > _LONGEST:
        losses.append(f"its name is cut off after {_LONGEST} letters.")
    if len(channel.unit) > _LONGEST_LABEL:
        losses.append(f"its unit is cut off after {_LONGEST_LABEL} letters.")
    return losses
