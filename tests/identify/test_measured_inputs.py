"""Structures of which an input was measured: the governor alone, on drawn tests of a line that it does not know."""

import numpy as np
import pytest
import scipy.stats

from shaftprint.catalogue import structure
from shaftprint.errors import IdentificationError
from shaftprint.identify import Prior, Settings, identify
from shaftprint.spectra import FrequencyResponse

FREQUENCY_HZ = np.array([0.02, 0.04, 0.08, 0.16, 0.3, 0.6, 1.0, 1.6, 2.4, 3.4])
S = 2j * np.pi * FREQUENCY_HZ
TRUTH = {"K_p": 5.7, "K_i": 4.27, "t_rack": 0.003, "t_sp": 0.052, "c_set": 1.002}
# the process moves speed and rack together, by a thousandth of the set point; each channel has noise of its own
PROCESS, NOISE_N, NOISE_X = 1e-3, 2e-4, 8e-4
SETTINGS = Settings(starts=12)
RACK_KNOWN = Settings(starts=12, priors={"t_rack": Prior(0.0, 0.005)})


def line():
    """Speed and rack over the set point of the whole line, by hand, and the governor alone."""
    drive = 0.9 * np.exp(-0.07 * S) / (0.004 * S**2 + 0.05 * S + 1.0) / (1.3 * S + 2.0)
    governor = (TRUTH["K_p"] + TRUTH["K_i"] / S) * np.exp(-S * TRUTH["t_rack"])
    set_point = TRUTH["c_set"] * np.exp(-S * TRUTH["t_sp"])
    # the rack that the engine has is not late
    loop = governor * np.exp(S * TRUTH["t_rack"]) * drive
    speed = loop / (1.0 + loop) * set_point
    return speed, governor * (set_point - speed), governor


def drawn(rng, sensor_s=0.0):
    """One test: noise of the process, seen in both as the loop passes it on, and that of the channels."""
    speed, rack, governor = line()
    size = S.size

    def noise(std):
        return std * (rng.standard_normal(size) + 1j * rng.standard_normal(size)) / np.sqrt(2.0)

    shaken = noise(PROCESS)
    n = speed + shaken + noise(NOISE_N)
    x = rack - governor * shaken + noise(NOISE_X)
    covariance = np.zeros((size, 2, 2), dtype=complex)
    covariance[:, 0, 0] = PROCESS**2 + NOISE_N**2
    late = np.exp(-S * sensor_s)
    covariance[:, 0, 1] = PROCESS**2 * late * (-governor.conj())
    covariance[:, 1, 0] = covariance[:, 0, 1].conj()
    covariance[:, 1, 1] = PROCESS**2 * np.abs(governor) ** 2 + NOISE_X**2
    half = 0.5 * np.block([[covariance.real, -covariance.imag], [covariance.imag, covariance.real]])
    return FrequencyResponse(
        frequency_hz=FREQUENCY_HZ,
        response=np.stack([n * late, x])[:, None, :],
        covariance=half,
        inputs=("n_set",),
        outputs=("n", "X"),
        pick_up_delay_s=sensor_s,
    )


def fitted(response, settings=RACK_KNOWN):
    return identify(structure("GOVERNOR"), response, rng=np.random.default_rng(2), settings=settings)


@pytest.mark.long
def test_stated_uncertainty_is_the_scatter_and_the_test_of_fit_is_uniform():
    """150 tests: of each number 7.5 are outside of the 95 % interval, and by chance at most 16 of them."""
    rng = np.random.default_rng(41)
    found = [fitted(drawn(rng)) for _ in range(150)]
    for name, true in TRUTH.items():
        z = np.array([(f.value(name) - true) / next(e.std for e in f.parameters if e.name == name) for f in found])
        # chi-square of 150 within its 99.9 % range
        assert 0.65 < z.var() < 1.45, name
        assert np.sum(np.abs(z) > 1.96) <= 16, name
        assert abs(z.mean()) < 3.3 / np.sqrt(150), name
    p = [f.p_value for f in found]
    assert scipy.stats.kstest(p, "uniform").pvalue > 0.001


def test_without_the_latency_of_the_set_point_the_gains_would_be_wrong():
    """What the structure was before: an error formed from the set point as it was measured."""
    held = structure("GOVERNOR").held_at(t_sp=0.0, c_set=1.0)
    wrong = identify(held, drawn(np.random.default_rng(1)), rng=np.random.default_rng(2), settings=SETTINGS)
    assert abs(wrong.value("K_p") / TRUTH["K_p"] - 1.0) > 0.05
    assert wrong.p_value < 1e-9


def test_the_pick_up_is_taken_off_the_measured_speed():
    """The governor has the speed itself; one that is seen 40 ms late and says so gives the same."""
    plain, late = (fitted(drawn(np.random.default_rng(3), sensor_s)) for sensor_s in (0.0, 0.04))
    for name in TRUTH:
        assert late.value(name) == pytest.approx(plain.value(name), rel=1e-6, abs=1e-9)


def test_a_response_without_the_measured_input_is_refused():
    response = drawn(np.random.default_rng(1)).of_outputs("X")
    with pytest.raises(IdentificationError, match="GOVERNOR goes from n_set, n to X, the response from n_set to X"):
        fitted(response)
