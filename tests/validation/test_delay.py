import numpy as np
import pytest

from shaftprint.validation.measures._delay import remaining_delay

RATE_HZ = 200.0
MARGIN = 200
TIME = np.arange(-MARGIN, 4000 + MARGIN) / RATE_HZ


def wave(time):
    """A band of frequencies up to 1.6 Hz."""
    return 0.1 * np.sin(2.0 * time) + 0.05 * np.sin(5.3 * time + 1.0) + 0.03 * np.sin(9.7 * time + 2.0)


def found(measured, *, slopes=None, covariance=None, autocovariance=(1e-12,)):
    slopes = np.zeros((1, TIME.size)) if slopes is None else slopes
    covariance = np.zeros((1, 1)) if covariance is None else covariance
    return remaining_delay(
        "n", measured, wave(TIME), slopes, covariance, np.array(autocovariance), rate_hz=RATE_HZ, margin=MARGIN
    )


@pytest.mark.parametrize("delay_s", [0.0, 0.00123, -0.0317, 0.1218, 0.4567])
def test_a_pure_delay_is_found_to_a_hundredth_of_a_sample(delay_s):
    measured = 0.3 + 0.8 * wave(TIME[MARGIN:-MARGIN] - delay_s)
    assert found(measured).delay_s == pytest.approx(delay_s, abs=0.01 / RATE_HZ)


def test_its_deviation_is_the_scatter_over_repeats():
    # moving averages of five: noise with a colour
    rng = np.random.default_rng(3)
    inside = wave(TIME[MARGIN:-MARGIN] - 0.05)
    autocovariance = 0.02**2 * np.array([5, 4, 3, 2, 1]) / 5.0
    delays, stated = [], []
    for _ in range(200):
        noise = 0.02 / np.sqrt(5.0) * np.convolve(rng.standard_normal(inside.size + 4), np.ones(5), "valid")
        one = found(inside + noise, autocovariance=autocovariance)
        delays.append(one.delay_s)
        stated.append(one.noise_std_s)
    assert np.mean(delays) == pytest.approx(0.05, abs=4.0 * np.std(delays) / np.sqrt(200.0))
    # a standard deviation from 200 values is known to 5 %
    assert np.std(delays, ddof=1) == pytest.approx(np.mean(stated), rel=0.15)


def test_a_parameter_that_delays_the_model_counts_in_full():
    # df/dp = -df/dt: one unit of the parameter is one second of delay
    step = 1e-6
    slopes = (-(wave(TIME + step) - wave(TIME - step)) / (2.0 * step))[None]
    one = found(wave(TIME[MARGIN:-MARGIN]), slopes=slopes, covariance=np.array([[0.004**2]]))
    assert one.model_std_s == pytest.approx(0.004, rel=1e-3)
    assert one.std_s == pytest.approx(np.hypot(one.noise_std_s, 0.004), rel=1e-3)


def test_a_parameter_that_scales_the_model_says_nothing_of_its_delay():
    one = found(wave(TIME[MARGIN:-MARGIN]), slopes=wave(TIME)[None], covariance=np.array([[0.5**2]]))
    assert one.model_std_s == pytest.approx(0.0, abs=1e-6)


def test_what_comes_far_too_late_has_no_delay():
    slow = np.exp(-0.5 * ((TIME[MARGIN:-MARGIN] - 10.0) / 0.2) ** 2)
    pulse = np.exp(-0.5 * ((TIME - 5.0) / 0.2) ** 2)
    one = remaining_delay(
        "n", slow, pulse, np.zeros((0, TIME.size)), np.zeros((0, 0)), np.array([1e-6]), rate_hz=RATE_HZ, margin=MARGIN
    )
    assert np.isnan(one.delay_s)
    assert np.isnan(one.std_s)


def test_what_goes_the_other_way_has_no_delay():
    ramp = TIME.copy()
    down = -TIME[MARGIN:-MARGIN]
    one = remaining_delay(
        "n", down, ramp, np.zeros((0, TIME.size)), np.zeros((0, 0)), np.array([1e-6]), rate_hz=RATE_HZ, margin=MARGIN
    )
    assert np.isnan(one.delay_s)
