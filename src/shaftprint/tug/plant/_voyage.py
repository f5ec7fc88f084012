"""A voyage: the propulsion line stepped through a campaign, chunk by chunk."""

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray
from shaftprint.campaign import Campaign
from shaftprint.errors import SettingsError
from shaftprint.tug._tug import Tug
from shaftprint.tug.plant._demand import Demand
from shaftprint.tug.plant._disturbance import Disturbance
from shaftprint.tug.plant._machine import GearedMachine
from shaftprint.tug.plant._physics import build_plant, equilibrium, steady_boost
from shaftprint.tug.plant._pitch import PitchActuator
from shaftprint.tug.plant._plant import FARTHEST_SHARE, RACK, advance, interpolation_weights
from shaftprint.tug.plant._traces import Carried, DelayTaps, Traces
from shaftprint.vessel import Vessel


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Stretch:
    """What really happens in one chunk of a voyage, one value at the start of each step."""

    time_s: FloatArray
    """Time [s], shape (steps,)."""
    shaft_speed_rev_s: FloatArray
    """Speed of the propeller shaft [rev/s], shape (steps,)."""
    shaft_angle_rev: FloatArray
    """Angle of the propeller shaft since the start [rev], shape (steps,)."""
    shaft_torque_nm: FloatArray
    """Torque at the gauge [N m], shape (steps,)."""
    brake_torque_nm: FloatArray
    """Brake torque of the engine [N m], engine side, shape (steps,)."""
    rack_given: FloatArray
    """Fuel rack that the governor gives, after its limiter and before the delay [fraction], shape (steps,)."""
    limited: BoolArray
    """Whether a limit of torque or rack acts, shape (steps,)."""
    machine_nm: FloatArray
    """Torque of the electric machine on the gearbox, at the propeller shaft [N m], 0 where there is none, shape
    (steps,)."""
    ship_speed_m_s: FloatArray
    """Speed of the ship through the water [m/s], 0 at the quay, shape (steps,)."""
    demand_rev_s: FloatArray
    """Speed that the control unit has been asked for [rev/s], engine side, shape (steps,)."""


def voyage(
    tug: Tug,
    vessel: Vessel,
    campaign: Campaign,
    *,
    step_s: float,
    steps: int,
    chunk: int,
    start_s: float = 0.0,
    disturbance: Disturbance,
) -> Iterator[Stretch]:
    """Step the line from the equilibrium of the set point at ``start_s``, in chunks of steps.

    Parameters
    ----------
    tug, vessel, campaign
        The truth, the installation and what is asked of it.
    step_s
        Length of a step [s].
    steps
        Number of steps.
    chunk
        Largest number of steps in one stretch; the values do not depend on it.
    start_s
        Time of the first step [s].
    disturbance
        Stream of the process disturbances, made for the same step.

    Yields
    ------
    stretch
        The next chunk.

    Raises
    ------
    SettingsError
        If the truth is not physical, or the delay in the loop is shorter than three steps and not zero.
    """
    plant = build_plant(tug, vessel)
    demand = Demand(tug, vessel, campaign, start_s=start_s, step_s=step_s)
    pitch = PitchActuator(tug, vessel, campaign, start_s=start_s, step_s=step_s)
    machine = GearedMachine(tug, vessel, campaign, plant.machine_nm, start_s=start_s, step_s=step_s)
    delay_steps = plant.delay_s / step_s
    farthest = FARTHEST_SHARE ** abs(plant.delay_exponent)
    # the delayed rack is interpolated over four nodes of which the newest must already be known
    if 0.0 < delay_steps < 3.0 * farthest:
        raise SettingsError(
            f"tug: expected governor_delay_s of 0 or at least {3.0 * step_s * farthest:g}, three steps of the "
            f"simulation at every speed, found {plant.delay_s:g}; give a longer delay or none."
        )
    delay = _delay(delay_steps)
    state = equilibrium(plant, demand.first)
    ring = np.full(1 << int(np.ceil(np.log2(farthest * delay_steps + 8.0))), state[RACK])
    boost = np.array([steady_boost(plant, demand.first)])
    carried = Carried(state=state, history=ring, counter=np.zeros(1, dtype=np.int64), boost=boost)
    forced = _forced(disturbance, demand, pitch, machine, steps=steps, chunk=chunk)
    for done, (asked, angle_asked, geared, propeller, engine) in forced:
        count = min(chunk, steps - done)
        speed, angle, torque, brake, rack, way = np.empty((6, count))
        limited = np.empty(count, dtype=np.bool_)
        traces = Traces(speed, angle, torque, brake, rack, limited, way)
        advance(step_s, asked, angle_asked, geared, propeller, engine, plant, delay, carried, traces)
        yield Stretch(
            time_s=start_s + step_s * np.arange(done, done + count, dtype=np.float64),
            shaft_speed_rev_s=speed,
            shaft_angle_rev=angle,
            shaft_torque_nm=torque,
            brake_torque_nm=brake,
            rack_given=rack,
            limited=limited,
            machine_nm=geared[: 2 * count : 2],
            ship_speed_m_s=way,
            demand_rev_s=asked[: 2 * count : 2],
        )


def _forced(
    disturbance: Disturbance,
    demand: Demand,
    pitch: PitchActuator,
    machine: GearedMachine,
    *,
    steps: int,
    chunk: int,
) -> Iterator[tuple[int, tuple[FloatArray, ...]]]:
    """Yield the first step of each chunk and what acts in it; the next is made while the line is stepped through one.

    It is demand, pitch, torque of the electric machine, and disturbances of propeller and engine.
    """

    def acting(count: int) -> tuple[FloatArray, ...]:
        propeller, engine, wander = disturbance.next(count)
        return demand.next(count, wander), pitch.next(count), machine.next(count), propeller, engine

    with ThreadPoolExecutor(max_workers=1) as ahead:
        waiting = ahead.submit(acting, min(chunk, steps))
        for done in range(0, steps, chunk):
            acts = waiting.result()
            left = steps - done - chunk
            if left > 0:
                waiting = ahead.submit(acting, min(chunk, left))
            yield done, acts


def _delay(steps: float) -> DelayTaps:
    """Return where the delayed rack is found at the stages of a step, for a delay in steps."""
    parts = [interpolation_weights(stage - steps) for stage in (0.0, 0.5, 1.0)]
    return DelayTaps(
        first=np.array([node for node, _ in parts], dtype=np.int64),
        weights=np.array([weight for _, weight in parts]),
        steps=steps,
    )
