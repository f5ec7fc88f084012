"""Each nonlinearity alone is named and nothing else; a linear line shows nothing."""

import os
from dataclasses import replace

import numpy as np
import pytest

from shaftprint.errors import SignalError
from shaftprint.nonlinearity import FALSE_ALARM, detect
from shaftprint.tug import Noise

SEEDS = int(os.environ.get("SHAFTPRINT_SEEDS", "12"))
FREE = {"motoring_torque_nm": 9000.0}
STEADY = {"K_p": 5.7, "K_i": 4.27, "t_d": 0.0703, "omega_n": 10.3, "zeta": 0.47, "t_sp": 0.0518}

# name, truth, engine has its own full-load curve, symbol, true value, relative tolerance
CASES = [
    ("torque limit", {}, True, "limit", 1.0, 0.03),
    ("rate limit of the fuel rack", {"rack_rate_limit_per_s": 1.2}, False, "r_x", 1.2 / 0.39707, 0.05),
    ("rate limit of the set point", {"demand_rate_limit_rpm_per_s": 250.0}, False, "r_s_rpm", 250.0, 0.05),
    ("deadband", {"governor_deadband_rpm": 8.0}, False, "d_e_rpm", 8.0, 0.15),
    ("turbocharger lag", {"unboosted_torque_share": 0.5}, True, "air", 0.5, 0.06),
    ("quantised set point", {"demand_resolution_rpm": 20.0}, False, "q_rpm", 20.0, 0.01),
]


def estimate(nonlinearities, name):
    return next(one for finding in nonlinearities.findings for one in finding.estimates if one.name == name)


@pytest.mark.parametrize("seed", [2])
@pytest.mark.parametrize(("kind", "truth", "limited", "name", "value", "tolerance"), CASES, ids=[c[0] for c in CASES])
def test_each_alone_is_named_and_nothing_else(
    found, vessel, strong, kind, truth, limited, name, value, tolerance, seed
):
    told = found(vessel if limited else strong, seed=seed, **FREE, **truth)
    assert [finding.kind for finding in told.findings] == [kind]
    assert kind in told.sentence
    assert not told.linear
    level = estimate(told, name)
    assert level.value == pytest.approx(value, rel=tolerance)
    assert 0.0 < level.std < 0.1 * value
    assert told.start_values[name] == level.value
    assert told.findings[0].p_value < FALSE_ALARM


def test_an_engine_that_is_motored_is_named(found, strong):
    """The truth depends on speed: 300 N m at the working point, of which half is constant."""
    told = found(strong, seed=1)
    assert [finding.kind for finding in told.findings] == ["motoring limit"]
    assert 0.45 < estimate(told, "m_min").value < 0.8


def test_both_limits_of_the_reference_line_are_named(found, vessel):
    told = found(vessel, seed=3)
    assert {finding.kind for finding in told.findings} == {"torque limit", "motoring limit"}
    assert estimate(told, "limit").value == pytest.approx(1.0, rel=0.03)


def test_an_integrator_that_winds_up_is_named_beside_its_limit(found, vessel):
    told = found(vessel, seed=1, **FREE, anti_windup_s=50.0)
    assert {finding.kind for finding in told.findings} == {"torque limit", "governor windup"}
    assert estimate(told, "T_aw").value > 5.0


def test_a_linear_line_shows_nothing(make, campaign, strong):
    """At the stated level any of 12 shows a finding in 1 of 100 such tests; ``SHAFTPRINT_SEEDS=40`` looks at 40."""
    assert FALSE_ALARM <= 1e-3
    alarms = [
        [finding.kind for finding in told.findings]
        for seed in range(100, 100 + SEEDS)
        if not (told := detect(make(strong, seed=seed, **FREE), campaign, strong, governor=STEADY)).linear
    ]
    assert alarms == []


def test_without_start_values_the_governor_is_found(make, campaign, strong):
    told = detect(make(strong, seed=5, **FREE), campaign, strong)
    assert told.linear
    assert told.governor["K_p"] == pytest.approx(5.7, abs=5.0 * told.governor_std["K_p"])
    assert told.governor["K_i"] == pytest.approx(4.27, rel=0.1)
    assert "linear but for its propeller" in told.sentence


def test_signals_of_another_rate_are_refused(make, campaign, strong):
    signals = replace(make(strong, seed=None, noise=Noise().without(process=True, measurement=True)), rate_hz=30.0)
    with pytest.raises(
        SignalError, match="expected signals at a multiple of 100 Hz to look for nonlinearities, found 30"
    ):
        detect(signals, campaign, strong)


def test_signals_of_another_time_are_refused(make, campaign, strong):
    signals = replace(make(strong, seed=None, noise=Noise().without(process=True, measurement=True)), start_s=9e4)
    with pytest.raises(SignalError, match="found signals from 90000 s on without them"):
        detect(signals, campaign, strong)


def test_torque_scale_and_working_point_enter_the_uncertainty(make, campaign, vessel):
    signals = make(vessel, seed=1, **FREE)
    doubtful = replace(signals, working_point=replace(signals.working_point, shaft_torque_std_nm=0.05 * 1725.0))
    sure, unsure = (
        estimate(detect(one, campaign, vessel, governor=STEADY), "limit").std for one in (signals, doubtful)
    )
    # 5 % of the torque is 5 % of its limit, beside what was there
    assert np.sqrt(unsure**2 - sure**2) == pytest.approx(0.05, rel=0.3)
