"""Two legs at two speeds, from the raw recording on, with nothing known beforehand."""

import numpy as np
import pytest
from tests.measured_truth import as_measured

from shaftprint.campaign import load_campaign
from shaftprint.catalogue import structure
from shaftprint.identify import Settings
from shaftprint.recording import cut, read_recording, write_recording
from shaftprint.survey import fit, leg_tests, load_trial, measure
from shaftprint.tug import sail
from shaftprint.vessel import load_vessel

pytestmark = pytest.mark.slow

GAUGE = structure("GAUGE-CLOSED")
# What one speed does not tell at any length, and how well eleven minutes at two speeds must know it.
KNOWN = {"K_p": 0.03, "K_i": 0.05, "t_d": 0.13, "tau_up": 0.06, "tau_dn": 0.001, "k_q": 0.001}


@pytest.fixture(scope="module")
def trial():
    return load_trial(load_vessel("stan-tug-1205"), load_campaign("two-speeds"))


@pytest.fixture(scope="module")
def voyage(trial, tmp_path_factory):
    path = tmp_path_factory.mktemp("legs") / "legs.nc"
    return path, sail(trial.vessel, trial.campaign, path, seed=12)


def _fitted(measurement):
    (found,) = fit([GAUGE], measurement, settings={GAUGE.name: Settings()}, rng=np.random.default_rng(1))
    return found


def test_two_speeds_find_the_truth_with_nothing_known_beforehand(trial, voyage):
    path, truth = voyage
    assert max(truth.limited.values()) == 0.0
    measurement = measure(path, trial)
    found = _fitted(measurement)
    true = as_measured(truth, measurement.signals)
    distance = {one.name: (one.value - true[one.name]) / one.std for one in found.parameters}
    # twelve numbers: one beyond three deviations in 3 % of the recordings
    assert max(map(abs, distance.values())) < 3.0
    share = {one.name: one.std / one.value for one in found.parameters}
    assert [name for name, most in KNOWN.items() if share[name] > most] == []
    assert found.p_value > 0.01
    assert all(one.test.p_value > 0.01 for one in leg_tests(found, measurement.legs))
    slow = measurement.legs[1].working_point
    # 0.70 of the working speed, and the torque with its square: 1725 N m at 1183.8 rpm
    assert slow.engine_speed_rev_s * 60.0 == pytest.approx(0.70 * 1183.8, rel=2e-3)
    assert slow.shaft_torque_nm == pytest.approx(1725.0 * (slow.engine_speed_rev_s * 60.0 / 1183.8) ** 2, rel=0.02)


def test_a_recording_that_ends_in_the_second_leg_still_gives_a_result(trial, voyage, tmp_path):
    path, truth = voyage
    short = tmp_path / "short.nc"
    with read_recording(path) as recording:
        write_recording(short, cut(recording, to_s=480.0).channels.values())
    measurement = measure(short, trial)
    # M2 is settled at 342 s: four periods of 32 s until 480 s
    assert measurement.legs[1].spectra.remarks["M2"] == "4 of 9 periods are in the recording"
    found = _fitted(measurement)
    true = as_measured(truth, measurement.signals)
    assert max(abs(one.value - true[one.name]) / one.std for one in found.parameters) < 3.5
    assert found.p_value > 0.01
