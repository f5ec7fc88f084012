"""When and how each test of a campaign was really made, found from the recorded set point.

A campaign sheet gives windows, not the instant at which a sine rises through its middle. The size of the motion,
whatever its phase and sign, says how far the recording is shifted against the campaign as a whole. About there each
sine is fitted, and staircases and chirps are shifted until they correlate best.
"""

import numpy as np
from numpy.fft import irfft, rfft

from shaftprint.arrays import FloatArray
from shaftprint.campaign._campaign import Campaign
from shaftprint.campaign._excitation import Excitation
from shaftprint.campaign._excitations import Sine
from shaftprint.campaign._setpoint import setpoint
from shaftprint.signals.excitation._found_sine import LEAST_EXPLAINED, SetPointGrid, found_sine
from shaftprint.signals.excitation._found_test import FoundTest

# The envelope: its rate, and the time over which it is a mean [Hz, s].
_ENVELOPE_HZ, _ENVELOPE_S = 2.0, 4.0
# How often the tests are looked for again between their neighbours as they were found.
_ROUNDS = 3
# How far a test is looked for on either side of where the campaign has it [s].
_SEARCHED_S = 10.0


def found_tests(
    set_point_v: FloatArray, campaign: Campaign, *, rate_hz: float, start_s: float
) -> tuple[FoundTest, ...]:
    """Return every test as the set point shows it, in the order of the campaign.

    ``set_point_v``: set point on a grid [V], shape (samples,). ``campaign``: what was asked for. ``rate_hz``,
    ``start_s``: the grid.
    """
    grid = SetPointGrid(set_point_v=set_point_v, rate_hz=rate_hz, start_s=start_s)
    tests = _found_at(grid, campaign, 0.0)
    if not all(test.is_same for test in tests):
        shifted = _found_at(grid, campaign, _likely_shift_s(grid, campaign))
        if sum(test.is_same for test in shifted) > sum(test.is_same for test in tests):
            tests = shifted
    # a test that was looked for half way to its neighbours only may begin beyond: again about the median, between
    # the neighbours as they were found
    for _ in range(_ROUNDS):
        if not any(test.differences for test in tests):
            break
        later = [test.later_s for test in tests if test.is_same] or [0.0]
        tests = _found_at(grid, campaign, float(np.median(later)), known=tests)
    return tests


def _found_at(
    grid: SetPointGrid, campaign: Campaign, shift_s: float, known: tuple[FoundTest, ...] = ()
) -> tuple[FoundTest, ...]:
    """Return every test where it would be with a shift of all, give or take some seconds.

    ``grid``, ``campaign``: the set point, and what was asked for. ``shift_s``: the shift [s]. ``known``: the tests as
    they were found before.
    """
    tests = campaign.excitations
    results = []
    for index, test in enumerate(tests):
        if not isinstance(test, Sine):
            results.append(_found_course(grid, test, campaign, shift_s))
            continue
        first_s, last_s = test.start_s + shift_s - _SEARCHED_S, test.stop_s + shift_s + _SEARCHED_S
        if index:
            half_way = shift_s + 0.5 * (tests[index - 1].stop_s + test.start_s)
            is_known = bool(known) and known[index - 1].is_found
            first_s = max(first_s, known[index - 1].end_s if is_known else half_way)
        if index + 1 < len(tests):
            half_way = shift_s + 0.5 * (test.stop_s + tests[index + 1].start_s)
            is_known = bool(known) and known[index + 1].is_found
            last_s = min(last_s, known[index + 1].begin_s if is_known else half_way)
        results.append(found_sine(grid, test, shift_s, first_s, last_s))
    return tuple(results)


def _likely_shift_s(grid: SetPointGrid, campaign: Campaign) -> float:
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
    size = 1 << (measured.size + planned.size - 1).bit_length()
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


def _found_course(grid: SetPointGrid, test: Excitation, campaign: Campaign, shift_s: float) -> FoundTest:
    """Return a staircase or chirp where it correlates best with the set point."""
    first_s, last_s = (border_s + shift_s for border_s in (test.start_s - _SEARCHED_S, test.stop_s + _SEARCHED_S))
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
        is_found=correlation**2 >= LEAST_EXPLAINED,
        begin_s=begin_s,
        end_s=begin_s + test.stop_s - test.start_s,
        rising_s=begin_s,
        frequency_hz=np.nan,
        amplitude_v=np.nan,
        is_inverted=correlation < 0.0,
    )


def _correlations(values: FloatArray, course: FloatArray) -> FloatArray:
    """Return the correlation coefficient of a course with the values from each place on, shape (places,)."""
    size = 1 << (values.size + course.size - 1).bit_length()
    about, centred = values - values.mean(), course - course.mean()
    products = irfft(rfft(about, size) * rfft(centred, size).conj(), size)[: values.size - course.size + 1]
    sums, squares = (
        np.concatenate([[0.0], np.cumsum(part)])[course.size :]
        - np.concatenate([[0.0], np.cumsum(part)])[: -course.size]
        for part in (about, about**2)
    )
    spread = np.maximum(squares - sums**2 / course.size, np.finfo(np.float64).tiny)
    return np.asarray(products / np.sqrt(spread * float(centred @ centred)))
