"""Simulated drives with known truth, by laws and steps of their own: nothing of the package is used.

Friction is that of LuGre (Canudas de Wit and others, IEEE Transactions on Automatic Control 40, 1995) without a bound
on how fast its bristles bend, or Coulomb's ideal law as impulses of each step, which holds without yielding.
"""

import math
from pathlib import Path

import numba
import numpy as np

MOTOR = {"R": 0.8, "L": 1.2e-3, "K_m": 0.11, "J": 1.4e-3, "d": 4e-4, "T_C": 0.035, "theta_y": 2e-4}
SERVO = {"J": 2.5e-3, "d": 3e-3, "T_C": 0.12, "theta_y": 2e-4, "K_x": 18.0, "K_v": 0.35, "K_iv": 4.0, "t_u": 3e-3}
MICRO_DAMPING_S = 5e-4
RATE_HZ = 500.0


@numba.njit
def _rubbed(speed, torque, bent, inertia, dry, yielding, step):
    """Return speed and bristles after a step under a torque; ideal where nothing yields."""
    if yielding == 0.0:
        free, most = speed + step * torque / inertia, step * dry / inertia
        return (free - most if free > most else (free + most if free < -most else 0.0)), bent
    # implicit in speed and bristles: sigma_0 z + sigma_1 dz/dt
    fade = 1.0 + step * abs(speed) / yielding
    stiff = dry / yielding
    into, damping = step / fade, MICRO_DAMPING_S * stiff / fade
    held = stiff * bent / fade - MICRO_DAMPING_S * stiff * (abs(speed) / yielding) * bent / fade
    after = (speed + step / inertia * (torque - held)) / (1.0 + step / inertia * (stiff * into + damping))
    return after, (bent + step * after) / fade


@numba.njit
def _motor(voltage, load, interval, finer, resistance, inductance, constant, inertia, viscous, dry, yielding):
    step = interval / finer
    speed = current = bent = 0.0
    motion = np.zeros((voltage.size, 2))
    for k in range(voltage.size - 1):
        for part in range(finer):
            share = (part + 0.5) / finer
            u = voltage[k] + share * (voltage[k + 1] - voltage[k])
            torque_of_load = load[k] + share * (load[k + 1] - load[k])
            fade = 0.5 * step * resistance / inductance
            before = current
            current = (before * (1.0 - fade) + step * (u - constant * speed) / inductance) / (1.0 + fade)
            torque = 0.5 * constant * (before + current) - torque_of_load - viscous * speed
            speed, bent = _rubbed(speed, torque, bent, inertia, dry, yielding, step)
        motion[k + 1, 0], motion[k + 1, 1] = speed, current
    return motion


@numba.njit
def _servo(asked, interval, finer, inertia, viscous, dry, yielding, gain_x, gain_v, gain_i, delay, start):
    step = interval / finer
    late = np.zeros(max(round(delay / step), 1))
    angle, speed, integral, bent = start, 0.0, 0.0, 0.0
    motion = np.zeros((asked.size, 2))
    motion[0, 0], motion[0, 1] = start, gain_v * gain_x * (asked[0] - start)
    count = 0
    for k in range(asked.size - 1):
        for part in range(finer):
            wanted = asked[k] + (part + 0.5) / finer * (asked[k + 1] - asked[k])
            error = gain_x * (wanted - angle) - speed
            integral += step * gain_i * error
            torque = late[count % late.size]
            late[count % late.size] = gain_v * error + integral
            count += 1
            before = speed
            speed, bent = _rubbed(speed, torque - viscous * speed, bent, inertia, dry, yielding, step)
            angle += 0.5 * step * (before + speed)
        motion[k + 1, 0] = angle
        motion[k + 1, 1] = gain_v * (gain_x * (asked[k + 1] - angle) - speed) + integral
    return motion


def motor(voltage, load=None, *, interval=1.0 / RATE_HZ, finer=400, **changed):
    """Return speed [rad/s] and current [A] of the motor, from rest."""
    p = MOTOR | changed
    load = np.zeros(voltage.size) if load is None else load
    values = (p[name] for name in ("R", "L", "K_m", "J", "d", "T_C", "theta_y"))
    return _motor(voltage, load, interval, finer, *values).T


def servo(asked, *, interval=1.0 / RATE_HZ, finer=400, start=0.0, **changed):
    """Return angle [rad] and torque [N m] of the servo axis, at rest at the start."""
    p = SERVO | changed
    values = (p[name] for name in ("J", "d", "T_C", "theta_y", "K_x", "K_v", "K_iv", "t_u"))
    return _servo(asked, interval, finer, *values, start).T


def motor_tests(seconds=4.0, seed=3):
    """Return voltage and load of seven kinds of records by name: each begins at rest with no voltage."""
    rng = np.random.default_rng(seed)
    time = np.arange(round(seconds * RATE_HZ)) / RATE_HZ
    none, on = np.zeros(time.size), np.clip((time - 0.1) / 0.02, 0.0, 1.0)
    lines = np.array([0.5, 0.75, 1.25, 2.0, 3.25, 5.25, 8.5, 13.75])
    turns = 2.0 * math.pi * (lines * time[:, None] + rng.random(lines.size))
    return {
        "steps": (on * np.repeat([3.0, 6.0, 2.0, 4.5], time.size // 4), none),
        "binary": (on * np.repeat(rng.choice([-5.0, 5.0], time.size // 50), 50), none),
        "chirp": (on * 5.0 * np.sin(2.0 * math.pi * (0.2 + 2.0 * time) * time), none),
        "sines": (on * np.sin(turns).sum(axis=1) * 1.5, none),
        "coast": (on * np.where(time < 0.5 * seconds, 6.0, 0.0), none),
        "slow": (np.interp(time / seconds, [0.0, 0.25, 0.75, 1.0], [0.0, 1.5, -1.5, 0.0]), none),
        "load": (on * 5.0, 0.15 * np.where((time > 0.4 * seconds) & (time < 0.7 * seconds), 1.0, 0.0)),
    }


def write_csv(path: Path, columns, interval=1.0 / RATE_HZ):
    """Write columns with titles such as ``speed [rad/s]`` behind the time."""
    count = len(next(iter(columns.values())))
    table = np.column_stack([np.arange(count) * interval, *columns.values()])
    np.savetxt(path, table, delimiter=",", header=",".join(["time [s]", *columns]), comments="", fmt="%.9g")
    return path
