"""Optical pick-ups: pulse voltages of reflecting strips that pass by on a turning shaft."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray, IntArray
from shaftprint.kernels._compiled import compiled
from shaftprint.tug._tug import Tug
from shaftprint.tug.plant._voyage import Stretch
from shaftprint.tug.sensors._counts import VOLT_PER_COUNT, LoggedChannel
from shaftprint.tug.sensors._faults import Fault, draw_times
from shaftprint.tug.sensors._turns import motion_of, turns_of
from shaftprint.vessel._sensors import SpeedSensor
from shaftprint.vessel._vessel import Vessel

_LOW_V, _HIGH_V = 0.35, 4.6
# The light spot is about half as wide as a strip, which gives each edge this fraction of the pulse width.
_RAMP = 0.6
# A pick-up for teeth has a pulse former.
_RAMP_OF_TEETH = 0.1
# Where the tooth between two places stands.
_BETWEEN = 0.45
# A doubled pulse: a reflection of this width, this far behind the middle of the strip (in pulse widths).
_GHOST_OFFSET, _GHOST_WIDTH, _GHOST_RAMP = 1.2, 0.6, 0.3
_NORMAL, _MISSING, _DOUBLED = 0, 1, 2


class _Strips(NamedTuple):
    """Geometry of one pick-up; angles in revolutions of its own shaft."""

    turns: float
    """Revolutions of the shaft with the strips for one of the propeller shaft."""
    phase_rev: float
    middle_rev: FloatArray
    """Middle of each strip within a revolution, ascending, shape (strips,)."""
    width_rev: float
    ramp_rev: float
    rate_hz: float


@compiled(inline="always")
def _reflection(distance, width, ramp):  # type: ignore[no-untyped-def]
    """Return the reflected light [0 to 1] at a distance from the middle of a strip: a smooth trapezoid."""
    part = (0.5 * width - abs(distance)) / ramp + 0.5
    part = min(max(part, 0.0), 1.0)
    return part * part * (3.0 - 2.0 * part)


class _View(NamedTuple):
    """What the pick-up carries from chunk to chunk, and the faults that wait for it."""

    place: IntArray
    """Strip in view, its kind, next missing and next doubled pulse, samples done, shape (5,)."""
    shift_rev: FloatArray
    """Angle by which jitter moves the strip in view, shape (1,)."""
    jitter_s: FloatArray
    """Jitter of each pulse [s], shape (pulses,)."""
    missing_s: FloatArray
    """Times after which the next pulse is missing; the time of its edge once it has passed."""
    doubled_s: FloatArray
    """Times after which the next pulse is doubled; the time of its edge once it has passed."""


@compiled(inline="always")
def _middle(strip, strips):  # type: ignore[no-untyped-def]
    """Return the angle of the middle of a strip, counted on from strip 0 of the first revolution [rev]."""
    per_turn = strips.middle_rev.size
    return strip // per_turn + strips.middle_rev[strip % per_turn]


@compiled(inline="always")
def _fault_of(time, edge_s, view):  # type: ignore[no-untyped-def]
    """Return the kind of the pulse that comes into view, and note the time of its edge where it is a fault."""
    counters = view.place
    if counters[2] < view.missing_s.size and time >= view.missing_s[counters[2]]:
        view.missing_s[counters[2]] = edge_s
        counters[2] += 1
        return _MISSING
    if counters[3] < view.doubled_s.size and time >= view.doubled_s[counters[3]]:
        view.doubled_s[counters[3]] = edge_s
        counters[3] += 1
        return _DOUBLED
    return _NORMAL


@compiled(nogil=True)
def _pulse_train(angle, speed, noise_v, strips, view, counts) -> None:  # type: ignore[no-untyped-def]
    """Fill the counts of one chunk from the angle and speed of the propeller shaft."""
    counters = view.place
    width = strips.width_rev
    strip, kind, shift = counters[0], counters[1], view.shift_rev[0]
    middle, following = _middle(strip, strips), _middle(strip + 1, strips)
    for j in range(angle.size):
        now = strips.phase_rev + strips.turns * angle[j]
        while now > 0.5 * (middle + following):
            strip += 1
            middle, following = following, _middle(strip + 1, strips)
            turning = strips.turns * speed[j]
            shift = turning * view.jitter_s[strip % view.jitter_s.size]
            time = (counters[4] + j) / strips.rate_hz
            kind = _fault_of(time, time + (middle - 0.5 * width + shift - now) / turning, view)
        light = 0.0
        if kind != _MISSING:
            distance = now - middle - shift
            light = _reflection(distance, width, strips.ramp_rev)
            if kind == _DOUBLED:
                behind = distance - _GHOST_OFFSET * width
                light = max(light, _reflection(behind, _GHOST_WIDTH * width, _GHOST_RAMP * width))
        volt = _LOW_V + (_HIGH_V - _LOW_V) * light + noise_v[j]
        counts[j] = np.int16(np.rint(volt / VOLT_PER_COUNT))
    counters[0], counters[1] = strip, kind
    counters[4] += angle.size
    view.shift_rev[0] = shift


class PickUp:
    """Stream of the raw counts of one speed pick-up."""

    def __init__(
        self,
        sensor: SpeedSensor,
        tug: Tug,
        vessel: Vessel,
        *,
        duration_s: float,
        rate_hz: float,
        rng: np.random.Generator,
    ) -> None:
        noise = tug.noise
        self._rng = rng
        self._noise_v = noise.pulse_rms_v
        words = f"pick-up on the {sensor.shaft} shaft, {sensor.pulses_per_revolution} per revolution"
        self.logged = LoggedChannel(name=sensor.channel, unit=sensor.unit, long_name=words)
        self._sensor = sensor
        marked_edge = _teeth_of(sensor, tug, rng) if sensor.wheel else _strips_of(sensor, tug)
        counted = marked_edge if not sensor.toothed.extra else marked_edge[: -sensor.toothed.extra]
        turns = turns_of(sensor, vessel)
        # pulses do not show which way a shaft turns, but strips and teeth pass in their other order
        forward = -1.0 if vessel.working_point.turns_backward(sensor.shaft) else 1.0
        if forward < 0.0:
            marked_edge, counted = _other_order(marked_edge), _other_order(counted)
        self.angle_rev = np.diff(np.append(counted, 1.0 + counted[0]))
        """Angle from each strip or tooth that is counted to the next [rev], shape (strips,)."""
        width = _pulse_width(sensor)
        middle = np.sort(marked_edge) + (0.5 * width if sensor.edge == "rising" else -0.5 * width)
        # at the start every strip is ahead: the first that passes is strip 1, 2, ... at random
        self._strips = _Strips(
            turns=forward * turns,
            phase_rev=float(rng.uniform(0.0, 1.0)),
            middle_rev=middle,
            width_rev=width,
            ramp_rev=(_RAMP_OF_TEETH if sensor.wheel else _RAMP) * width,
            rate_hz=rate_hz,
        )
        self._view = _View(
            place=np.zeros(5, dtype=np.int64),
            shift_rev=np.zeros(1),
            jitter_s=noise.pulse_jitter_s * rng.standard_normal(_most_pulses(sensor, vessel, duration_s)),
            missing_s=draw_times(noise.missing_pulse_interval_s, duration_s, rng),
            doubled_s=draw_times(noise.doubled_pulse_interval_s, duration_s, rng),
        )

    @property
    def phase_rev(self) -> float:
        """Angle of the shaft at the start, from the marked edge of strip 1 [rev]."""
        return self._strips.phase_rev

    def next(self, stretch: Stretch) -> NDArray[np.int16]:
        """Return the counts of the next stretch, shape (steps,)."""
        counts = np.empty(stretch.time_s.size, dtype=np.int16)
        noise_v = self._rng.standard_normal(counts.size, dtype=np.float32) * np.float32(self._noise_v)
        speed_rev_s, angle_rev = motion_of(self._sensor, stretch)
        _pulse_train(angle_rev, speed_rev_s, noise_v, self._strips, self._view, counts)
        return counts

    def faults(self) -> list[Fault]:
        """Return the faults of the pulses that have passed so far."""
        kinds = (("missing pulse", self._view.missing_s, 2), ("doubled pulse", self._view.doubled_s, 3))
        return [
            Fault(channel=self.logged.name, kind=kind, time_s=float(time))
            for kind, times, index in kinds
            for time in times[: self._view.place[index]]
        ]


def _other_order(marked_edge: FloatArray) -> FloatArray:
    """Return where strips or teeth begin [rev] of a shaft that turns the other way, ascending from the first."""
    return np.asarray(marked_edge[0] + np.sort((marked_edge[0] - marked_edge) % 1.0))


def _strips_of(sensor: SpeedSensor, tug: Tug) -> FloatArray:
    """Return where strips begin [rev], at angles that are the truth's where it has as many, else equal ones."""
    strips = sensor.pulses_per_revolution
    angles = np.array(tug.strip_angles_deg) if len(tug.strip_angles_deg) == strips else np.ones(strips)
    turn: FloatArray = angles / angles.sum()
    return np.concatenate(([0.0], np.cumsum(turn)[:-1]))


def _teeth_of(sensor: SpeedSensor, tug: Tug, rng: np.random.Generator) -> FloatArray:
    """Return where the teeth of a wheel begin [rev], those that are counted first, with errors of their pitch.

    Gaps end equal parts of the turn; further teeth stand behind the first places of such parts.
    """
    wheel = sensor.toothed
    ends = [wheel.places * (part + 1) // len(wheel.missing) for part in range(len(wheel.missing))]
    empty = {end - 1 - k for end, gap in zip(ends, wheel.missing, strict=True) for k in range(gap)}
    teeth = [float(place) for place in range(wheel.places) if place not in empty]
    teeth += [wheel.places * part // wheel.extra + _BETWEEN for part in range(wheel.extra)]
    errors_rev = tug.tooth_error_deg / 360.0 * rng.standard_normal(len(teeth))
    return np.array(teeth) / wheel.places + errors_rev


def _pulse_width(sensor: SpeedSensor) -> float:
    """Return the width of a pulse at half height [rev].

    Where it is not given, half of the distance between the closest teeth, or 7 % of a turn or a third of the distance
    between strips.
    """
    if sensor.pulse_width_deg is not None:
        return sensor.pulse_width_deg / 360.0
    if sensor.wheel:
        return 0.5 / sensor.toothed.closest
    return min(0.07, 1.0 / (3.0 * sensor.pulses_per_revolution))


def _most_pulses(sensor: SpeedSensor, vessel: Vessel, duration_s: float) -> int:
    """Return more pulses than can pass: the engine does not run 30 % above its rated speed."""
    turns = 1.3 * vessel.machine.rated_speed_rpm / 60.0 * duration_s / vessel.gearbox.engine_over(sensor.shaft)
    return int(turns * (sensor.pulses_per_revolution + sensor.toothed.extra)) + 16
