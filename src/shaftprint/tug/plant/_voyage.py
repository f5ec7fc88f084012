"""A voyage: the propulsion line stepped through a campaign, chunk by chunk."""

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray
from shaftprint.campaign._campaign import Campaign
from shaftprint.errors import SettingsError
from shaftprint.tug._tug import Tug
from shaftprint.tug.plant._constants import Plant
from shaftprint.tug.plant._demand import Demand
from shaftprint.tug.plant._disturbance import Disturbance
from shaftprint.tug.plant._machine import GearedMachine
from shaftprint.tug.plant._physics import build_plant, equilibrium, steady_boost
from shaftprint.tug.plant._pitch import PitchActuator, PitchMotion
from shaftprint.tug.plant._plant import FARTHEST_SHARE, RACK, advance, interpolation_weights
from shaftprint.tug.plant._traces import Carried, DelayTaps, Traces
from shaftprint.vessel._vessel import Vessel


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Stretch:
    """What really happens in one chunk of a voyage, one value at the start of each step."""

    time_s: FloatArray
    """Time [s], shape (steps,)."""
    shaft_speed_rev_s: FloatArray
    """Speed of the propeller shaft [rev/s], shape (steps,)."""
    shaft_angle_rev: FloatArray
    """Angle of the propeller shaft since the start [rev], shape (steps,)."""
    engine_speed_rev_s: FloatArray
    """Speed of the engine at the propeller shaft [rev/s], which differs from the shaft's where a coupling twists, shape
    (steps,)."""
    engine_angle_rev: FloatArray
    """Angle of the engine at the propeller shaft [rev], that of the shaft and the twist, shape (steps,)."""
    shaft_torque_nm: FloatArray
    """Torque at the gauge [N m], shape (steps,)."""
    brake_torque_nm: FloatArray
    """Brake torque of the engine [N m], engine side, shape (steps,)."""
    rack_given: FloatArray
    """Fuel rack that the governor gives, after its limiter and before the delay [fraction], shape (steps,)."""
    limited: BoolArray
    """Whether a limit of torque or rack acts, shape (steps,)."""
    pitch_change: FloatArray
    """What the actuator of a controllable pitch has reached, as the deviation of ``P/D`` from that of the working
    point, shape (steps,)."""
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

    ``tug``, ``vessel``, ``campaign``: the truth, the installation and what is asked of it. ``step_s``: length of a step
    [s]. ``steps``: number of steps. ``chunk``: largest number of steps in one stretch; the values do not depend on it.
    ``start_s``: time of the first step [s]. ``disturbance``: stream of the process disturbances, made for the same
    step. Yields the next chunk. Raises SettingsError if the truth is not physical, or the delay in the loop is shorter
    than three steps and not zero.
    """
    line = ready_line(tug, vessel, campaign, step_s=step_s, start_s=start_s)
    for done, acts in forced(disturbance, line, steps=steps, chunk=chunk):
        yield sailed(line, acts, min(chunk, steps - done), first=done, start_s=start_s, step_s=step_s)


class Forces(NamedTuple):
    """What acts on the line in a chunk."""

    asked: FloatArray
    """Speed that is asked for [rev/s], at nodes and middles."""
    pitch: PitchMotion
    """What the pitch does."""
    machine: FloatArray
    """Torque of an electric machine on the gearbox, at the propeller shaft [N m], at nodes and middles."""
    propeller: FloatArray
    """Deviation of the propeller's torque that is no matter of its speed, at nodes."""
    engine: FloatArray
    """Disturbance of the engine, at nodes."""


class ReadyLine(NamedTuple):
    """A line that runs steadily, ready to be stepped."""

    plant: Plant
    demand: Demand
    pitch: PitchActuator
    machine: GearedMachine
    delay: DelayTaps
    carried: Carried


def ready_line(tug: Tug, vessel: Vessel, campaign: Campaign, *, step_s: float, start_s: float) -> ReadyLine:
    """Return a line in the equilibrium of its set point at a time [s].

    Raises SettingsError if the truth is not physical, or the delay in the loop is shorter than three steps and not
    zero.
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
    return ReadyLine(plant, demand, pitch, machine, delay, carried)


def empty_traces(count: int) -> Traces:
    """Return traces for a number of steps, to be filled."""
    speed, angle, torque, brake, rack, way, engine, turned = np.empty((8, count))
    return Traces(speed, angle, torque, brake, rack, np.empty(count, dtype=np.bool_), way, engine, turned)


def stretch_of(traces: Traces, forces: Forces, *, first: int, start_s: float, step_s: float) -> Stretch:
    """Return filled traces as what really happens from a step on, under what acts from the same step on."""
    count = traces.limited.size
    return Stretch(
        time_s=start_s + step_s * np.arange(first, first + count, dtype=np.float64),
        **traces._asdict(),
        machine_nm=forces.machine[: 2 * count : 2],
        pitch_change=forces.pitch.piston[: 2 * count : 2],
        demand_rev_s=forces.asked[: 2 * count : 2],
    )


def sailed(line: ReadyLine, acts: Forces, count: int, *, first: int, start_s: float, step_s: float) -> Stretch:
    """Step a line on by a number of steps, and return what really happens from a step on."""
    traces = empty_traces(count)
    advance(
        step_s,
        acts.asked,
        acts.pitch.blades,
        acts.machine,
        acts.propeller,
        acts.engine,
        line.plant,
        line.delay,
        line.carried,
        traces,
    )
    return stretch_of(traces, acts, first=first, start_s=start_s, step_s=step_s)


def acting(disturbance: Disturbance, line: ReadyLine, count: int) -> Forces:
    """Return what acts on a line in its next steps."""
    propeller, engine, wander = disturbance.next(count)
    motion = line.pitch.next(count)
    return Forces(
        asked=line.demand.next(count, wander),
        pitch=motion,
        machine=line.machine.next(count),
        propeller=line.pitch.torque_share(motion.blades, propeller),
        engine=engine,
    )


def forced(disturbance: Disturbance, line: ReadyLine, *, steps: int, chunk: int) -> Iterator[tuple[int, Forces]]:
    """Yield the first step of each chunk and what acts in it; the next is made while the line is stepped on."""
    with ThreadPoolExecutor(max_workers=1) as ahead:
        waiting = ahead.submit(acting, disturbance, line, min(chunk, steps))
        for done in range(0, steps, chunk):
            acts = waiting.result()
            left = steps - done - chunk
            if left > 0:
                waiting = ahead.submit(acting, disturbance, line, min(chunk, left))
            yield done, acts


def _delay(steps: float) -> DelayTaps:
    """Return where the delayed rack is found at the stages of a step, for a delay in steps."""
    parts = [interpolation_weights(stage - steps) for stage in (0.0, 0.5, 1.0)]
    return DelayTaps(
        first=np.array([node for node, _ in parts], dtype=np.int64),
        weights=np.array([weight for _, weight in parts]),
        steps=steps,
    )
