"""Files of imc (.raw, .dat): channels with unit, scale, times from the trigger and the trigger's date.

Read here and not by the package IMCtermite, which has to be compiled where it is installed, takes no notice of bits,
masks, signals that stand in turn and fractions of a second of a date, and prints values with nine decimals.
"""

from dataclasses import dataclass
from datetime import datetime
from functools import partial
from pathlib import Path
from typing import Any, BinaryIO

from numpy.typing import NDArray

from shaftprint.arrays import FloatArray
from shaftprint.errors import RecordingError
from shaftprint.files import kept_open
from shaftprint.recording._channel import Channel
from shaftprint.recording._recording import Recording
from shaftprint.recording.readers._clock import SampleClock, clock_of_times, on_clock
from shaftprint.recording.readers._damage import told_as_damage
from shaftprint.recording.readers._gather import Gathered, names_in_words, unique_names
from shaftprint.recording.readers._hints import expect_hints
from shaftprint.recording.readers._opened import Opened
from shaftprint.recording.readers._time_scale import expect_time_unit
from shaftprint.recording.readers._units import seconds_in
from shaftprint.recording.readers.imc._blocks import BEGIN, blocks_of
from shaftprint.recording.readers.imc._layout import Component, Field, Layout, Name, Scale
from shaftprint.recording.readers.imc._samples import Samples, samples_of
from shaftprint.units import plain_unit

NAME = "imc"

_EVEN, _OVER_X = 1, (2, 3)


def is_mine(path: Path) -> bool:
    """Return whether the file begins as one of imc."""
    with path.open("rb") as file:
        return file.read(len(BEGIN)) == BEGIN


def read(path: Path, **hints: object) -> Recording:
    """Open an imc file; samples are read as channels are asked for them.

    Hints: ``time_unit`` of x axes without a unit.

    Raises RecordingError if the file is damaged or no channel can be used.
    """
    expect_hints(path, hints, {"time_unit": str})
    time_unit = expect_time_unit(path, hints.get("time_unit"))
    file = path.open("rb")
    with kept_open(Opened(path, file.close)) as opened, told_as_damage(path, NAME):
        layout = Layout()
        for block in blocks_of(path, file):
            layout.learn(block)
        layout.complete()
        return _Source(path=path, file=file, opened=opened, layout=layout, time_unit=time_unit).recording()


@dataclass(frozen=True, kw_only=True, slots=True)
class _Source:
    """A file while its channels are gathered."""

    path: Path
    file: BinaryIO
    opened: Opened
    layout: Layout
    time_unit: str

    def recording(self) -> Recording:
        """Return the recording of all channels."""
        named = [
            (each, component, name)
            for each in self.layout.fields
            for component in each.components
            if not component.is_x
            for name in component.names or [Name(group=0, bit=0, name="", comment="")]
        ]
        groups = self.layout.groups
        names = unique_names([(groups.get(name.group, "no group"), name.name) for *_, name in named])
        dates = [component.began for _, component, _ in named]
        began = min((date for date in dates if date is not None), default=None)
        gathered = Gathered(path=self.path, left_out=self._passed_over())
        undated = [name for name, date in zip(names, dates, strict=True) if date is None]
        if began is not None and undated:
            gathered.remarks.append(
                f"Channels without a date begin at second 0, that of the others: {names_in_words(undated)}."
            )
        zones = {each.trigger.zone_min for _, each, _ in named if each.trigger is not None and each.trigger.zone_min}
        if zones:
            stated = ", ".join(f"{zone} min" for zone in sorted(zones))
            gathered.remarks.append(f"The date is the logger's own; the zone that it states ({stated}) was not added.")
        if not self.layout.is_closed:
            gathered.remarks.append("The file was not closed by its writer; what was measured last may be missing.")
        for _, component, one in named:
            try:
                samples = samples_of(component, self.layout.stored, self.file, one.bit)
            except RecordingError:
                # it is left out below
                continue
            samples.expect_no_blanks(self.path)
        for (each, component, one), name in zip(named, names, strict=True):
            gathered.add(name, partial(self._channel, each, component, one, name, began))
        return gathered.recording(NAME, self.opened.close, began)

    def _passed_over(self) -> dict[str, str]:
        names = [name or "unnamed" for name in self.layout.single_values]
        single = {"single values and texts": f"{len(names)} of them: {names_in_words(names)}"} if names else {}
        unknown = self.layout.unknown.items()
        return single | {f"blocks {key}": f"{count} of them, which are not known here" for key, count in unknown}

    def _channel(self, of: Field, component: Component, one: Name, name: str, began: datetime | None) -> Channel:
        if of.kind not in (_EVEN, *_OVER_X):
            raise RecordingError("expected real numbers, found complex ones; export functions of time")
        if component.has_segments:
            raise RecordingError("expected one row of samples, found segments of a matrix; export the rows as channels")
        samples = samples_of(component, self.layout.stored, self.file, one.bit)
        date = component.began
        later_s = 0.0 if began is None or date is None else (date - began).total_seconds()
        clock = self._even_clock(component) if of.kind == _EVEN else self._clock_over_x(of, samples.count, name)
        clock = clock.later_by(later_s)
        scale = component.scale if samples.is_counts else Scale()
        channel = Channel(
            name=name,
            unit=plain_unit(component.scale.unit),
            rate_hz=clock.rate_hz,
            start_s=clock.start_s,
            count=samples.count,
            source=partial(self._read, name, samples),
            scale=scale.factor,
            offset=scale.offset,
            long_name=one.comment,
        )
        return on_clock(channel, clock)

    def _read(self, name: str, samples: Samples, start: int, stop: int) -> NDArray[Any]:
        with self.opened.reading(name), told_as_damage(self.path, NAME):
            return samples.read(start, stop)

    def _even_clock(self, component: Component) -> SampleClock:
        axis = component.axis
        if axis is None or axis.step <= 0.0:
            raise RecordingError("expected a step of its times, found none")
        if axis.reduction:
            raise RecordingError("expected samples at even steps, found some left out by the device; export with times")
        second = self._seconds_in(axis.unit)
        step_s = axis.step * second
        return SampleClock(rate_hz=float(f"{1.0 / step_s:.12g}"), start_s=component.start * second)

    def _clock_over_x(self, of: Field, count: int, name: str) -> SampleClock:
        over = [component for component in of.components if component.is_x]
        if len(over) != 1:
            raise RecordingError(f"expected one x axis for its values, found {len(over)}; export each curve alone")
        second = self._seconds_in(over[0].scale.unit)
        samples = samples_of(over[0], self.layout.stored, self.file, 0)
        if samples.count != count:
            raise RecordingError(f"expected a time for each of {count} values, found {samples.count}")
        scale = over[0].scale if samples.is_counts else Scale()

        def times(start: int, stop: int) -> FloatArray:
            return second * (self._read(f"times of {name}", samples, start, stop) * scale.factor + scale.offset)

        return clock_of_times(self.path, f"the times of {name}", count, times)

    def _seconds_in(self, unit: str) -> float:
        second = seconds_in(unit or self.time_unit)
        if second is None:
            found = f'the unit "{unit}"' if unit else "no unit (if it is time, pass time_unit= or --time-unit)"
            raise RecordingError(f"expected an x axis of time, found {found}")
        return second
