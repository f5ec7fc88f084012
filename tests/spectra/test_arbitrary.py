"""Arbitrary excitation: local polynomial method, its covariance against the scatter over repeats, its lines."""

import numpy as np
import pytest
from scipy.signal import chirp, lfilter

from shaftprint.errors import ResponseError
from shaftprint.spectra import response_from_arrays
from shaftprint.spectra.records._arbitrary import Arbitrary
from shaftprint.spectra.records._local_polynomial import Bands, Transform, is_smooth

RATE_HZ = 20.0


def lag(pole, gain):
    """``gain z^-1 / (1 - pole z^-1)`` as a filter and as a response."""

    def response(frequency_hz):
        return gain / (np.exp(2j * np.pi * frequency_hz / RATE_HZ) - pole)

    return (lambda x: lfilter([0.0, gain], [1.0, -pole], x)), response


FAST, FAST_TRUTH = lag(0.5, 0.4)
SLOW, SLOW_TRUTH = lag(0.95, 0.1)


def truth(frequency_hz):
    return np.stack([FAST_TRUTH(frequency_hz), SLOW_TRUTH(frequency_hz)])[:, np.newaxis]


def noise_of_two(rng, count, size=0.1):
    white = size * rng.standard_normal((2, count + 100))
    first = lfilter([1.0], [1.0, -0.9], white[0])
    return np.stack([first, 0.5 * first + lfilter([1.0, 0.5], [1.0], white[1])])[:, 100:]


def measured(rng, u, lead=200):
    """Outputs of an input that was moving already before the record began."""
    noise = noise_of_two(rng, u.size)
    return {"u": u[lead:]}, {"y": (FAST(u) + noise[0])[lead:], "z": (SLOW(u) + noise[1])[lead:]}


@pytest.mark.slow
def test_the_covariance_is_the_scatter_for_noise(expect_honest):
    rng = np.random.default_rng(1)
    found = [response_from_arrays(*measured(rng, rng.standard_normal(3200)), RATE_HZ) for _ in range(150)]
    expect_honest(found, truth)
    for response in found[:3]:
        assert 20 < response.frequency_hz.size < 70
        assert response.frequency_hz[0] < 10.0 / 150.0
        assert response.frequency_hz[-1] > 8.0


@pytest.mark.slow
def test_the_covariance_is_the_scatter_for_steps_at_random_times(expect_honest):
    rng = np.random.default_rng(2)
    found = []
    for _ in range(150):
        u = np.repeat(rng.choice([-1.0, 1.0], 500), rng.integers(4, 12, 500))[:3200]
        found.append(response_from_arrays(*measured(rng, u), RATE_HZ, band_hz=(0.0, 4.0)))
    expect_honest(found, truth)


@pytest.mark.slow
def test_records_of_different_length_share_the_response(expect_honest):
    rng = np.random.default_rng(3)
    found = []
    for _ in range(120):
        runs = [measured(rng, rng.standard_normal(200 + count)) for count in (700, 1000, 1500)]
        found.append(response_from_arrays([run[0] for run in runs], [run[1] for run in runs], RATE_HZ))
    expect_honest(found, truth)
    # 3200 samples in three records: about half of the variance that the longest, 1500 samples, gives alone
    chosen = Arbitrary(lines_hz=[2.0, 4.0, 6.0, 8.0])
    both = response_from_arrays([run[0] for run in runs], [run[1] for run in runs], RATE_HZ, excitation=chosen)
    alone = response_from_arrays(*runs[2], RATE_HZ, excitation=chosen)
    assert 0.3 < np.trace(both.covariance.sum(axis=0)) / np.trace(alone.covariance.sum(axis=0)) < 0.7


@pytest.mark.slow
def test_two_inputs_at_once(expect_honest):
    rng = np.random.default_rng(4)

    def both(frequency_hz):
        fast, slow = FAST_TRUTH(frequency_hz), SLOW_TRUTH(frequency_hz)
        return np.stack([[fast, -slow], [slow, 0.5 * fast]])

    found = []
    for _ in range(120):
        a, b = rng.standard_normal((2, 3200))
        b = 3.0 * b + a
        noise = noise_of_two(rng, a.size)
        y, z = FAST(a) - SLOW(b) + noise[0], SLOW(a) + 0.5 * FAST(b) + noise[1]
        found.append(response_from_arrays({"a": a[200:], "b": b[200:]}, {"y": y[200:], "z": z[200:]}, RATE_HZ))
    assert found[0].response.shape[:2] == (2, 2)
    expect_honest(found, both)


def test_chosen_lines_are_where_they_were_asked_for(expect_honest):
    rng = np.random.default_rng(5)
    chosen = Arbitrary(lines_hz=[0.1, 0.3, 0.5, 0.7, 1.0, 3.0, 4.0, 6.0])
    found = [
        response_from_arrays(*measured(rng, rng.standard_normal(3200)), RATE_HZ, excitation=chosen) for _ in range(150)
    ]
    assert found[0].frequency_hz.tolist() == [0.1, 0.3, 0.5, 0.7, 1.0, 3.0, 4.0, 6.0]
    expect_honest(found, truth)


def resonance(frequency_hz=2.0, damping=0.02):
    """A resonance sampled exactly as a filter, and its response."""
    pole = np.exp(2.0 * np.pi * frequency_hz / RATE_HZ * (-damping + 1j * np.sqrt(1.0 - damping**2)))
    a = np.array([1.0, -2.0 * pole.real, abs(pole) ** 2])

    def response(at_hz):
        back = np.exp(-2j * np.pi * at_hz / RATE_HZ)
        return (a.sum() * back / (a[0] + a[1] * back + a[2] * back**2))[np.newaxis, np.newaxis]

    return (lambda x: lfilter([0.0, a.sum()], a, x)), response


@pytest.mark.slow
def test_lines_stand_close_where_the_response_turns_quickly_and_are_not_biased(expect_honest):
    rng = np.random.default_rng(6)
    ring, ring_truth = resonance()
    found = []
    for _ in range(60):
        u = rng.standard_normal(20_400)
        y = ring(u) + 0.02 * rng.standard_normal(u.size)
        found.append(response_from_arrays({"u": u[400:]}, {"y": y[400:]}, RATE_HZ))
    expect_honest(found, ring_truth)
    lines = found[0].frequency_hz
    peak = np.diff(lines)[(lines[1:] > 1.9) & (lines[1:] < 2.1)]
    assert peak.max() < 0.06
    assert np.diff(lines)[lines[1:] > 6.0].max() > 0.3


@pytest.mark.slow
def test_a_peak_too_narrow_for_the_record_widens_the_covariance():
    # half of its power lies within 2 * 0.02 * 2 Hz = 0.08 Hz, a band needs 13 bins of 1 / 40 s = 0.33 Hz
    rng = np.random.default_rng(12)
    ring, ring_truth = resonance()
    distance, far = [], []
    for _ in range(150):
        u = rng.standard_normal(1200)
        y = ring(u) + 0.02 * rng.standard_normal(u.size)
        found = response_from_arrays({"u": u[400:]}, {"y": y[400:]}, RATE_HZ)
        error = (found.response - ring_truth(found.frequency_hz))[0, 0]
        error = np.stack([error.real, error.imag], axis=1)
        squares = np.einsum("li,lij,lj->l", error, np.linalg.inv(found.covariance), error)
        near = np.abs(found.frequency_hz - 2.0) < 0.5
        distance += squares[near].tolist()
        far += squares[~near & (found.frequency_hz > 4.0)].tolist()
    assert np.mean(distance) < 2.4
    assert np.mean(far) == pytest.approx(2.0, rel=0.1)


def test_a_parabola_is_smooth_and_a_narrow_peak_is_not():
    rng = np.random.default_rng(7)
    count = 400
    x = np.linspace(-1.0, 1.0, count)

    def bands(response, noise):
        u = rng.standard_normal(count) + 1j * rng.standard_normal(count)
        v = noise * (rng.standard_normal(count) + 1j * rng.standard_normal(count))
        transform = Transform(resolution_hz=1.0, values=np.stack([u, response * u + v + 2.0 - x]))
        return Bands(transforms=(transform,), inputs=1, order=2)

    parabola, peak = 1.0 + x - 3.0 * x**2, 1.0 / (x + 0.05j)
    # without anything to find, the statistic seldom lies three standard deviations above its mean
    smooth = [is_smooth(bands(parabola, 0.1), 0.5, 400.5) for _ in range(100)]
    assert sum(smooth) >= 95
    assert not any(is_smooth(bands(peak, 0.1), 0.5, 400.5) for _ in range(20))
    fit = bands(parabola, 1e-9).fit(0.5, 400.5)
    assert fit.response == pytest.approx(np.array([[1.0]]), abs=1e-6)
    assert fit.excess == 400 - 6


def test_lines_without_excitation_are_marked_and_silent_ones_left_out():
    rng = np.random.default_rng(8)
    time_s = np.arange(6000) / RATE_HZ
    u = chirp(time_s, 0.05, 300.0, 1.5, method="logarithmic")
    y = SLOW(u) + 0.02 * rng.standard_normal(u.size)
    found = response_from_arrays({"u": u}, {"y": y}, RATE_HZ)
    inside = (found.frequency_hz > 0.06) & (found.frequency_hz < 1.3)
    beyond = found.frequency_hz > 3.0
    assert found.used[inside].all()
    assert not found.used[beyond].any()
    assert set(found.remarks) == {name for name, used in zip(found.lines, found.used, strict=True) if not used}
    assert set(found.remarks.values()) == {"noise is larger than what the input does here"}
    error = np.abs(found.response[0, 0] - SLOW_TRUTH(found.frequency_hz))[inside]
    assert np.all(error < 4.5 * np.sqrt(found.covariance.trace(axis1=1, axis2=2)[inside]))
    # an input with nothing above 4 Hz, as an ideal filter makes it
    spectrum = np.fft.rfft(rng.standard_normal(6000))
    spectrum[1200:] = 0.0
    limited = np.fft.irfft(spectrum, 6000)
    narrow = response_from_arrays({"u": limited}, {"y": limited + 0.1 * rng.standard_normal(6000)}, RATE_HZ)
    assert 3.0 < narrow.frequency_hz[narrow.used].max() < 4.2


def test_a_drift_is_taken_out_on_request():
    rng = np.random.default_rng(9)
    u = rng.standard_normal(4000)
    ramp = 0.02 * np.arange(4000)
    given = {"excitation": Arbitrary(lines_hz=[0.1, 1.0])}
    flat = response_from_arrays({"u": u}, {"y": FAST(u)}, RATE_HZ, drift=True, **given)
    sloped = response_from_arrays({"u": u + 0.1 * ramp}, {"y": FAST(u) + ramp}, RATE_HZ, drift=True, **given)
    left = response_from_arrays({"u": u + 0.1 * ramp}, {"y": FAST(u) + ramp}, RATE_HZ, **given)
    assert sloped.response == pytest.approx(flat.response, abs=1e-9)
    assert abs(left.response - flat.response)[0, 0, 0] > 1e-3


def test_without_noise_the_response_is_found_closely():
    rng = np.random.default_rng(10)
    u = rng.standard_normal(8000)
    found = response_from_arrays({"u": u}, {"y": SLOW(u), "z": 2.0 * SLOW(u)}, RATE_HZ)
    assert found.response[0, 0] == pytest.approx(SLOW_TRUTH(found.frequency_hz), rel=1e-3)
    assert found.response[1] == pytest.approx(2.0 * found.response[0])


@pytest.mark.parametrize(
    ("numbers", "message"),
    [
        ({"lines_per_decade": 0.0}, "lines_per_decade = 0.0: expected a positive number"),
        ({"order": -1}, "order = -1: expected a whole number, 0 or more"),
        ({"lines_hz": [2.0, 1.0]}, "lines_hz: expected positive, ascending frequencies"),
        ({"lines_hz": []}, "lines_hz: expected positive, ascending frequencies"),
        ({"lines_hz": [0.1, 0.12]}, r"line 0.1 Hz: its band from 0.09 to 0.11 Hz, half way to the next lines"),
        ({"lines_hz": [12.0]}, "line 12 Hz: its band"),
    ],
)
def test_lines_that_cannot_be_had_are_told(numbers, message):
    def estimate():
        u = np.random.default_rng(0).standard_normal(1000)
        response_from_arrays({"u": u}, {"y": FAST(u)}, RATE_HZ, excitation=Arbitrary(**numbers))

    with pytest.raises(ResponseError, match=message):
        estimate()


def test_short_records_and_inputs_that_are_one_are_told():
    rng = np.random.default_rng(11)
    u = rng.standard_normal(600)
    with pytest.raises(ResponseError, match="record 1: expected at least 64 samples, found 50"):
        response_from_arrays({"u": u[:50]}, {"y": u[:50]}, RATE_HZ)
    with pytest.raises(ResponseError, match="found too few frequencies for one line between 1 and"):
        response_from_arrays({"u": u}, {"y": u}, RATE_HZ, band_hz=(1.0, 1.1))
    with pytest.raises(ResponseError, match="found no line at which every input moves, apart from the others"):
        response_from_arrays({"a": u, "b": -2.0 * u}, {"y": FAST(u)}, RATE_HZ)
