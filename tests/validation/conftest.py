"""A recording whose truth is known, without any of the package's own models."""

import numpy as np
import pytest
from tests.made_signals import made_channels

from shaftprint.campaign import Campaign
from shaftprint.signals import SetPointCalibration, Signals, WorkingPoint

RATE_HZ = 100.0


def _signals_from(set_point, speed, torque, *, rate_hz=RATE_HZ, start_s=0.0):
    """Return prepared signals from deviations of set point, speed and torque from the working point."""
    point = WorkingPoint(
        engine_speed_rev_s=20.0,
        shaft_torque_nm=1700.0,
        engine_speed_std_rev_s=0.01,
        shaft_torque_std_nm=5.0,
        set_point_v=-5.0,
        load_std=0.0,
    )
    speeds = {"n_e": {"channel": "PTM_e", "values": 20.0 * (1.0 + speed)}}
    return Signals(
        rate_hz=rate_hz,
        start_s=start_s,
        channels=made_channels(point, 20.0 * (1.0 + set_point), 1700.0 * (1.0 + torque), speeds),
        working_point=point,
        calibration=SetPointCalibration(
            slope_rev_s_per_v=-4.0,
            intercept_rev_s=0.0,
            covariance=np.eye(2) * 1e-6,
            level_v=np.array([-5.0]),
            level_rev_s=np.array([20.0]),
            level_std_rev_s=np.array([0.01]),
        ),
        dc_scale=1.0,
        dc_scale_std=0.001,
        strips=(),
        step_delays=(),
        repairs=(),
        mode="shaftprint",
        recording_sha256="ab" * 32,
        recording_name="made.nc",
    )


@pytest.fixture(scope="session")
def signals_from():
    """The function that makes signals from deviations."""
    return _signals_from


@pytest.fixture(scope="session")
def campaign():
    """Sines, a staircase, a short chirp and a long one in two parts, with quiet stretches between them."""
    sine = {"name": "S1", "frequency_hz": 0.1, "amplitude_v": 0.6, "start_s": 60, "settled_s": 70, "stop_s": 120}
    chirps = (("C11", 0.01, 3.0, 500, 700), ("C21", 0.01, 0.2, 800, 900), ("C22", 0.2, 3.0, 950, 1050))
    return Campaign(
        name="test",
        duration_s=1100.0,
        offset_v=-5.0,
        sines=(sine,),
        staircases=({"name": "St1", "levels_v": (-4, -5, -6, -5), "dwell_s": 40, "start_s": 200},),
        chirps=tuple(
            {
                "name": name,
                "start_frequency_hz": low,
                "stop_frequency_hz": high,
                "amplitude_v": 0.6,
                "start_s": start,
                "stop_s": stop,
            }
            for name, low, high, start, stop in chirps
        ),
    )
