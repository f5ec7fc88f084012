"""When and how each test of a campaign was really made, found from the recorded set point.

A campaign sheet gives windows, not the instant at which a sine rises through its middle. Three steps find it. The size
of the motion, whatever its phase and sign, says how far the recording is shifted against the campaign as a whole. A
sine fitted to the middle of each window gives frequency, amplitude and phase. Begin and end of a sine lie where the
sum of squares changes over from the constant to the sine: two change points, found exactly by cumulative sums.
Staircases and chirps are shifted until they correlate best.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.fft import irfft, next_fast_len, rfft

from shaftprint.arrays import FloatArray
from shaftprint.campaign import Campaign, Excitation, Sine, setpoint

# The envelope: its rate, and the time over which it is a mean [Hz, s].
_ENVELOPE_HZ, _ENVELOPE_S = 2.0, 4.0
# Samples of a sine a period that are enough for its phase; how many times its frequency is looked at.
_SAMPLES_A_PERIOD, _HIGHEST = 40.0, 8.0
# Nearer than this part of a period over the whole window a frequency is that of the campaign.
_SAME_BINS = 0.1
_LEAST_EXPLAINED = 0.5
# The ends of a window of which the begin is not known are left out of the fit.
_TRIMMED_SHARE, _TRIMMED_S = 0.1, 3.0
# A begin is known to this, and a phase to that [s, deg]; what differs by more is named.
_SAME_BEGIN_S, _SAME_PHASE_DEG = 0.3, 20.0
_SAME_AMPLITUDE = 0.1
_FEWEST_ALIKE, _ALIKE_SHARE = 3, 0.75

_ROUNDS = 3

# How far a staircase or chirp is looked for beside its place [s].
_SEARCHED_S = 10.0


@dataclass(frozen=True, kw_only=True, slots=True)
class FoundTest:
    """One test of the campaign as the recorded set point shows it."""

    planned: Excitation
    """What the campaign says."""
    is_found: bool
    """Whether the set point shows such a test there at all; the numbers below say nothing where it does not."""
    begin_s: float
    """When it begins [s]."""
    end_s: float
    """When it ends [s]."""
    rising_s: float
    """When a sine rises through its middle, the time nearest to its begin [s]; the begin of another test."""
    frequency_hz: float
    """Frequency of a sine [Hz]; not a number for another test."""
    amplitude_v: float
    """Amplitude of a sine [V]; not a number for another test."""
    is_inverted: bool
    """Whether a staircase or chirp goes down where the campaign goes up."""

    @property
    def later_s(self) -> float:
        """How much later it begins than the campaign says [s]."""
        return self.begin_s - self.planned.start_s

    @property
    def phase_deg(self) -> float:
        """Phase of a sine at its begin [deg], from -180 to 180; 0 for another test."""
        if not isinstance(self.planned, Sine) or not self.is_found:
            return 0.0
        turns = (self.begin_s - self.rising_s) * self.frequency_hz
        return 360.0 * (turns - round(turns))

    @property
    def is_same(self) -> bool:
        """Whether it is found, and but for its begin and phase as planned."""
        if not self.is_found or self.is_inverted:
            return False
        if not isinstance(self.planned, Sine):
            return True
        is_as_large = abs(self.amplitude_v / self.planned.amplitude_v - 1.0) <= _SAME_AMPLITUDE
        return self.frequency_hz == self.planned.frequency_hz and is_as_large

    @property
    def differences(self) -> tuple[str, ...]:
        """What is other than in the campaign, each with the value that fits; empty where nothing is."""
        if not self.is_found:
            return ("is not in the set point near its place",)
        planned = self.planned
        found = []
        if abs(self.later_s) > self._begin_tolerance_s:
            found.append(f"begins at {self.begin_s:.2f} s where the campaign says {planned.start_s:g} s")
        if self.is_inverted:
            found.append("is upside down")
        if not isinstance(planned, Sine):
            return tuple(found)
        if self.frequency_hz != planned.frequency_hz:
            found.append(f"has {self.frequency_hz:.4g} Hz where the campaign says {planned.frequency_hz:g} Hz")
        elif not found and not self._has_planned_phase:
            found.append(f"begins at a phase of {self.phase_error_deg:.0f} degrees: start_s = {self.rising_s:.3f} fits")
        if abs(self.amplitude_v / planned.amplitude_v - 1.0) > _SAME_AMPLITUDE:
            found.append(f"has {self.amplitude_v:.3g} V where the campaign says {planned.amplitude_v:g} V")
        if self.end_s < planned.window_stop_s - _SAME_BEGIN_S:
            found.append(f"ends at {self.end_s:.2f} s, before its window does at {planned.window_stop_s:.2f} s")
        return tuple(found)

    @property
    def _has_planned_phase(self) -> bool:
        """Whether a sine rises through its middle when the campaign says so."""
        error_s = self.phase_error_deg / 360.0 / self.frequency_hz
        return abs(self.phase_error_deg) <= _SAME_PHASE_DEG and abs(error_s) <= _SAME_BEGIN_S

    @property
    def _begin_tolerance_s(self) -> float:
        """How far its begin may be from the stated one [s].

        The campaign states when a sine rises through its middle: one that begins at another phase begins up to half a
        period from there, but before its window.
        """
        planned = self.planned
        if not isinstance(planned, Sine) or not self._has_planned_phase:
            return _SAME_BEGIN_S
        settling_s = max(planned.settled_s - planned.start_s, 0.0)
        return _SAME_BEGIN_S + min(0.5 / planned.frequency_hz, settling_s)

    @property
    def phase_error_deg(self) -> float:
        """Phase of a sine at the begin that the campaign states [deg], from -180 to 180; 0 for another test."""
        if not isinstance(self.planned, Sine) or not self.is_found:
            return 0.0
        turns = (self.planned.start_s - self.rising_s) * self.frequency_hz
        return 360.0 * (turns - round(turns))


def common_shift_s(found: Sequence[FoundTest]) -> float:
    """Return by how much later than the campaign nearly all tests begin [s]; 0 where they do not, or do not agree."""
    there = [test for test in found if test.is_found]
    if len(there) < _FEWEST_ALIKE:
        return 0.0
    later = np.array([test.later_s for test in there])
    alike = np.abs(later - np.median(later)) < _SAME_BEGIN_S
    if alike.mean() < _ALIKE_SHARE or abs(float(np.median(later))) < _SAME_BEGIN_S:
        return 0.0
    # the phase of a slow sine knows it better than its begin does
    exact = [test.rising_s - test.planned.start_s for test, same in zip(there, alike.tolist(), strict=True) if same]
    return float(np.median(exact))


def found_tests(
    set_point_v: FloatArray, campaign: Campaign, *, rate_hz: float, start_s: float
) -> tuple[FoundTest, ...]:
    """Return every test as the set point shows it, in the order of the campaign.

    Parameters
    ----------
    set_point_v
        Set point on a grid [V], shape (samples,).
    campaign
        What was asked for.
    rate_hz, start_s
        The grid.
    """
    grid = _Grid(set_point_v=set_point_v, rate_hz=rate_hz, start_s=start_s)
    found = _found_at(grid, campaign, 0.0)
    if not all(test.is_same for test in found):
        shifted = _found_at(grid, campaign, _likely_shift_s(grid, campaign))
        if sum(test.is_same for test in shifted) > sum(test.is_same for test in found):
            found = shifted
    # a test that was looked for half way to its neighbours only may begin beyond: again about the median, between
    # the neighbours as they were found
    for _ in range(_ROUNDS):
        if not any(test.differences for test in found):
            break
        later = [test.later_s for test in found if test.is_same] or [0.0]
        found = _found_at(grid, campaign, float(np.median(later)), known=found)
    return found


def _found_at(
    grid: "_Grid", campaign: Campaign, shift_s: float, known: tuple[FoundTest, ...] = ()
) -> tuple[FoundTest, ...]:
    """Return every test where it would be with a shift of all, give or take some seconds.

    Parameters
    ----------
    grid, campaign
        The set point, and what was asked for.
    shift_s
        The shift [s].
    known
        The tests as they were found before.
    """
    tests = campaign.excitations
    found = []
    for place, test in enumerate(tests):
        if not isinstance(test, Sine):
            found.append(_found_course(grid, test, campaign, shift_s))
            continue
        first_s, last_s = test.start_s + shift_s - _SEARCHED_S, test.stop_s + shift_s + _SEARCHED_S
        if place:
            half_way = shift_s + 0.5 * (tests[place - 1].stop_s + test.start_s)
            is_known = bool(known) and known[place - 1].is_found
            first_s = max(first_s, known[place - 1].end_s if is_known else half_way)
        if place + 1 < len(tests):
            half_way = shift_s + 0.5 * (test.stop_s + tests[place + 1].start_s)
            is_known = bool(known) and known[place + 1].is_found
            last_s = min(last_s, known[place + 1].begin_s if is_known else half_way)
        found.append(_found_sine(grid, test, shift_s, first_s, last_s))
    return tuple(found)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Grid:
    """The recorded set point on its grid."""

    set_point_v: FloatArray
    rate_hz: float
    start_s: float

    def cut(self, first_s: float, last_s: float, *, highest_hz: float = np.inf) -> tuple[FloatArray, FloatArray]:
        """Return times [s] and set point [V] between two times, as means of blocks that show a frequency well."""
        length = max(int(self.rate_hz / (_SAMPLES_A_PERIOD * highest_hz)), 1)
        first = max(round((first_s - self.start_s) * self.rate_hz), 0)
        stop = min(round((last_s - self.start_s) * self.rate_hz), self.set_point_v.size)
        blocks = max(stop - first, 0) // length
        values = self.set_point_v[first : first + blocks * length].reshape(blocks, length).mean(axis=1)
        middle = first + length * np.arange(blocks) + 0.5 * (length - 1)
        return np.asarray(self.start_s + middle / self.rate_hz), np.asarray(values)


def _likely_shift_s(grid: _Grid, campaign: Campaign) -> float:
    """Return by how much later than the campaign the set point moves, from the size of its motion [s]."""
    length = max(round(grid.rate_hz / _ENVELOPE_HZ), 1)
    count = grid.set_point_v.size // length
    blocks = grid.set_point_v[: count * length].reshape(count, length)
    time_s = grid.start_s + (np.arange(count * length) / grid.rate_hz).reshape(count, length)
    # a block of the plan beyond the recording is of use when the recording is shifted
    before = round(grid.start_s * grid.rate_hz / length)
    after = max(round(campaign.duration_s * _ENVELOPE_HZ) - count - before, 0)
    step_s = length / grid.rate_hz
    places = np.arange(-before, count + after)
    sub = time_s[0][np.newaxis, ::8] + step_s * places[:, np.newaxis]
    measured = _envelope(blocks - np.median(grid.set_point_v))
    planned = _envelope(setpoint(campaign, sub) - campaign.offset_v)
    size = next_fast_len(measured.size + planned.size, real=True)
    product = irfft(rfft(measured - measured.mean(), size) * rfft(planned - planned.mean(), size).conj(), size)
    # place k of the planned is block k - before of the recording
    lags = np.arange(size)
    lags = np.where(lags > size // 2, lags - size, lags) - before
    return float(lags[int(np.argmax(product))]) * step_s


def _envelope(blocks: FloatArray) -> FloatArray:
    """Return the root mean square of blocks over a few seconds, shape (blocks,)."""
    square = (blocks**2).mean(axis=1)
    window = np.ones(min(round(_ENVELOPE_S * _ENVELOPE_HZ), square.size))
    return np.asarray(np.sqrt(np.convolve(square, window / window.size, mode="same")))


def _found_sine(grid: _Grid, sine: Sine, shift_s: float, first_s: float, last_s: float) -> FoundTest:
    """Return a sine as the set point shows it between two times."""
    length_s = sine.stop_s - sine.start_s
    trim_s = min(max(_TRIMMED_SHARE * length_s, _TRIMMED_S), 0.25 * length_s)
    inner = sine.start_s + shift_s + trim_s, sine.stop_s + shift_s - trim_s
    time, values = grid.cut(*inner, highest_hz=_HIGHEST * sine.frequency_hz / 4.0)
    nothing = FoundTest(
        planned=sine,
        is_found=False,
        begin_s=np.nan,
        end_s=np.nan,
        rising_s=np.nan,
        frequency_hz=np.nan,
        amplitude_v=np.nan,
        is_inverted=False,
    )
    if time.size < _SAMPLES_A_PERIOD or time[-1] - time[0] < 1.0 / sine.frequency_hz or np.ptp(values) == 0.0:
        return nothing
    frequency = _frequency_hz(time, values, sine.frequency_hz)
    if abs(frequency - sine.frequency_hz) * (time[-1] - time[0]) < _SAME_BINS:
        frequency = sine.frequency_hz
    (cosine, sinus, mean), explained = _fitted(time, values, frequency)
    if explained < _LEAST_EXPLAINED:
        return nothing
    amplitude = float(np.hypot(cosine, sinus))
    rising = time[0] - float(np.arctan2(cosine, sinus)) / (2.0 * np.pi * frequency)
    time, values = grid.cut(first_s, last_s)
    about = values - mean
    gain = about**2 - (about - amplitude * np.sin(2.0 * np.pi * frequency * (time - rising))) ** 2
    summed = np.concatenate([[0.0], np.cumsum(gain)])
    middle = int(np.searchsorted(time, 0.5 * (inner[0] + inner[1])))
    begin = int(np.argmin(summed[: middle + 1]))
    end = middle + int(np.argmax(summed[middle:]))
    begin_s, end_s = float(time[begin]), float(time[min(end, time.size - 1)])
    rising += round((begin_s - rising) * frequency) / frequency
    return FoundTest(
        planned=sine,
        is_found=True,
        begin_s=begin_s,
        end_s=end_s,
        rising_s=rising,
        frequency_hz=frequency,
        amplitude_v=amplitude,
        is_inverted=False,
    )


def _frequency_hz(time_s: FloatArray, values: FloatArray, near_hz: float) -> float:
    """Return the frequency of the strongest sine in a window [Hz], refined by least squares."""
    rate_hz = (time_s.size - 1) / (time_s[-1] - time_s[0])
    size = next_fast_len(8 * values.size, real=True)
    taper = np.hanning(values.size)
    power = np.abs(rfft((values - values.mean()) * taper, size))
    frequencies = np.arange(power.size) * rate_hz / size
    # slower than a period in the window is drift; the campaign's own frequency always counts
    slowest = min(1.0 / (time_s[-1] - time_s[0]), 0.5 * near_hz)
    allowed = (frequencies >= slowest) & (frequencies <= _HIGHEST * near_hz)
    found = float(frequencies[allowed][np.argmax(power[allowed])])
    step = 0.1 / (time_s[-1] - time_s[0])
    for _ in range(12):
        shares = [_fitted(time_s, values, found + side * step)[1] for side in (-1.0, 0.0, 1.0)]
        bend = shares[0] - 2.0 * shares[1] + shares[2]
        move = 0.5 * (shares[0] - shares[2]) / bend if bend < 0.0 else float(np.argmax(shares) - 1)
        found += float(np.clip(move, -1.0, 1.0)) * step
        step *= 0.5
    return found


def _fitted(time_s: FloatArray, values: FloatArray, frequency_hz: float) -> tuple[FloatArray, float]:
    """Return cosine, sine and mean from the first time on, and the share of the variance that they explain."""
    phase = 2.0 * np.pi * frequency_hz * (time_s - time_s[0])
    design = np.column_stack([np.cos(phase), np.sin(phase), np.ones(phase.size)])
    found = np.linalg.solve(design.T @ design, design.T @ values)
    return found, 1.0 - float(np.var(values - design @ found) / np.var(values))


def _found_course(grid: _Grid, test: Excitation, campaign: Campaign, shift_s: float) -> FoundTest:
    """Return a staircase or chirp where it correlates best with the set point."""
    first_s, last_s = (place + shift_s for place in (test.start_s - _SEARCHED_S, test.stop_s + _SEARCHED_S))
    time, values = grid.cut(first_s, last_s)
    planned_s = np.arange(test.start_s, test.stop_s, 1.0 / grid.rate_hz)
    planned = setpoint(campaign, planned_s)
    begin_s, correlation = np.nan, 0.0
    if time.size >= planned.size and np.ptp(values) > 0.0 and np.ptp(planned) > 0.0:
        correlations = _correlations(values, planned)
        best = int(np.argmax(np.abs(correlations)))
        begin_s, correlation = float(time[best]), float(correlations[best])
    return FoundTest(
        planned=test,
        is_found=correlation**2 >= _LEAST_EXPLAINED,
        begin_s=begin_s,
        end_s=begin_s + test.stop_s - test.start_s,
        rising_s=begin_s,
        frequency_hz=np.nan,
        amplitude_v=np.nan,
        is_inverted=correlation < 0.0,
    )


def _correlations(values: FloatArray, course: FloatArray) -> FloatArray:
    """Return the correlation coefficient of a course with the values from each place on, shape (places,)."""
    size = next_fast_len(values.size + course.size, real=True)
    about, centred = values - values.mean(), course - course.mean()
    products = irfft(rfft(about, size) * rfft(centred, size).conj(), size)[: values.size - course.size + 1]
    sums, squares = (
        np.concatenate([[0.0], np.cumsum(part)])[course.size :]
        - np.concatenate([[0.0], np.cumsum(part)])[: -course.size]
        for part in (about, about**2)
    )
    spread = np.maximum(squares - sums**2 / course.size, np.finfo(np.float64).tiny)
    return np.asarray(products / np.sqrt(spread * float(centred @ centred)))
