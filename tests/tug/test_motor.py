"""The motor of a simulated ship: its torque by hand, its limits, its small signals."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from tests.tug.ideal_signals import simulate_signals
from tests.tug.linearised import linearised_response

from shaftprint.errors import SettingsError
from shaftprint.tug import Noise, Tug, build_plant, like_stan_tug_1205, normalised_truth
from shaftprint.tug.plant._plant import torque_limits
from shaftprint.tug.sensors._gauge import shaft_orders
from shaftprint.vessel import Vessel, load_vessel

Make = Callable[..., Any]
SPEED_RPM, TORQUE_NM = 350.0, 7026.0


@pytest.fixture(scope="module")
def ferry() -> Vessel:
    return load_vessel("e-ferry-ellen")


@pytest.fixture
def drive(ferry: Vessel, quiet: Noise) -> Tug:
    return replace(like_stan_tug_1205(ferry), noise=quiet)


def closed_form(tug: Tug, frequency_hz: float) -> np.ndarray:
    """Hand-derived closed loop with 44 and 36 kg m2 on either side of the gauge, no gearbox."""
    s = 2j * np.pi * frequency_hz
    up, down = (2.0 * np.pi * inertia * SPEED_RPM / 60.0 / TORQUE_NM for inertia in (44.0, 36.0))
    controller = tug.proportional_gain + tug.integral_gain_per_s / s
    torque = np.exp(-s * tug.governor_delay_s) / (tug.torque_time_s * s + 1.0)
    loop = controller * torque / ((up + down) * s + 2.0)
    speed = loop / (1.0 + loop) * np.exp(-s * tug.set_point_latency_s)
    return np.array([speed, (down * s + 2.0) * speed])


@pytest.mark.parametrize(
    "change",
    [
        {},
        {"torque_time_s": 0.15, "governor_delay_s": 0.0},
        {"proportional_gain": 3.1, "integral_gain_per_s": 2.2, "torque_time_s": 0.0311, "governor_delay_s": 0.0411},
    ],
)
def test_small_signals_are_those_worked_out_by_hand(ferry: Vessel, drive: Tug, change: dict[str, float]) -> None:
    tug = replace(drive, **change)
    frequency = np.geomspace(0.1, 10.0, 40) / (2.0 * np.pi)
    ratio = linearised_response(tug, ferry, frequency)[:, 0] / np.array([closed_form(tug, f) for f in frequency]).T
    assert np.abs(ratio) == pytest.approx(np.ones(ratio.shape), abs=1e-9)
    assert np.degrees(np.angle(ratio)) == pytest.approx(np.zeros(ratio.shape), abs=1e-7)


def test_stepped_motor_follows_a_small_sine_as_worked_out(ferry: Vessel, drive: Tug, ask: Make, sine: Make) -> None:
    frequency = 0.8
    excitation = sine(frequency, 0.003) | {"settled_s": 30.0, "stop_s": 35.01}
    signals = simulate_signals(ferry, ask(36.0, sines=[excitation]), tug=drive)
    window = (signals.time_s >= 30.0) & (signals.time_s < 35.0)
    phase = 2.0 * np.pi * frequency * signals.time_s[window]
    columns = np.stack([np.cos(phase), np.sin(phase), np.ones_like(phase)], axis=1)

    def amplitude(values: np.ndarray) -> complex:
        cosine, sine_part, _ = np.linalg.lstsq(columns, values[window], rcond=None)[0]
        return complex(cosine, -sine_part)

    set_point = amplitude(signals.set_point_rev_s) * 60.0 / SPEED_RPM
    speed = amplitude(signals.engine_speed_rev_s) * 60.0 / SPEED_RPM
    torque = amplitude(signals.shaft_torque_nm) / TORQUE_NM
    assert np.array([speed, torque]) / set_point == pytest.approx(closed_form(drive, frequency), rel=2e-4)


def test_torque_is_constant_to_base_speed_and_power_above(ferry: Vessel, drive: Tug) -> None:
    plant = build_plant(drive, ferry)
    # 750 kW at 500 rpm; 4000 N m come back
    highest = 750e3 / (2.0 * np.pi * 500.0 / 60.0)
    for rpm, share in ((100.0, 1.0), (500.0, 1.0), (550.0, 500.0 / 550.0), (700.0, 500.0 / 700.0)):
        limits = torque_limits.py_func(rpm / 60.0, plant)
        assert limits == pytest.approx((-4000.0 * share, highest * share), rel=2e-5)


def test_a_jump_meets_both_limits_of_the_torque(ferry: Vessel, drive: Tug, ask: Make) -> None:
    tug = replace(drive, proportional_gain=10.0, torque_time_s=0.02, governor_delay_s=0.0)
    campaign = ask(16.0, staircases=[{"name": "St", "levels_v": [-4.0, -6.0, -4.0], "dwell_s": 5.0, "start_s": 0.0}])
    signals = simulate_signals(ferry, campaign, tug=tug, rate_hz=1000.0)
    assert signals.limited.any()
    # what the controller asks for is cut; the torque comes near behind its lag, and never beyond
    rated_nm = 750e3 / (2.0 * np.pi * 10.0)
    assert signals.rack_given.max() * rated_nm == pytest.approx(14324.0, rel=1e-4)
    assert signals.rack_given.min() * rated_nm == pytest.approx(-4000.0, rel=1e-4)
    assert -4000.1 <= signals.brake_torque_nm.min() < -3500.0
    assert 14200.0 < signals.brake_torque_nm.max() <= 14324.1


def test_nothing_fires_in_the_torque_of_a_motor(ferry: Vessel) -> None:
    # shaft, blades and their double
    assert list(shaft_orders(Noise(), ferry)) == [1.0, 4.0, 8.0]


def test_truth_is_told_with_the_lag_of_the_torque(ferry: Vessel, drive: Tug) -> None:
    told = normalised_truth(drive, ferry)
    assert told["T_m"] == drive.torque_time_s
    assert not {"omega_n", "zeta"} & set(told)


@pytest.mark.parametrize("change", [{"g": -0.3}, {"v": 1.2}, {"unboosted_torque_share": 0.6}])
def test_what_only_an_engine_has_is_refused(ferry: Vessel, drive: Tug, change: dict[str, float]) -> None:
    with pytest.raises(SettingsError, match=f"expected no {next(iter(change))} where a motor drives the line"):
        build_plant(replace(drive, **change), ferry)
