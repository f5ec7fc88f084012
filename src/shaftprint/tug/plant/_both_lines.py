"""A voyage of a ship with two lines: both are stepped in turn, each feels the wash of the other and the same sea."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.campaign._campaign import Campaign
from shaftprint.errors import SettingsError
from shaftprint.tug._noise import Noise
from shaftprint.tug._shared_water import SharedWater
from shaftprint.tug._tug import Tug
from shaftprint.tug.plant._disturbance import Disturbance
from shaftprint.tug.plant._physics import working_point
from shaftprint.tug.plant._pitch import lag
from shaftprint.tug.plant._plant import SPEED, advance
from shaftprint.tug.plant._traces import Traces
from shaftprint.tug.plant._voyage import Forces, ReadyLine, Stretch, empty_traces, forced, ready_line, stretch_of
from shaftprint.vessel._vessel import Vessel

# The wash that meets a block of steps has left the other propeller before the block begins.
_FEWEST_STEPS = 2


def voyage_of_both(
    tugs: Sequence[Tug],
    vessels: Sequence[Vessel],
    campaigns: Sequence[Campaign],
    *,
    water: SharedWater,
    step_s: float,
    steps: int,
    chunk: int,
    sea: Disturbance,
    disturbances: Sequence[Disturbance],
) -> Iterator[tuple[Stretch, Stretch]]:
    """Step both lines from the equilibrium of their set points, in chunks of steps.

    ``tugs``, ``vessels``, ``campaigns``: the truth, the installation and what is asked, port first. ``water``: what
    both propellers share. ``step_s``: length of a step [s]. ``steps``: number of steps. ``chunk``: largest number of
    steps in one stretch; the values do not depend on it. ``sea``, ``disturbances``: streams of what disturbs both
    propellers, and each line alone. Yields the next chunk of port and starboard. Raises SettingsError if the truth is
    not physical, a line sails free, or the wash needs less than two steps.
    """
    _expect_at_the_quay(tugs, vessels)
    late = round(water.wash_delay_s / step_s)
    if late < _FEWEST_STEPS:
        raise SettingsError(
            f"shared water: expected wash_delay_s of at least {_FEWEST_STEPS * step_s:g}, two steps of the simulation, "
            f"found {water.wash_delay_s:g}; give a longer time."
        )
    lines = [
        ready_line(tug, vessel, campaign, step_s=step_s, start_s=0.0)
        for tug, vessel, campaign in zip(tugs, vessels, campaigns, strict=True)
    ]
    washes = [
        _Wash(line, tug, vessel, late=late, steps_of_lag=water.wash_lag_s / step_s)
        for line, tug, vessel in zip(lines, tugs, vessels, strict=True)
    ]
    shares = water.port_share, water.starboard_share
    acting = (forced(one, line, steps=steps, chunk=chunk) for one, line in zip(disturbances, lines, strict=True))
    for (done, of_port), (_, of_starboard) in zip(*acting, strict=True):
        acts = of_port, of_starboard
        count = min(chunk, steps - done)
        felt, _, _ = sea.next(count)
        traces = empty_traces(count), empty_traces(count)
        for first in range(0, count, late - 1):
            block = min(late - 1, count - first)
            nodes = slice(first, first + block + 1)
            # both loads are known before either line is stepped
            loads = [
                act.propeller[nodes] + felt[nodes] - share * other.arriving(block + 1)
                for act, share, other in zip(acts, shares, reversed(washes), strict=True)
            ]
            for line, act, load, trace, wash in zip(lines, acts, loads, traces, washes, strict=True):
                _step(line, act, load, trace, first=first, step_s=step_s)
                wash.leaves(trace.shaft_speed_rev_s[first : first + block])
        port, starboard = (
            stretch_of(trace, act, first=done, start_s=0.0, step_s=step_s)
            for trace, act in zip(traces, acts, strict=True)
        )
        yield port, starboard


def sea_and_own(
    noises: Sequence[Noise], water: SharedWater, step_s: float, rngs: Sequence[np.random.Generator]
) -> tuple[Disturbance, tuple[Disturbance, ...]]:
    """Return the streams of the sea that both propellers feel, of the size of port's, and of what disturbs each line.

    ``noises``: sizes of the disturbances, port first. ``water``: says how much of them both share. ``step_s``: length
    of a step [s]. ``rngs``: random numbers of the sea, of port and of starboard.
    """
    common = math.sqrt(water.sea_share)
    own = math.sqrt(1.0 - water.sea_share)
    still = replace(Noise().without(process=True), **_water_of(noises[0], common))
    sea, *of_lines = rngs
    return Disturbance(still, step_s, sea), tuple(
        Disturbance(replace(noise, **_water_of(noise, own)), step_s, rng)
        for noise, rng in zip(noises, of_lines, strict=True)
    )


def _water_of(noise: Noise, share: float) -> dict[str, float]:
    sizes = {"inflow_rms": noise.inflow_rms, "surge_rms": noise.surge_rms}
    return {
        **sizes,
        "inflow_corner_hz": noise.inflow_corner_hz,
        "surge_hz": noise.surge_hz,
        "surge_damping": noise.surge_damping,
    } | {name: share * size for name, size in sizes.items()}


def _expect_at_the_quay(tugs: Sequence[Tug], vessels: Sequence[Vessel]) -> None:
    for tug, vessel in zip(tugs, vessels, strict=True):
        if tug.sailing is not None:
            raise SettingsError(
                f"vessel {vessel.name}: expected a tug at the quay where both lines are simulated, found one that "
                "sails free; leave out working_point.ship_speed_m_s."
            )


def _step(line: ReadyLine, act: Forces, load: FloatArray, trace: Traces, *, first: int, step_s: float) -> None:
    """Step one line through a block of a chunk, as long as its load."""
    block = load.size - 1
    halves = slice(2 * first, 2 * (first + block) + 1)
    demand, pitch, machine = act.asked[halves], act.pitch.blades[halves], act.machine[halves]
    part = Traces._make(values[first : first + block] for values in trace)
    engine = act.engine[first : first + block + 1]
    advance(step_s, demand, pitch, machine, load, engine, line.plant, line.delay, line.carried, part)


class _Wash:
    """The wash of one propeller, on its way to the other: how much faster it is than at the working point, a share."""

    def __init__(self, line: ReadyLine, tug: Tug, vessel: Vessel, *, late: int, steps_of_lag: float) -> None:
        speed, _ = working_point(tug, vessel)
        self._point_rev_s = speed / vessel.gearbox.ratio
        self._keep = math.exp(-1.0 / steps_of_lag)
        self._ramp = 1.0 - (1.0 - self._keep) * steps_of_lag
        # before the recording it ran steadily
        self._speed = self._wash = line.carried.state[SPEED] / self._point_rev_s - 1.0
        self._under_way: FloatArray = np.full(late, self._wash)

    def arriving(self, nodes: int) -> FloatArray:
        """Return what gets there at the next nodes, shape (nodes,)."""
        return self._under_way[:nodes]

    def leaves(self, shaft_speed_rev_s: FloatArray) -> None:
        """Take the shaft speed at the nodes that were passed, and let go of as many that have got there."""
        wash: FloatArray = shaft_speed_rev_s / self._point_rev_s - 1.0
        speed = float(wash[-1])
        lag(wash, self._speed, self._wash, self._keep, self._ramp)
        self._speed, self._wash = speed, float(wash[-1])
        self._under_way = np.concatenate([self._under_way[wash.size :], wash])
