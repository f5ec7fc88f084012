"""Periodic excitation: the response is unbiased, its covariance is the scatter over repeats."""

import numpy as np
import pytest
from scipy.signal import lfilter

from shaftprint.errors import ResponseError
from shaftprint.spectra import Periodic, response_from_arrays

RATE_HZ = 10.0
PERIOD = 64


def multisine(rng, lines, *, period=PERIOD):
    """One period of a sum of cosines of amplitude 1 with random phases."""
    time = np.arange(period) / period
    return sum(np.cos(2.0 * np.pi * (k * time + rng.uniform())) for k in lines)


def first_order(a, b):
    """A discrete first-order lag ``b / (1 - a z^-1)`` with one sample of delay: as a filter and as a response."""

    def response(frequency_hz):
        z = np.exp(2j * np.pi * frequency_hz / RATE_HZ)
        return b / (z - a)

    return (lambda x: lfilter([0.0, b], [1.0, -a], x)), response


FAST, FAST_TRUTH = first_order(0.5, 0.4)
SLOW, SLOW_TRUTH = first_order(0.9, 0.2)


def truth(frequency_hz):
    return np.stack([FAST_TRUTH(frequency_hz), SLOW_TRUTH(frequency_hz)])[:, np.newaxis]


def noise_of_three(rng, count, colour=0.8):
    """Three channels of coloured noise with a common part: input, first and second output."""
    white = rng.standard_normal((3, count + 50))
    common = lfilter([1.0], [1.0, -colour], white[0])
    return np.stack([common, 0.7 * common + white[1], lfilter([1.0], [1.0, -0.95], white[2]) - common])[:, 50:]


@pytest.mark.slow
@pytest.mark.parametrize(("periods", "colour"), [(6, 0.8), (13, 0.8), (13, -0.5)])
def test_the_covariance_is_the_scatter_with_noise_of_the_input_and_correlated_outputs(expect_honest, periods, colour):
    rng = np.random.default_rng(periods)
    lines = [1, 2, 3, 5, 8, 12, 20, 31]
    found = []
    for _ in range(250):
        u = np.tile(multisine(rng, lines), periods + 2)
        noise = 0.05 * noise_of_three(rng, u.size, colour)
        found.append(
            response_from_arrays(
                {"u": u + noise[0]},
                {"y": FAST(u) + noise[1], "z": SLOW(u) + noise[2]},
                RATE_HZ,
                excitation=Periodic(period_s=PERIOD / RATE_HZ, settling_periods=2),
            )
        )
        assert found[-1].frequency_hz.tolist() == pytest.approx(np.array(lines) * RATE_HZ / PERIOD)
    expect_honest(found, truth)


def test_records_of_different_phase_and_length_are_combined(expect_honest):
    rng = np.random.default_rng(5)
    lines, found = [1, 3, 5, 9, 15, 25], []
    for _ in range(250):
        inputs, outputs = [], []
        for periods in (4, 6, 9):
            # half a period more than whole ones, and every record begins somewhere else
            u = np.tile(multisine(rng, lines), periods + 2)[: -PERIOD // 2]
            noise = 0.1 * noise_of_three(rng, u.size)
            inputs.append({"u": u + noise[0]})
            outputs.append({"y": FAST(u) + noise[1], "z": SLOW(u) + noise[2]})
        found.append(
            response_from_arrays(inputs, outputs, RATE_HZ, excitation=Periodic(period_s=6.4, settling_periods=1))
        )
    expect_honest(found, truth)


def test_two_inputs_are_told_apart_by_two_records(expect_honest):
    rng = np.random.default_rng(6)
    lines, found = [1, 2, 4, 7, 11, 18], []

    def both(frequency_hz):
        fast, slow = FAST_TRUTH(frequency_hz), SLOW_TRUTH(frequency_hz)
        return np.stack([[fast, -slow], [slow, 0.5 * fast]])

    for _ in range(250):
        inputs, outputs = [], []
        first, second = np.tile(multisine(rng, lines), 13), np.tile(multisine(rng, lines), 13)
        for sign in (1.0, -1.0):
            a, b = first, sign * second
            noise = 0.1 * noise_of_three(rng, a.size)
            inputs.append({"a": a + noise[0], "b": b})
            outputs.append({"y": FAST(a) - SLOW(b) + noise[1], "z": SLOW(a) + 0.5 * FAST(b) + noise[2]})
        found.append(response_from_arrays(inputs, outputs, RATE_HZ, excitation=Periodic(period_s=6.4)))
    assert found[0].inputs == ("a", "b")
    expect_honest(found, both)


@pytest.mark.slow
def test_what_a_nonlinearity_adds_counts_when_records_differ(expect_honest):
    # a cubic term makes, besides a constant gain, a response that changes with the phases of the multisine
    rng = np.random.default_rng(8)
    lines, found, within = list(range(1, 12)), [], []
    # 3/4 a^2 per own line, 3/2 a^2 per other line: the gain of a cube for random phases (amplitudes 1)
    gain = 1.0 + 0.02 * (0.75 + 1.5 * (len(lines) - 1))
    for _ in range(200):
        inputs, outputs = [], []
        for _ in range(7):
            u = np.tile(multisine(rng, lines), 3)
            inputs.append({"u": u})
            outputs.append({"y": u + 0.02 * u**3 + 0.01 * rng.standard_normal(u.size)})
        for between, kept in ((True, found), (False, within)):
            excitation = Periodic(period_s=6.4, between_records=between)
            kept.append(response_from_arrays(inputs, outputs, RATE_HZ, excitation=excitation))
    inner = slice(3, 8)
    error = np.array([r.response[0, 0, inner] - gain for r in found])
    stated = np.array([r.covariance[inner].trace(axis1=1, axis2=2) for r in found])
    assert stated.mean() == pytest.approx((abs(error) ** 2).mean(), rel=0.15)
    # the periods of one record agree: their scatter knows nothing of it
    assert np.mean([r.covariance[inner].trace(axis1=1, axis2=2) for r in within]) < 0.02 * stated.mean()


def square_wave(periods, samples=200):
    return np.tile(np.repeat([1.0, -1.0], samples // 2), periods)


def test_repeated_steps_give_their_odd_harmonics_and_no_others():
    rng = np.random.default_rng(9)
    u = square_wave(12)
    y = SLOW(u) + 0.01 * rng.standard_normal(u.size)
    found = response_from_arrays({"u": u}, {"y": y}, RATE_HZ, excitation=Periodic(period_s=20.0))
    assert found.frequency_hz.tolist() == pytest.approx((np.arange(1, 100, 2) / 20.0).tolist())
    error = np.abs(found.response[0, 0] - SLOW_TRUTH(found.frequency_hz))
    assert np.all(error < 4.5 * np.sqrt(np.trace(found.covariance, axis1=1, axis2=2)))
    assert found.lines[:2] == ("0.05 Hz", "0.15 Hz")
    # measured with noise, the input shows fewer of them: the 21st harmonic has 4/21 pi = 0.06 of amplitude, and below
    # five standard deviations of what is left after 11 periods nothing is taken
    noisy = u + 0.3 * rng.standard_normal(u.size)
    fewer = response_from_arrays({"u": noisy}, {"y": y}, RATE_HZ, excitation=Periodic(period_s=20.0))
    assert set(np.round(fewer.frequency_hz * 20.0).astype(int)) <= set(range(1, 100, 2))
    assert 8 <= fewer.frequency_hz.size <= 30


def test_a_drift_of_the_whole_record_is_taken_out_on_request():
    u = square_wave(8)
    y = SLOW(u) + 0.002 * np.arange(u.size)
    given = {"excitation": Periodic(period_s=20.0), "band_hz": (0.0, 0.5)}
    straight = response_from_arrays({"u": u}, {"y": y}, RATE_HZ, drift=True, **given)
    assert straight.response[0, 0] == pytest.approx(SLOW_TRUTH(straight.frequency_hz), abs=1e-6)
    left = response_from_arrays({"u": u}, {"y": y}, RATE_HZ, **given)
    assert np.all(np.abs(left.response[0, 0] - SLOW_TRUTH(left.frequency_hz)) > 0.05)
    assert left.frequency_hz.max() < 0.5


def test_chosen_lines_are_measured_and_no_others():
    u = square_wave(4)
    chosen = Periodic(period_s=20.0, lines_hz=[0.05, 0.35])
    found = response_from_arrays({"u": u}, {"y": SLOW(u)}, RATE_HZ, excitation=chosen)
    assert found.frequency_hz.tolist() == pytest.approx([0.05, 0.35])
    assert found.response[0, 0] == pytest.approx(SLOW_TRUTH(found.frequency_hz), rel=1e-6)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"period_s": 0.0}, "period_s = 0.0: expected a positive, finite time"),
        ({"period_s": 20.03}, "period_s = 20.03: expected a whole number of samples at 10 Hz, found 200.3"),
        ({"period_s": 0.2}, "period_s = 0.2: expected at least 4 samples a period, found 2"),
        ({"settling_periods": -1}, "settling_periods = -1: expected a whole number, 0 or more"),
        (
            {"settling_periods": 4},
            "record 1: expected at least 2 whole periods of 20 s after 4 settling, found 0",
        ),
        ({"settling_periods": 3}, "expected at least 2 whole periods of 20 s after 3 settling, found 1"),
        ({"between_records": True}, "between_records: expected more records than inputs, found 1 for 1"),
        ({"lines_hz": [0.05, 0.36]}, "line 0.36 Hz: expected a multiple of 0.05 Hz"),
        ({"lines_hz": [0.05, 6.0]}, "line 6 Hz: expected a multiple of 0.05 Hz, below 5 Hz"),
        ({"lines_hz": [0.05, 0.1]}, "line 0.1 Hz: the input does not stand above its noise there"),
    ],
)
def test_periods_that_do_not_fit_are_told(change, message):
    def estimate(u, **numbers):
        response_from_arrays({"u": u}, {"y": SLOW(u)}, RATE_HZ, excitation=Periodic(**numbers))

    with pytest.raises(ResponseError, match=message):
        estimate(square_wave(4), **({"period_s": 20.0} | change))


def test_records_must_tell_the_inputs_apart():
    u = square_wave(4)
    with pytest.raises(ResponseError, match=r"2 inputs: expected at least 2 records .* found 1"):
        response_from_arrays({"a": u, "b": -u}, {"y": u}, RATE_HZ, excitation=Periodic(period_s=20.0))
    with pytest.raises(ResponseError, match=r"no line .* inputs stand above their noise, differently in each record"):
        response_from_arrays([{"a": u, "b": -u}] * 2, [{"y": u}] * 2, RATE_HZ, excitation=Periodic(period_s=20.0))


@pytest.mark.slow
def test_single_periods_of_many_records_are_enough(expect_honest):
    rng = np.random.default_rng(12)
    lines, found = [1, 2, 4, 7, 11, 18], []
    for _ in range(250):
        inputs, outputs = [], []
        for _ in range(14):
            u = np.tile(multisine(rng, lines), 3)
            noise = 0.1 * noise_of_three(rng, u.size)
            inputs.append({"u": u})
            outputs.append({"y": FAST(u) + noise[1], "z": SLOW(u) + noise[2]})
        excitation = Periodic(period_s=6.4, settling_periods=2, between_records=True)
        found.append(response_from_arrays(inputs, outputs, RATE_HZ, excitation=excitation))
    assert (found[0].degrees_of_freedom == 26.0).all()
    expect_honest(found, truth)
