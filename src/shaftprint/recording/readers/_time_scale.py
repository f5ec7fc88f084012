"""What a column of times means: which name a clock has, and which unit and zero its numbers.

This is the one place that decides it, for text, MATLAB, HDF5, netCDF and TDMS. What the numbers do not tell is asked
for, and what was taken from their size alone is said.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import RecordingError
from shaftprint.recording._channel import Times
from shaftprint.recording.readers._clock import SampleClock
from shaftprint.recording.readers._coarse_stamps import clock_of_stamps
from shaftprint.recording.readers._epoch import LATER_THAN_ANY_TEST_S, reference_s
from shaftprint.recording.readers._units import seconds_in

TIME_NAMES = (
    "time", "t", "timestamp", "timestamps", "time stamp", "zeit", "tijd", "temps", "elapsed", "elapsed time", "millis",
    "micros", "__time", "lv time stamp", "cumulative time", "total time", "test time", "run time", "ms_today",
)  # fmt: skip
# A name with its unit: Time (ms), time_us, t [s], Zeit in ms. Beside one letter alone d is no day: t_d is a delay.
_WITH_UNIT = re.compile(r"(?P<name>[a-z ]+?)[ _]*(?:[\[(]|(?<=[ _])|\bin )[ ]*(?P<unit>[a-zµμ]+)[\])]?", re.IGNORECASE)
# the second and further times of one group: t2, time_2, Time 2
_NUMBERED, _SAME_STEP = re.compile(r"[ _]?\d+$"), 0.01
_OF_ONE_LETTER = ("s", "ms", "us", "ns")
# A temperature or a torque, where another column has the name of a time.
_CAPITAL = re.compile(r"T\b|T_")
_SINCE = re.compile(r"\s*(\w+)\s+since\s+(.+)", re.IGNORECASE)
_UNITS = "s, ms, us, ns, min, h or days"

_FIRST, _BLOCK = 1001, 1_000_000
# times of day written as one number, hhmmss, end here
_OF_DAY = 240_000.0
# Days step by less than this down to 0.6 Hz; seconds that do are those of 50 kHz and more.
_DAY_STEP, _MAY_BE_DAYS, _DAY_SHARE = 2e-5, 1e4, 1e-3
# Days that several rows share have four decimals or more.
_COARSE_DAY_STEP = 1.001e-4
# No line is sampled faster than this, or slower for a whole file [Hz].
FASTEST_HZ, SLOWEST_HZ = 1e6, 1e-2
# Whole numbers that step by so much are rather those of a counter of milliseconds than of a slow clock.
_COUNTED = 2.0


@dataclass(frozen=True, kw_only=True, slots=True)
class _Zero:
    """Numbers that count from a date: between 1980 or 2000 and 2060 they are of this size and of no other."""

    lowest: float
    highest: float
    second: float
    """Seconds of one unit."""
    at_1970: float
    """The number that stands for the beginning of 1970."""
    words: str
    has_zone: bool = True


_SINCE_1970 = _Zero(lowest=3.15e8, highest=2.84e9, second=1.0, at_1970=0.0, words="")
_SINCE_1904 = _Zero(
    lowest=3.0295e9, highest=4.29e9, second=1.0, at_1970=2_082_844_800.0, words="seconds since 1904, as LabVIEW counts"
)
_EXCEL = _Zero(
    lowest=32_874.0, highest=51_500.0, second=86_400.0, at_1970=25_569.0, has_zone=False,
    words="days since 1900, as Excel counts",
)  # fmt: skip
_MATLAB = _Zero(
    lowest=726_834.0, highest=755_000.0, second=86_400.0, at_1970=719_529.0, has_zone=False,
    words="days since the year 0, as MATLAB's datenum counts",
)  # fmt: skip
_DAYS = (_EXCEL, _MATLAB)
_COUNTERS = (
    _Zero(lowest=3.15e11, highest=2.84e12, second=1e-3, at_1970=0.0, words="milliseconds since 1970"),
    _Zero(lowest=3.0295e12, highest=4.29e12, second=1e-3, at_1970=2.0828448e12, words="milliseconds since 1904"),
    _Zero(lowest=3.15e14, highest=2.84e15, second=1e-6, at_1970=0.0, words="microseconds since 1970"),
    _Zero(lowest=9.46e17, highest=2.84e18, second=1e-9, at_1970=0.0, words="nanoseconds since 1970"),
    _Zero(lowest=1.259e17, highest=1.45e17, second=1e-7, at_1970=1.16444736e17, words="100 ns since 1601 (Windows)"),
    _Zero(lowest=6.307e17, highest=6.5e17, second=1e-7, at_1970=6.21355968e17, words="100 ns since the year 1 (.NET)"),
)


@dataclass(frozen=True, kw_only=True, slots=True)
class TimeScale:
    """What the numbers of a column of times mean."""

    second: float = 1.0
    """Seconds of one unit."""
    zero: float = 0.0
    """The number that becomes second 0: the first, where they count from a date, so that no digit is lost."""
    since_1970_s: float = 0.0
    """Seconds from 1970 to that number, where they count from a date; else 0."""
    has_zone: bool = True
    """Whether a date that follows from them is in UTC; else in the time of the place."""
    reference_s: float | None = None
    """Date of their zero in seconds since 1970, where the file gives it and they begin soon after it."""
    is_of_day: bool = False
    """Whether they are times of day written as one number, hhmmss; ``zero`` is then in seconds."""
    remark: str = ""
    """What was taken from their size alone, one sentence; empty where the file says it."""

    @property
    def began(self) -> datetime | None:
        """Date of second 0; None where they count from no date."""
        at_s = self.since_1970_s or self.reference_s
        zero = datetime(1970, 1, 1, tzinfo=UTC if self.has_zone else None)
        return None if at_s is None or at_s == 0.0 else zero + timedelta(seconds=at_s)

    def reading(self, read: Times) -> Times:
        """Return what gives the times in seconds in place of the numbers."""
        if self.is_of_day:
            return lambda start, stop: _of_day_s(read(start, stop)) - self.zero
        return lambda start, stop: (np.asarray(read(start, stop), dtype=np.float64) - self.zero) * self.second

    def clock(self, path: Path, name: str, count: int, read: Times, rate_hz: float | None) -> SampleClock:
        """Return the clock of a column of such numbers, as `clock_of_stamps`; its start counts from 1970 with them."""
        clock, _ = clock_of_stamps(path, name, count, self.reading(read), rate_hz=rate_hz)
        return clock.later_by(self.since_1970_s)


def unit_in_name(name: str) -> str | None:
    """Return the unit that stands in the name of a time, empty where none does; None where it is no time's name."""
    plain = name.strip()
    if plain.lower() in TIME_NAMES:
        return {"millis": "ms", "micros": "us", "ms_today": "ms"}.get(plain.lower(), "")
    match = _WITH_UNIT.fullmatch(plain)
    if match is None or match["name"].strip(" _").lower() not in TIME_NAMES or seconds_in(match["unit"]) is None:
        return None
    is_letter = len(match["name"].strip(" _")) == 1
    return None if is_letter and match["unit"] not in _OF_ONE_LETTER else match["unit"]


def time_of(names: Sequence[str]) -> int | None:
    """Return which of some names is that of the time; beside another a capital T is a temperature or a torque."""
    times = [place for place, name in enumerate(names) if unit_in_name(name) is not None]
    return next((place for place in times if not is_capital(names[place])), times[0] if times else None)


def is_capital(name: str) -> bool:
    """Return whether a name is a capital T, which is a clock only where nothing else is."""
    return _CAPITAL.match(name.strip()) is not None


def other_times(name: str, count: int, read: Times, rate_hz: float, clock: str) -> tuple[str, ...]:
    """Return what has to be said of a channel that holds further times; nothing of others.

    Whose they are a file of named vectors does not say. ``name``: of the channel; of most it tells that they are none.
    ``count``, ``read``: its number of values, and what reads some of them. ``rate_hz``: rate of the clock on which it
    lies [Hz]. ``clock``: what that is called.
    """
    unit = unit_in_name(_NUMBERED.sub("", name))
    if unit is None:
        return ()
    steps = np.diff(np.asarray(read(0, min(count, _FIRST)), dtype=np.float64)) * (seconds_in(unit) or 1.0)
    if steps.size < 2 or not np.all(steps > 0.0) or abs(float(np.median(steps)) * rate_hz - 1.0) <= _SAME_STEP:
        return ()
    sentence = (
        f"{name}: these may be times of their own, of which channels the file does not say; all are placed by {clock}. "
        "Where some are not, save those with their times in a group or a file of their own."
    )
    return (sentence,)


def expect_time_unit(path: Path, unit: object) -> str:
    """Return the hint ``time_unit``, empty where it is not given.

    Raises RecordingError if it is no unit of time.
    """
    text = "" if unit is None else str(unit)
    if text and seconds_in(text) is None:
        raise RecordingError(f"{path}: the hint time_unit cannot be {text!r}; it is one of {_UNITS}.")
    return text


def time_scale(path: Path, name: str, count: int, read: Times, *, unit: str = "", asked: str = "") -> TimeScale:
    """Return what the numbers of a column of times mean.

    ``path``, ``name``: file and column, for messages. ``count``, ``read``: how many numbers there are, and what gives
    those of the rows [start, stop). ``unit``: unit that the file gives, such as ``ms`` or ``seconds since 2026-03-05
    09:00``; empty where it gives none. ``asked``: unit that the caller gives, which holds before the file's. Raises
    RecordingError if the unit is none of time, or there is none and the numbers may be in several.
    """
    where = f"{path}, {name}"
    numbers = np.asarray(read(0, min(count, _FIRST)), dtype=np.float64)
    steps = np.diff(numbers)
    steps = steps[np.isfinite(steps)]
    first = float(numbers[0]) if numbers.size else np.nan
    step = float(np.median(steps)) if steps.size else 0.0
    is_coarse = step == 0.0
    if is_coarse:
        # several rows have one time: what tells the unit is by how much that steps
        further = np.diff(np.asarray(read(0, min(count, _BLOCK)), dtype=np.float64))
        step = float(np.median(further[further > 0.0])) if np.any(further > 0.0) else 0.0
    since = _SINCE.fullmatch(unit)
    stated = asked or (since[1] if since else unit)
    if not asked and stated in ("", "s") and _are_of_day(numbers) and _go_on_as_of_day(count, read):
        zero = float(_of_day_s(numbers[:1])[0])
        scale = TimeScale(
            zero=zero,
            is_of_day=True,
            remark=f"numbers such as {first:.10g} were taken for times of day, hhmmss: second 0 is "
            f"{timedelta(seconds=round(zero, 6))} of a day that is not said.",
        )
    elif stated:
        second = seconds_in(stated)
        if second is None:
            raise RecordingError(
                f'{where}: expected times in seconds or another unit of time, found the unit "{unit}"; state it, '
                f"time_unit= (--time-unit {_UNITS})."
            )
        if since and not asked:
            return _since(where, since[2], first, second)
        scale = _in_unit(where, first, second, stated, is_asked=bool(asked))
    else:
        is_whole = bool(np.all(numbers == np.rint(numbers)))
        scale = _by_size(where, first, step, _COARSE_DAY_STEP if is_coarse else _DAY_STEP, is_whole=is_whole)
    return replace(scale, remark=f"{name}: {scale.remark}") if scale.remark else scale


def _are_of_day(numbers: FloatArray) -> bool:
    """Return whether numbers may be times of day, hhmmss: no minute and no second from 60 on."""
    return bool(
        np.all((numbers >= 0.0) & (numbers < _OF_DAY) & (numbers % 100.0 < 60.0) & (numbers // 100.0 % 100.0 < 60.0))
    )


def _go_on_as_of_day(count: int, read: Times) -> bool:
    """Return whether all numbers are such times, and some go on from 59 seconds to the next minute at once."""
    minutes = 0
    for start in range(0, count, _BLOCK):
        numbers = np.asarray(read(start, min(start + _BLOCK + 1, count)), dtype=np.float64)
        if not _are_of_day(numbers):
            return False
        steps, in_truth = np.diff(numbers), np.diff(_of_day_s(numbers))
        # a minute that is over leaves out 40 of the numbers, an hour 4040
        usual = 1.5 * float(np.median(np.abs(in_truth))) if in_truth.size else 0.0
        minutes += int(np.count_nonzero((steps - in_truth >= 40.0) & (np.abs(in_truth) <= usual)))
    return minutes > 0


def _of_day_s(numbers: FloatArray) -> FloatArray:
    """Return the seconds since midnight of times written as one number, hhmmss."""
    numbers = np.asarray(numbers, dtype=np.float64)
    return numbers // 1e4 * 3600.0 + numbers // 100.0 % 100.0 * 60.0 + numbers % 100.0


def _since(where: str, date: str, first: float, second: float) -> TimeScale:
    at_s = reference_s(date)
    if at_s is None and not any(map(str.isdigit, date)):
        # since the start, the trigger
        return TimeScale(second=second)
    if at_s is None:
        raise RecordingError(f'{where}: expected times since a date such as 2026-03-05 09:00, found "{date[:40]}".')
    if abs(first) * second <= LATER_THAN_ANY_TEST_S:
        return TimeScale(second=second, reference_s=at_s)
    return TimeScale(second=second, zero=first, since_1970_s=at_s + first * second)


def _in_unit(where: str, first: float, second: float, unit: str, *, is_asked: bool) -> TimeScale:
    """Return the scale of numbers whose unit is stated: they may count from a date."""
    zeros = _DAYS if second == _EXCEL.second else ()
    for zero in zeros:
        if zero.lowest <= first <= zero.highest:
            return _scale(zero, first)
    for zero in (_SINCE_1970, _SINCE_1904):
        if zero.lowest <= first * second <= zero.highest:
            return _scale(zero, first, second=second)
    if abs(first) * second > LATER_THAN_ANY_TEST_S and not is_asked:
        raise RecordingError(
            f"{where}: expected times in {unit}, found {first:g}, which is neither a moment of a test nor a date; "
            f"state the unit, time_unit= (--time-unit {_UNITS})."
        )
    return TimeScale(second=second)


def _by_size(where: str, first: float, step: float, day_step: float, *, is_whole: bool) -> TimeScale:
    """Return the scale of numbers without a unit, by their size: seconds, unless they cannot be."""
    for zero in _COUNTERS:
        if zero.lowest <= first <= zero.highest:
            return _scale(zero, first)
    for zero in _DAYS if 0.0 < step <= day_step else ():
        if zero.lowest <= first <= zero.highest:
            return _scale(zero, first)
    for zero in (_SINCE_1970, _SINCE_1904):
        if zero.lowest <= first <= zero.highest and step <= 1.0 / SLOWEST_HZ:
            return _scale(zero, first)
    is_counter = is_whole and step >= _COUNTED
    is_too_small = 0.0 < step < 1.0 / FASTEST_HZ or (abs(first) >= _MAY_BE_DAYS and 0.0 < step <= _DAY_STEP)
    # a whole rate by the day, at which nobody samples: 86,400 Hz may be 1 Hz
    by_the_day = 1.0 / (_EXCEL.second * step) if 0.0 < step <= _DAY_STEP else 0.5
    is_too_small |= abs(by_the_day - round(by_the_day)) <= _DAY_SHARE * by_the_day
    if is_counter or is_too_small or step > 1.0 / SLOWEST_HZ or abs(first) > LATER_THAN_ANY_TEST_S:
        raise RecordingError(
            f"{where}: expected seconds, found {first:.9g} with steps of {step:.4g} and no unit; milliseconds, "
            "microseconds or days? State the unit in the title, time [ms], or with time_unit= (--time-unit ms; "
            "--time-unit s where they are seconds)."
        )
    if is_whole and step == 1.0:
        return TimeScale(remark="numbers that step by 1 without a unit were taken for seconds (1 Hz).")
    return TimeScale()


def _scale(zero: _Zero, first: float, *, second: float | None = None) -> TimeScale:
    """Return the scale of numbers that count from a date, in its unit or another."""
    seconds = zero.second if second is None else second
    remark = "" if not zero.words else f"numbers such as {first:.10g} were taken for {zero.words}."
    since_s = first * seconds - zero.at_1970 * zero.second
    return TimeScale(second=seconds, zero=first, since_1970_s=since_s, has_zone=zero.has_zone, remark=remark)
