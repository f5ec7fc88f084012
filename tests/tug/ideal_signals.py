"""What perfect sensors would show: set point, speed and torque of a voyage without a measurement chain."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray, frozen_bool, frozen_float
from shaftprint.campaign import Campaign
from shaftprint.tug._tug import Tug
from shaftprint.tug.plant._demand import demanded_speed, helm_voltage
from shaftprint.tug.plant._disturbance import Disturbance
from shaftprint.tug.plant._voyage import Stretch, voyage
from shaftprint.vessel import Vessel

_CHUNK = 1 << 17


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class IdealSignals:
    """True signals of a voyage on a uniform time grid."""

    time_s: FloatArray
    """Time [s], shape (samples,)."""
    set_point_rev_s: FloatArray
    """Engine speed that the voltage asks for by the true line, without latency [rev/s], shape (samples,)."""
    engine_speed_rev_s: FloatArray
    """Engine speed [rev/s], shape (samples,)."""
    shaft_torque_nm: FloatArray
    """Torque at the gauge [N m], shape (samples,)."""
    brake_torque_nm: FloatArray
    """Brake torque of the engine [N m], shape (samples,)."""
    rack_given: FloatArray
    """Fuel rack ``X`` that the governor gives, before the delay and the actuation [fraction], shape (samples,)."""
    limited: BoolArray
    """Whether a limit of torque or rack acts, shape (samples,)."""
    ship_speed_m_s: FloatArray
    """Speed of the ship through the water [m/s], 0 at the quay, shape (samples,)."""


def simulate_signals(
    vessel: Vessel,
    campaign: Campaign,
    *,
    tug: Tug | None = None,
    seed: int | None = None,
    rate_hz: float = 200.0,
    start_s: float = 0.0,
    stop_s: float | None = None,
    longest_step_s: float = 5e-4,
) -> IdealSignals:
    """Simulate what perfect sensors would show, from the equilibrium of the set point at ``start_s``.

    Parameters
    ----------
    vessel, campaign
        The installation and what is asked of it.
    tug
        The truth; the reference truth when not given.
    seed
        Seed of the process disturbances; without it there are none.
    rate_hz
        Sample rate of the signals [Hz].
    start_s, stop_s
        Part of the campaign [s]; to its end when ``stop_s`` is not given.
    longest_step_s
        Upper bound of the time step [s]; the step divides the sample interval.

    Raises
    ------
    SettingsError
        If the truth is not physical.
    """
    tug = Tug.stan_tug_1205() if tug is None else tug
    stop_s = campaign.duration_s if stop_s is None else stop_s
    every = int(np.ceil(1.0 / (rate_hz * longest_step_s) - 1e-9))
    step_s = 1.0 / (rate_hz * every)
    samples = round((stop_s - start_s) * rate_hz)
    if seed is None:
        disturbance = Disturbance.none(step_s)
    else:
        disturbance = Disturbance(tug.noise, step_s, np.random.default_rng(seed))
    stretches = voyage(
        tug,
        vessel,
        campaign,
        step_s=step_s,
        steps=samples * every,
        chunk=_CHUNK // every * every,
        start_s=start_s,
        disturbance=disturbance,
    )
    speed, torque, brake, rack, way, limited = _sampled(stretches, every)
    speed *= vessel.working_point.turning * vessel.gearbox.ratio
    time = start_s + np.arange(samples) / rate_hz
    return IdealSignals(
        time_s=frozen_float(time),
        set_point_rev_s=frozen_float(demanded_speed(tug, vessel, helm_voltage(tug, campaign, time))),
        engine_speed_rev_s=frozen_float(speed),
        shaft_torque_nm=frozen_float(torque),
        brake_torque_nm=frozen_float(brake),
        rack_given=frozen_float(rack),
        limited=frozen_bool(limited),
        ship_speed_m_s=frozen_float(way),
    )


def _sampled(
    stretches: Iterable[Stretch], every: int
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray, BoolArray]:
    """Return every so many steps of shaft speed, torques, rack and ship, and whether a limit acted in any between."""
    # copies: a view would keep every step in memory
    parts = [
        (
            stretch.shaft_speed_rev_s[::every].copy(),
            stretch.shaft_torque_nm[::every].copy(),
            stretch.brake_torque_nm[::every].copy(),
            stretch.rack_given[::every].copy(),
            stretch.ship_speed_m_s[::every].copy(),
            stretch.limited.reshape(-1, every).any(axis=1),
        )
        for stretch in stretches
    ]
    speed, torque, brake, rack, way, limited = (np.concatenate(part) for part in zip(*parts, strict=True))
    return speed, torque, brake, rack, way, limited
