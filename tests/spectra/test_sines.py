"""One sine a record: each frequency is one line, with the deviation of its noise."""

import numpy as np
import pytest

from shaftprint.errors import ResponseError
from shaftprint.spectra import response_from_arrays
from shaftprint.spectra.records._sine import Sine

RATE_HZ = 100.0


def lag(hertz):
    """A lag of 0.1 s with the gain 2."""
    return 2.0 / (1.0 + 0.2j * np.pi * hertz)


def records(hertz, *, seconds=20.0, noise=0.0, rng=None, slope=0.0):
    """Input and settled output of each frequency, the output with an offset, a drift [1/s] and white noise."""
    time = np.arange(round(seconds * RATE_HZ)) / RATE_HZ
    turns = np.exp(2j * np.pi * np.asarray(hertz)[:, None] * time)
    inputs = [{"u": turn.imag} for turn in turns]
    outputs = []
    for one, turn in zip(hertz, turns, strict=True):
        y = (lag(one) * turn).imag + 3.0 + slope * time
        outputs.append({"y": y + (noise * rng.standard_normal(time.size) if noise else 0.0)})
    return inputs, outputs


def test_frequencies_between_bins_are_found_with_their_response():
    hertz = [0.37, 1.3, 7.77]
    found = response_from_arrays(*records(hertz), RATE_HZ, excitation=Sine(settling_s=2.0))
    assert found.frequency_hz == pytest.approx(hertz, rel=1e-5)
    assert found.response[0, 0] == pytest.approx(lag(np.array(hertz)), rel=1e-3)


def test_records_of_one_frequency_are_one_line():
    found = response_from_arrays(*records([1.3, 1.3, 4.0]), RATE_HZ, excitation=Sine())
    assert found.frequency_hz == pytest.approx([1.3, 4.0], rel=1e-5)


def test_a_drift_is_no_part_of_the_response():
    rng = np.random.default_rng(1)
    inputs, outputs = records([0.5], slope=0.05, noise=1e-3, rng=rng)
    found = response_from_arrays(inputs, outputs, RATE_HZ, excitation=Sine(), drift=True)
    assert found.response[0, 0, 0] == pytest.approx(lag(0.5), abs=2e-3)


def test_the_deviation_is_that_of_white_noise():
    rng, errors, stds = np.random.default_rng(2), [], []
    for _ in range(30):
        found = response_from_arrays(*records([2.0], noise=0.1, rng=rng), RATE_HZ, excitation=Sine(settling_s=0.0))
        errors.append(found.response[0, 0, 0] - lag(2.0))
        stds.append(np.sqrt(np.trace(found.covariance[0])))
    # least squares for a sine of amplitude 1 in 2000 samples: 2 sigma / sqrt(n), both parts together
    assert np.mean(stds) == pytest.approx(2.0 * 0.1 / np.sqrt(2000.0), rel=0.2)
    assert np.sqrt(np.mean(np.abs(errors) ** 2)) == pytest.approx(np.mean(stds), rel=0.4)


@pytest.mark.parametrize(
    ("hertz", "options", "words"),
    [
        ([0.1], {}, r"record 1: expected 4 periods or more of a sine after 5 s of settling, found 1 in 15 s"),
        ([1.0], {"band_hz": (2.0, 10.0)}, r"found no sine between 2 and 10 Hz"),
    ],
)
def test_what_is_no_sine_in_the_band_is_refused(hertz, options, words):
    with pytest.raises(ResponseError, match=words):
        response_from_arrays(*records(hertz), RATE_HZ, excitation=Sine(), **options)


def test_two_inputs_are_refused():
    inputs, outputs = records([1.0])
    with pytest.raises(ResponseError, match="sines: expected one input, found u, v"):
        response_from_arrays([{**inputs[0], "v": inputs[0]["u"]}], outputs, RATE_HZ, excitation=Sine())
