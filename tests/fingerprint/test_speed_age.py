"""A speed whose messages are older than known makes the delays longer: what is reported counts it."""

from dataclasses import replace

import numpy as np
import pytest
from tests.known_fits import FREQUENCY_HZ, exact_response

from shaftprint.catalogue import structure
from shaftprint.fingerprint._speed_age import AGE_OF_SPEED
from shaftprint.identify import Prior, Settings, identify

GAUGE_STD_S = 0.002
DELAYS = ("t_sp", "t_d + t_sp")


def known_to(age_s):
    sources = {"telemetry latency": GAUGE_STD_S} | ({AGE_OF_SPEED: age_s} if age_s else {})
    gauge = Prior(0.0, float(np.hypot(GAUGE_STD_S, age_s)), sources=sources)
    return Settings(starts=20, priors={"g": Prior(0.0, 0.1), "t_gauge": gauge})


@pytest.fixture(scope="module")
def of_late_speed(truth):
    """Return a fit of speeds that are shown late by a time, which the prior of ``t_gauge`` counts."""

    def of(late_s, age_s):
        response = exact_response(structure("GAUGE-CLOSED"), truth, 0.001)
        shown = response.response * np.array([1.0, 1.0])[:, None, None]
        shown[0] *= np.exp(-2j * np.pi * FREQUENCY_HZ * late_s)
        late = replace(response, response=shown)
        return identify(structure("GAUGE-CLOSED"), late, rng=np.random.default_rng(7), settings=known_to(age_s))

    return of


def test_a_late_speed_is_a_later_set_point_and_an_earlier_torque_and_nothing_else(of_late_speed, truth):
    """Known exactly by its phase: the fit is perfect, so that nothing in it can tell."""
    found = of_late_speed(0.004, age_s=0.1)
    assert found.value("t_sp") == pytest.approx(truth["t_sp"] + 0.004, abs=2e-5)
    assert found.value("t_gauge") == pytest.approx(-0.004, abs=2e-5)
    for name in ("K_p", "K_i", "t_d", "tau_dn", "tau_up", "zeta"):
        assert found.value(name) == pytest.approx(truth[name], rel=2e-3), name
    assert found.chi_square < 0.1


def test_the_delays_count_how_old_the_speed_may_be(of_late_speed, take, truth):
    age_s = 0.02 / np.sqrt(12.0)
    without, counted = take(of_late_speed(0.0, age_s=0.0)), take(of_late_speed(0.005, age_s=age_s))
    for name in DELAYS:
        before, now = without.quantity(name), counted.quantity(name)
        assert now.std == pytest.approx(np.hypot(before.std, age_s), rel=0.05), name
        assert now.interval_95[0] < truth["t_sp"] + ("t_d" in name) * truth["t_d"] < now.interval_95[1]
    for name in ("K_p / K_i", "tau_dn", "I_dn"):
        assert counted.quantity(name).std == pytest.approx(without.quantity(name).std, rel=0.05), name
    assert "t_d + t_sp" in counted.verdict.trusted


def test_a_delay_that_is_mostly_the_age_of_a_slow_speed_is_not_trusted(of_late_speed, take):
    """Ten messages a second: 29 ms of the 122 that are looked for."""
    found = take(of_late_speed(0.0, age_s=0.1 / np.sqrt(12.0)))
    assert found.verdict.not_trusted["t_d + t_sp"] == "it is known to 24 % only"
    assert "t_d + t_sp" in take(of_late_speed(0.0, age_s=0.0)).verdict.trusted
