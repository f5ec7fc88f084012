"""The way from the voltage of the lever to the speed that it asks for."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.campaign import load_campaign
from shaftprint.tug import Noise, Tug
from shaftprint.tug.plant._demand import Demand, demanded_speed
from shaftprint.vessel import load_vessel

VESSEL = load_vessel("stan-tug-1205")
STEP_S = 0.005


def test_bent_line_keeps_its_speed_and_slope_at_the_working_point_and_no_other():
    tug = Tug(set_point_slope_rpm_per_v=-250.0, set_point_intercept_rpm=-66.2, set_point_bend_per_v=0.004)
    # -5 V asks for 1183.8 rpm, the working point of the vessel; 2 V beside it the square of 2 counts
    volts = np.array([-7.0, -5.0, -3.0])
    straight = np.array([1683.8, 1183.8, 683.8])
    bent = straight - 0.5 * 0.004 * 250.0 * 4.0 * np.array([1.0, 0.0, 1.0])
    assert 60.0 * demanded_speed(tug, VESSEL, volts) == pytest.approx(bent, rel=1e-9)
    slope = np.diff(60.0 * demanded_speed(tug, VESSEL, np.array([-3.001, -2.999]))) / 0.002
    # the slope grows by 0.4 % with each volt
    assert slope == pytest.approx([-250.0 * (1.0 + 2.0 * 0.004)], rel=1e-6)


def _demanded_rpm(tug: Tug, *, until_s: float, chunk: int):
    campaign = load_campaign("short")
    demand = Demand(tug, VESSEL, campaign, start_s=230.0, step_s=STEP_S)
    count = round(until_s / STEP_S) // chunk
    return 60.0 * np.concatenate([demand.next(chunk, np.zeros(chunk + 1))[:-1] for _ in range(count)])


def test_play_takes_its_width_off_a_swing_and_does_not_depend_on_chunks():
    free = Tug(set_point_latency_s=0.0)
    loose = replace(free, set_point_hysteresis_v=0.02)
    # two periods of the first sine, after the first of which play has no memory of the start
    straight = _demanded_rpm(free, until_s=120.0, chunk=400)
    played = _demanded_rpm(loose, until_s=120.0, chunk=400)
    half = straight.size // 2
    assert np.ptp(straight[half:]) - np.ptp(played[half:]) == pytest.approx(0.02 * 250.97, rel=1e-3)
    assert np.array_equal(played, _demanded_rpm(loose, until_s=120.0, chunk=1200))
    # going up and coming down it lies half of its width behind
    assert np.max(np.abs(played - straight)) == pytest.approx(0.01 * 250.97, rel=1e-6)


def test_scaled_noise_scales_amplitudes_and_no_frequency():
    noise = Noise().scaled(2.0, but=("surge_rms",))
    assert (noise.inflow_rms, noise.blade_order, noise.set_point_rms_v, noise.pulse_jitter_s) == (
        0.028,
        0.07,
        0.0016,
        80e-6,
    )
    assert (noise.surge_rms, noise.hunting_hz, noise.torque_spike_interval_s) == (0.0025, 1.65, 180.0)
