"""Writing the native container as a stream, whole or not at all."""

import contextlib
from collections.abc import Mapping
from contextlib import ExitStack
from datetime import datetime
from pathlib import Path
from types import TracebackType
from typing import Any, Literal, Self

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray
from shaftprint.errors import RecordingError
from shaftprint.files import written_whole
from shaftprint.recording._channel import Channel, ClockJump
from shaftprint.recording._channel_writer import ChannelWriter
from shaftprint.recording._container import BEGAN, FORMAT, GROUP, VERSION, VERSION_WITH_TIMES
from shaftprint.recording._hdf5_output import Hdf5Output
from shaftprint.recording._seal import add_seal


class RecordingWriter:
    """Write a recording channel by channel, in pieces of any size.

    The file gets its name only when the ``with`` block ends without error; until then it has a
    temporary name in the same folder, and an error leaves nothing behind::

        with RecordingWriter("test.nc") as writer:
            writer.declare("M_s", unit="V", rate_hz=2000.0, scale=10.0 / 32768.0)
            writer.append("M_s", counts)
    """

    def __init__(
        self,
        path: str | Path,
        *,
        attributes: Mapping[str, str | float] | None = None,
        began: datetime | None = None,
        overwrite: bool = False,
    ) -> None:
        """Say where the recording belongs; nothing is written before the ``with`` block begins.

        ``path``: the finished file. ``attributes``: facts on the whole recording, such as ``{"ship": "Stan Tug
        1205"}``. ``began``: date of second 0, where it is known. ``overwrite``: whether a file of that name may be
        replaced.
        """
        self._path = Path(path)
        self._attributes = {**(attributes or {}), **({} if began is None else {BEGAN: began.isoformat()})}
        self._overwrite = overwrite
        self._stack = ExitStack()
        self._open: dict[str, ChannelWriter] = {}
        self._output: Hdf5Output
        self._part = self._path

    def __enter__(self) -> Self:
        """Open the file under its temporary name.

        Raises RecordingError if the file exists and may not be replaced, or its folder cannot be written.
        """
        root = {"Conventions": "CF-1.11", "format": FORMAT, "format_version": VERSION}
        try:
            with ExitStack() as stack:
                self._part = stack.enter_context(written_whole(self._path, overwrite=self._overwrite))
                self._output = Hdf5Output(self._part, track_order=True)
                stack.callback(self._output.close)
                with self._output.calls():
                    self._output.file.attrs.update(root | self._attributes)
                    self._output.file.create_group(GROUP, track_order=True)
                self._stack = stack.pop_all()
        except OSError as error:
            raise self._cannot_be_written(error) from None
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Finish the file and give it its name, or delete it after an error.

        Raises RecordingError if the last samples cannot be written.
        """
        if error is not None:
            # what closing says of the same full disk is not said again
            with contextlib.suppress(OSError):
                self._stack.__exit__(kind, error, trace)
            return
        try:
            with self._stack:
                with self._output.calls():
                    for number, channel in enumerate(self._open.values()):
                        channel.finish(number)
                self._output.close()
                add_seal(self._part)
        except OSError as failure:
            raise self._cannot_be_written(failure) from None

    def declare(
        self,
        name: str,
        *,
        unit: str,
        rate_hz: float,
        start_s: float = 0.0,
        scale: float = 1.0,
        offset: float = 0.0,
        long_name: str = "",
        dtype: Literal["int16", "float64"] = "int16",
        times: Literal["by rate", "beside the rate", "uneven"] = "by rate",
        clock_jumps: tuple[ClockJump, ...] = (),
        is_of_edges: bool = False,
    ) -> None:
        """Announce a channel before its first samples.

        Parameters
        ----------
        name
            Name of the channel.
        unit
            Unit of the scaled value.
        rate_hz
            Sample rate [Hz].
        start_s
            Time of the first sample [s].
        scale, offset
            ``value = counts * scale + offset`` [unit].
        long_name
            What the channel is, in words.
        dtype
            ``float64`` for values that never were counts; scale 1 and offset 0 then.
        times
            Whether the samples lie on the clock of the rate, have times of their own near it too, or have those alone,
            as messages on a bus do.
        clock_jumps
            Where its clock jumps.
        is_of_edges
            Whether the samples were made of a list of edges.

        Raises
        ------
        RecordingError
            If the name is taken or cannot be used, or the clock or scale is impossible.
        """
        if not name or "/" in name or name in self._open:
            raise RecordingError(f'{self._path}: expected a new channel name without "/", found "{name}".')
        channel = Channel(
            name=name,
            unit=unit,
            rate_hz=rate_hz,
            start_s=start_s,
            count=0,
            scale=scale,
            offset=offset,
            long_name=long_name,
            source=lambda start, stop: np.zeros(0, dtype=dtype),
            stamps=None if times == "by rate" else lambda start, stop: np.zeros(0),
            is_uneven=times == "uneven",
            clock_jumps=clock_jumps,
            is_of_edges=is_of_edges,
        )
        try:
            with self._output.calls():
                if channel.stamps is not None:
                    self._output.file.attrs.modify("format_version", VERSION_WITH_TIMES)
                self._open[name] = ChannelWriter(self._output.file[GROUP], channel, np.dtype(dtype))
        except OSError as error:
            raise self._cannot_be_written(error) from None

    def append(self, name: str, counts: NDArray[Any], time_s: FloatArray | None = None) -> None:
        """Add samples to a channel.

        Parameters
        ----------
        name
            A declared channel.
        counts
            Raw counts of its type, shape (samples,), any number of them.
        time_s
            Their times [s], shape (samples,), where it was declared to have its own.

        Raises
        ------
        RecordingError
            If the channel was not declared, the counts are of another type, times are missing or too many, or the disk
            is full.
        """
        if name not in self._open:
            raise RecordingError(
                f'{self._path}: expected a declared channel ({", ".join(self._open) or "none yet"}), found "{name}".'
            )
        channel = self._open[name]
        if counts.ndim != 1 or counts.dtype != channel.dtype:
            raise RecordingError(
                f"{self._path}, channel {name}: expected a vector of {channel.dtype}, "
                f"found {counts.dtype} of shape {counts.shape}."
            )
        if channel.has_times != (time_s is not None) or (time_s is not None and time_s.shape != counts.shape):
            expected = f"{counts.size} times" if channel.has_times else "no times, as it was declared,"
            raise RecordingError(
                f"{self._path}, channel {name}: expected {expected} for {counts.size} samples, "
                f"found {'none' if time_s is None else time_s.size}."
            )
        try:
            with self._output.calls():
                channel.append(counts, time_s)
        except OSError as error:
            raise self._cannot_be_written(error) from None

    def _cannot_be_written(self, error: OSError) -> RecordingError:
        advice = f"{error.strerror}; check the path, the permissions and the free space." if error.strerror else error
        return RecordingError(f"{self._path}: the recording cannot be written: {advice}")
