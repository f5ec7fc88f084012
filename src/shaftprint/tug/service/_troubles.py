"""What may be wrong with logs of service, or with what was logged: each as a simulated ship would show it.

What somebody trims at the lever needs the load that he sees: a first voyage tells it. The load of a propeller, torque
over the square of the speed, hangs on the water and hardly on the lever, so that the second voyage sees the same.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.campaign._lever_course import LeverCourse
from shaftprint.tug._tug import Tug
from shaftprint.tug.service._habits import Habits

# The eye of somebody who trims averages over so many seconds; a load controller is faster.
_LAG_S, _CONTROLLER_LAG_S = 5.0, 2.0
# A load controller holds this much of the torque of the working point.
_HELD_LOAD = 1.3
_SHIFT_S, _ONCE_S = 0.2, 1.0
# A historian keeps a value until it is this far from the last, over the largest in the log.
_DEADBAND = 0.005
# Astern a propeller takes less than ahead.
_ASTERN_SHARE = 0.7
_ORDERS = ("half_order", "shaft_order", "blade_order", "twice_blade_order", "firing_order")


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Load:
    """What a first voyage told of the load, second by second."""

    time_s: FloatArray
    """Times [s], shape (seconds,)."""
    load: FloatArray
    """Torque over the square of the speed, over its mean, shape (seconds,)."""

    def seen(self, lag_s: float) -> FloatArray:
        """Return the load as somebody sees it who is slow, less its mean, shape (seconds,)."""
        seen = np.zeros(self.load.size)
        for k in range(1, seen.size):
            seen[k] = seen[k - 1] + (self.load[k - 1] - 1.0 - seen[k - 1]) / lag_s
        return seen


@dataclass(frozen=True, kw_only=True, slots=True)
class Channels:
    """What the channels of a log are called."""

    lever: str
    """The set point."""
    speed: str
    """The engine speed."""
    torque: str
    """The shaft torque."""


Logged = Callable[[Mapping[str, FloatArray], float, Channels], dict[str, FloatArray]]
"""Changes what is in a file: values of its channels by name, samples a second, and how they are called."""
Trim = Callable[[LeverCourse, Load, FloatArray], FloatArray]
"""Returns by which share of the speed the lever is moved, at some times [s], for the load of a first voyage."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Trouble:
    """One way in which logs of service mislead."""

    ship: Callable[[Tug], Tug] | None = None
    """Changes the ship."""
    crew: Callable[[Habits], Habits] | None = None
    """Changes what the crew is used to."""
    lever: Trim | None = None
    """How the lever is moved beside what the crew does."""
    is_logged: bool = True
    """Whether the lever is logged as it was moved so; else as it was before."""
    logged: Logged | None = None
    """Changes what the logger keeps."""


def trimmed(course: LeverCourse, trim: Trim, load: Load, *, line: tuple[float, float]) -> LeverCourse:
    """Return a course whose lever is trimmed.

    ``course``: the course without that. ``trim``: by how much. ``load``: what a first voyage told. ``line``: speed at
    zero volts and for one volt [rev/min, rev/min per V].
    """
    corners = np.array(course.corner_s)
    times = np.unique(np.concatenate([corners, np.arange(0.0, course.duration_s, 1.0)]))
    # two corners closer than that are one
    times = times[np.concatenate([[True], np.diff(times) > 1e-6])]
    rpm = line[0] + line[1] * course.voltage(times)
    rpm = rpm * (1.0 + trim(course, load, times))
    return course.model_copy(
        update={"corner_s": tuple(times.tolist()), "corner_v": tuple(((rpm - line[0]) / line[1]).tolist())}
    )


def _trims(gain: float) -> Trim:
    """Return somebody who holds the torque: at a gain of 1 all of it."""

    def moved(course: LeverCourse, load: Load, times: FloatArray) -> FloatArray:
        return np.asarray(-0.5 * gain * np.interp(times, load.time_s, load.seen(_LAG_S)))

    return moved


def _trims_at_moves(course: LeverCourse, load: Load, times: FloatArray) -> FloatArray:
    """Return somebody who holds the torque, but moves the lever only when he does so anyway."""
    ends = np.array(course.corner_s)[2::2]
    seen = np.interp(ends, load.time_s, load.seen(_LAG_S))
    starts = np.array(course.corner_s)[1::2][: ends.size]
    # from one level to the next as the hand goes
    knots, levels = np.column_stack([starts, ends]).ravel(), np.column_stack([np.r_[0.0, seen[:-1]], seen]).ravel()
    return np.asarray(-0.5 * np.interp(times, knots, levels))


def _load_controller(course: LeverCourse, load: Load, times: FloatArray) -> FloatArray:
    """Return a controller that takes the demand back where the torque would be beyond what it holds."""
    volts = course.voltage(load.time_s)
    speed = volts / course.voltage(np.array([0.0]))
    torque = (1.0 + load.seen(_CONTROLLER_LAG_S)) * speed**2
    return np.interp(times, load.time_s, np.minimum(np.sqrt(_HELD_LOAD / np.maximum(torque, 1e-3)) - 1.0, 0.0))


def _shifted(late_s: float) -> Logged:
    def logged(values: Mapping[str, FloatArray], rate_hz: float, names: Channels) -> dict[str, FloatArray]:
        late = round(late_s * rate_hz)
        lever = values[names.lever]
        place = np.clip(np.arange(lever.size) - late, 0, lever.size - 1)
        return {**values, names.lever: lever[place]}

    return logged


def _once_a_second(values: Mapping[str, FloatArray], rate_hz: float, names: Channels) -> dict[str, FloatArray]:
    every = round(_ONCE_S * rate_hz)
    lever = values[names.lever]
    return {**values, names.lever: lever[np.arange(lever.size) // every * every]}


def _deadband(values: Mapping[str, FloatArray], rate_hz: float, names: Channels) -> dict[str, FloatArray]:
    kept = {}
    for name, raw in values.items():
        band = _DEADBAND * float(np.abs(raw).max())
        last, held = raw[0], np.empty_like(raw)
        for k, value in enumerate(raw.tolist()):
            if abs(value - last) > band:
                last = value
            held[k] = last
        kept[name] = held
    return kept


def _astern(values: Mapping[str, FloatArray], rate_hz: float, names: Channels) -> dict[str, FloatArray]:
    """Return a log in which the ship goes astern from every other stay on idle to the next."""
    lever, torque = values[names.lever], values[names.torque]
    idles = lever <= lever.min() + 2.0
    stays = np.cumsum(np.diff(idles.astype(np.int8), prepend=np.int8(0)) == 1)
    # messages of two channels may end a sample apart
    backs = ((stays % 2 == 1) & ~idles)[np.minimum(np.arange(torque.size), lever.size - 1)]
    return {**values, names.torque: np.where(backs, -_ASTERN_SHARE, 1.0) * torque}


def _with(**changes: float) -> Callable[[Tug], Tug]:
    """Return what makes a ship another one than the model of service."""
    return lambda tug: replace(tug, **changes)  # type: ignore[arg-type]


def _stronger_orders(tug: Tug) -> Tug:
    noise = tug.noise
    return replace(tug, noise=replace(noise, **{name: 2.0 * getattr(noise, name) for name in _ORDERS}))


TROUBLES: Mapping[str, Trouble] = {
    "lever-late": Trouble(logged=_shifted(_SHIFT_S)),
    "lever-early": Trouble(logged=_shifted(-_SHIFT_S)),
    "trims": Trouble(lever=_trims(1.0)),
    "trims-a-little": Trouble(lever=_trims(0.3)),
    "trims-at-moves": Trouble(lever=_trims_at_moves),
    "load-controller": Trouble(lever=_load_controller),
    "hidden-load-controller": Trouble(lever=_load_controller, is_logged=False),
    "lever-once-a-second": Trouble(logged=_once_a_second),
    "deadband": Trouble(logged=_deadband),
    "orders": Trouble(ship=_stronger_orders),
    "astern": Trouble(crew=lambda habits: replace(habits, idles_per_hour=12.0, declutched=0.0), logged=_astern),
    "clutch-out": Trouble(crew=lambda habits: replace(habits, idles_per_hour=12.0, declutched=1.0)),
    "lever-bent": Trouble(ship=_with(set_point_bend_per_v=0.004)),
    "lever-play": Trouble(ship=_with(set_point_hysteresis_v=0.02)),
    "dynamic-inflow": Trouble(ship=_with(inflow_gain=1.0)),
    "gains-by-speed": Trouble(ship=_with(governor_gain_exponent=0.5)),
    "delay-in-turns": Trouble(ship=_with(governor_delay_exponent=-1.0)),
    "governor-deadband": Trouble(ship=_with(governor_deadband_rpm=3.0)),
    "demand-rate-limit": Trouble(ship=_with(demand_rate_limit_rpm_per_s=300.0)),
    "smoke-limiter": Trouble(ship=_with(unboosted_torque_share=0.55)),
}
"""Troubles by name; names are those of ``choices.SERVICE_TROUBLES``."""
