import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.signal import freqz, upfirdn

from shaftprint.errors import SignalError
from shaftprint.signals.conditioning._decimate import SampleGrid, decimated, low_pass_taps

RNG = np.random.default_rng(8)
SIGNAL = RNG.standard_normal(5000)


def test_pass_band_and_stop_band():
    (taps,) = low_pass_taps(10.0, 1)
    frequency, response = freqz(taps, worN=20_001, fs=2000.0)
    assert np.abs(np.abs(response[frequency <= 40.0]) - 1.0).max() < 1e-4
    assert 20.0 * np.log10(np.abs(response[frequency >= 100.0]).max()) < -80.0
    assert taps == pytest.approx(taps[::-1], abs=1e-18)
    assert taps.sum() == pytest.approx(1.0, abs=1e-15)


@pytest.mark.parametrize("step", [2.0, 5.0, 7.3, 25.0])
def test_other_steps_scale_the_bands(step):
    (taps,) = low_pass_taps(step, 1)
    frequency, response = freqz(taps, worN=20_001, fs=step)
    assert np.abs(np.abs(response[frequency <= 0.2]) - 1.0).max() < 1e-4
    assert np.abs(response[frequency >= 0.5]).max() < 1e-4


def test_equals_the_plain_filter_with_its_delay_removed():
    (taps,) = low_pass_taps(10.0, 1)
    half = taps.size // 2
    padded = np.concatenate([np.full(half, SIGNAL[0]), SIGNAL, np.full(half, SIGNAL[-1])])
    plain = upfirdn(taps, padded, down=1)[2 * half : 2 * half + SIGNAL.size : 10]
    found = decimated([SIGNAL], SampleGrid(first=0.0, step=10.0, count=500), channel="X")
    assert found == pytest.approx(plain, abs=1e-12)


@pytest.mark.parametrize(("first", "step"), [(0.0, 10.0), (12.0, 10.0), (10.4, 10.0), (-3.7, 10.24), (100.0, 9.9995)])
def test_sine_comes_out_at_the_instants_of_the_grid(first, step):
    frequency = 0.0173
    samples = np.sin(2 * np.pi * frequency * np.arange(5000))
    count = 480
    found = decimated([samples], SampleGrid(first=first, step=step, count=count), channel="X")
    expected = np.sin(2 * np.pi * frequency * (first + step * np.arange(count)))
    inside = slice(12, -30)
    # ripple, and a time that is right to a thousandth of a sample
    assert found[inside] == pytest.approx(expected[inside], abs=1e-4 + 2 * np.pi * frequency / 1024.0)


@settings(deadline=None, max_examples=40)
@given(size=st.integers(1, 3000), first=st.sampled_from([0.0, 12.0, 3.37, -5.2]))
def test_cut_into_blocks_does_not_matter(cut, size, first):
    grid = SampleGrid(first=first, step=10.0, count=500)
    whole = decimated([SIGNAL], grid, channel="X")
    assert np.array_equal(decimated(cut(SIGNAL, size), grid, channel="X"), whole)


@pytest.mark.parametrize("first", [1000.0, 2503.7, 4990.0])
def test_a_grid_that_begins_many_blocks_behind_the_channel_is_where_it_should_be(cut, first):
    grid = SampleGrid(first=first, step=10.0, count=40)
    ramp = np.arange(5000.0)
    found = decimated(cut(ramp, 64), grid, channel="X")
    assert np.array_equal(found, decimated([ramp], grid, channel="X"))
    place = first + 10.0 * np.arange(40)
    inside = place < 4900.0
    # the filter leaves a straight line as it is, and its taps stand within a thousandth of a sample
    assert found[inside] == pytest.approx(place[inside], abs=1.5e-3)


def test_constant_stays_beyond_both_ends():
    found = decimated([np.full(40, 3.5)], SampleGrid(first=-200.0, step=10.0, count=60), channel="X")
    assert found == pytest.approx(np.full(60, 3.5), rel=1e-14)


@pytest.mark.parametrize(("first", "step"), [(100.97, 10.0), (100.0, 10.0), (100.25, 7.5), (101.0, 1.0)])
def test_an_instant_is_the_sum_of_samples_and_taps_around_it(first, step):
    grid = SampleGrid(first=first, step=step, count=9)
    found = decimated([SIGNAL[:1000]], grid, channel="X")
    taps = low_pass_taps(step, 1 if grid.on_samples else 512)
    half = (taps.shape[1] - 1) // 2
    padded = np.pad(SIGNAL[:1000], 200, mode="edge")
    for value, place in zip(found, first + step * np.arange(9), strict=True):
        nearest = round(place * len(taps))
        begin = 200 + nearest // len(taps) - half
        row = taps[nearest % len(taps)]
        assert value == pytest.approx(padded[begin : begin + row.size] @ row, abs=1e-12)


def test_grid_finer_than_the_samples():
    with pytest.raises(SignalError, match=r"channel M_s: expected at least the rate of the signals, found 0\.5 times"):
        decimated([SIGNAL], SampleGrid(first=0.0, step=0.5, count=10), channel="M_s")
