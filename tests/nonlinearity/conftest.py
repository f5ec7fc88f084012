"""Signals of simulated lines whose nonlinearities are known, with noise as perfect sensors would show it."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from shaftprint.campaign import Campaign
from shaftprint.nonlinearity import Nonlinearities, detect
from shaftprint.signals import SetPointCalibration, Signals, SpeedSignal, WorkingPoint
from shaftprint.tug import Noise, Tug, simulate_signals
from shaftprint.vessel import Vessel, load_vessel

PROCESS = Noise().without(measurement=True, faults=True)
NO_LOWER_LIMIT = {"motoring_torque_nm": 9000.0}
GOVERNOR = {"K_p": 5.0, "K_i": 4.0, "t_d": 0.08, "omega_n": 11.0, "zeta": 0.55, "t_sp": 0.05}


def without_limit(vessel: Vessel) -> Vessel:
    """Return the vessel with an engine that has far more torque than any step asks for, and a gauge that shows it."""
    engine = vessel.engine.model_copy(
        update={"full_load_speed_rpm": (100.0, 4000.0), "full_load_torque_nm": (9000.0, 9000.0)}
    )
    return with_wide_gauge(vessel.model_copy(update={"engine": engine}))


def with_wide_gauge(vessel: Vessel) -> Vessel:
    gauge = vessel.sensors.shaft_torque
    wide = gauge.model_copy(update={"full_scale_nm": 12000.0, "scale_nm_per_unit": 2.0 * gauge.scale_nm_per_unit})
    return vessel.model_copy(update={"sensors": vessel.sensors.model_copy(update={"shaft_torque": wide})})


def sines_and_steps(dwell_s: float) -> Campaign:
    """Sines at two levels of amplitude, steps of 1 V and of 2 V."""
    plan = [
        (0.06, 0.6, 3),
        (0.15, 0.6, 5),
        (0.32, 0.6, 8),
        (0.62, 0.3, 12),
        (1.2, 0.2, 24),
        (0.16, 0.15, 5),
        (0.3, 0.15, 8),
    ]
    sines: list[dict[str, Any]] = []
    time_s = 15.0
    for number, (frequency, amplitude, periods) in enumerate(plan, start=1):
        stop_s = time_s + 6.0 + periods / frequency + 0.01
        sines.append(
            {"name": f"S{number}", "frequency_hz": frequency, "amplitude_v": amplitude,
             "start_s": time_s, "settled_s": time_s + 6.0, "stop_s": stop_s}
        )  # fmt: skip
        time_s = float(np.ceil(stop_s)) + 2.0
    stairs = []
    for name, levels in (("St1", [-4.0, -5.0, -6.0, -5.0, -4.0]), ("St2", [-3.0, -5.0, -7.0, -5.0, -3.0])):
        stairs.append({"name": name, "levels_v": levels, "dwell_s": dwell_s, "start_s": time_s})
        time_s += dwell_s * len(levels) + 12.0
    return Campaign.model_validate(
        {"name": "two levels", "duration_s": time_s, "offset_v": -5.0, "sines": sines, "staircases": stairs}
    )


@pytest.fixture(scope="session")
def vessel() -> Vessel:
    return load_vessel("stan-tug-1205")


@pytest.fixture(scope="session")
def strong(vessel: Vessel) -> Vessel:
    return without_limit(vessel)


@pytest.fixture(scope="session")
def wide(vessel: Vessel) -> Vessel:
    """The vessel with a gauge that shows steps of 2 V whole, ripple and all."""
    return with_wide_gauge(vessel)


@pytest.fixture(scope="session")
def campaign() -> Campaign:
    return sines_and_steps(12.0)


Make = Callable[..., Signals]


@pytest.fixture(scope="session")
def make(campaign: Campaign) -> Make:
    """Signals of a line with process noise and a little noise of the gauge."""

    def signals(
        vessel: Vessel, *, seed: int | None, noise: Noise = PROCESS, gauge: float = 0.02, **truth: Any
    ) -> Signals:
        tug = Tug(noise=noise, **truth)
        true = simulate_signals(vessel, campaign, tug=tug, seed=seed, longest_step_s=2.5e-3)
        rng = np.random.default_rng([7, 0 if seed is None else seed])
        torque = true.shaft_torque_nm * (1.0 + gauge * rng.standard_normal(true.time_s.size))
        speed = SpeedSignal(
            name="n_e", channel="PTM", speed_rev_s=true.engine_speed_rev_s, pulse_rate_hz=200.0,
            averaging_s=0.0, hold_s=0.0, delay_s=0.0,
        )  # fmt: skip
        return Signals(
            rate_hz=200.0,
            start_s=0.0,
            set_point_rev_s=true.set_point_rev_s,
            shaft_torque_nm=torque,
            speeds={"n_e": speed},
            working_point=WorkingPoint(
                engine_speed_rev_s=19.73, shaft_torque_nm=1725.0, engine_speed_std_rev_s=0.002,
                shaft_torque_std_nm=5.0, set_point_v=-5.049, load_std=0.003,
            ),
            calibration=SetPointCalibration(
                slope_rev_s_per_v=-250.97 / 60.0, intercept_rev_s=-83.467 / 60.0, covariance=1e-8 * np.eye(2),
                level_v=np.array([-5.0]), level_rev_s=np.array([19.73]), level_std_rev_s=np.array([0.002]),
            ),
            dc_scale=1.0,
            dc_scale_std=5e-4,
            strips=(),
            step_delays=(),
            repairs=(),
            mode="shaftprint",
            recording_sha256="0" * 64,
            recording_name="ideal.nc",
        )  # fmt: skip

    return signals


@pytest.fixture(scope="session")
def found(make: Make, campaign: Campaign) -> Callable[..., Nonlinearities]:
    """What the detector finds in a simulated line."""

    def look(vessel: Vessel, *, seed: int | None = 1, **truth: Any) -> Nonlinearities:
        return detect(make(vessel, seed=seed, **truth), campaign, vessel, governor=GOVERNOR)

    return look
