"""Pieces of the set point as excitations of a campaign file."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from shaftprint.signals.description._course import Course
from shaftprint.signals.description._holds_of import dwell_of
from shaftprint.signals.description._pieces import Repeated, Wave
from shaftprint.signals.description._plain import plainest, plainest_fit
from shaftprint.signals.description._register import Hold, RegisterMatch

# The response to a begin has died out after this, where there is time for it: sines, and legs as plans have them [s].
SETTLED_S, SETTLED_LEG_S = 10.0, 4.0
# A begin is known to so many samples.
_SAMPLES = 1.5
_MOST_SAMPLES = 20_000
_DIGITS = 6


def wave_fields(course: Course, wave: Wave, name: str, last_s: float) -> dict[str, Any] | None:
    """Return the fields of a sine or chirp; None where it holds no period."""
    begin_s, phase_rad = _begin(course, wave, last_s)
    stop_s = plainest(wave.end_s, 1.01 / course.rate_hz, most=4)
    amplitude_v = wave.amplitude_v
    first = {"start_s": begin_s, "frequency_hz": wave.frequency_at(begin_s)}
    if wave.rate:
        first |= {"stop_frequency_hz": wave.frequency_at(stop_s)}
    first |= {"amplitude_v": amplitude_v, "phase_rad": phase_rad}
    cost, samples = _cost(course, wave, stop_s)
    values = plainest_fit(first, cost, samples=samples)
    if values["start_s"] < last_s:
        values |= {"start_s": last_s, "phase_rad": round(wave.phase_at(last_s), _DIGITS)}
    if wave.rate:
        return {
            "name": name,
            "start_frequency_hz": values["frequency_hz"],
            "stop_frequency_hz": values["stop_frequency_hz"],
            "amplitude_v": values["amplitude_v"],
            "sweep": "logarithmic" if wave.is_logarithmic else "linear",
            "phase_rad": values["phase_rad"],
            "start_s": values["start_s"],
            "stop_s": stop_s,
        }
    settled_s = _settled(values["start_s"], stop_s, 1.0 / values["frequency_hz"], SETTLED_S, fewest=1)
    if settled_s is None:
        return None
    return {"name": name, **values, "settled_s": settled_s, "stop_s": stop_s}


def _begin(course: Course, wave: Wave, last_s: float) -> tuple[float, float]:
    """Return when a wave begins [s] and its phase there [rad]: in its middle where no jump shows that it does not."""
    begin_s = max(wave.begin_s, last_s)
    phase_rad, hertz = wave.phase_at(begin_s), wave.frequency_at(begin_s)
    a_sample_v = wave.amplitude_v * 2.0 * math.pi * hertz / course.rate_hz
    if wave.amplitude_v * abs(math.sin(phase_rad)) > course.flat_v + _SAMPLES * a_sample_v:
        return begin_s, phase_rad
    middle = 0.0 if abs(phase_rad) < 0.5 * math.pi else math.pi
    at_s = begin_s
    for _ in range(3):
        rest = math.remainder(wave.phase_at(at_s) - middle, 2.0 * math.pi)
        at_s -= rest / (2.0 * math.pi * wave.frequency_at(at_s))
    return (begin_s, phase_rad) if at_s < last_s else (at_s, middle)


def _cost(course: Course, wave: Wave, stop_s: float) -> tuple[Any, int]:
    """Return the sum of squares that the fields of a wave leave, and of how many samples it is."""
    first, stop = course.index(wave.begin_s), course.index(min(wave.end_s, stop_s))
    every = max((stop - first) // _MOST_SAMPLES, 1)
    time, about = course.times(first, stop)[::every], course.values_v[first:stop:every] - course.offset_v

    def cost(values: Mapping[str, float]) -> float:
        turn = _turn(values, time, stop_s, is_logarithmic=wave.is_logarithmic)
        return float(np.sum((about - values["amplitude_v"] * np.sin(turn + values["phase_rad"])) ** 2))

    return cost, time.size


def _turn(values: Mapping[str, float], time_s: Any, stop_s: float, *, is_logarithmic: bool) -> Any:
    """Return the phase since the start [rad] that fields of a sine or chirp give."""
    elapsed_s, hertz = time_s - values["start_s"], values["frequency_hz"]
    last_hz, length_s = values.get("stop_frequency_hz"), stop_s - values["start_s"]
    if last_hz is None:
        return 2.0 * math.pi * hertz * elapsed_s
    if is_logarithmic and hertz > 0.0 and last_hz > 0.0 and last_hz != hertz:
        growth = math.log(last_hz / hertz)
        return 2.0 * math.pi * hertz * length_s / growth * np.expm1(growth * elapsed_s / length_s)
    return 2.0 * math.pi * (hertz + 0.5 * (last_hz - hertz) / length_s * elapsed_s) * elapsed_s


def _settled(start_s: float, stop_s: float, period_s: float, settled_s: float, *, fewest: int) -> float | None:
    """Return from when on whole periods are analysed [s]; None where there are too few."""
    for rest_s in (settled_s, 1e-6):
        periods = math.floor((stop_s - start_s - rest_s) / period_s + 1e-9)
        if periods >= fewest:
            # down to a microsecond: a window that is too short by rounding would lose a period
            earliest_s = math.floor((stop_s - periods * period_s) * 1e6) / 1e6
            return earliest_s if earliest_s >= start_s else None
    return None


def multisine_fields(course: Course, piece: Repeated, name: str, last_s: float) -> dict[str, Any] | None:
    """Return the fields of a multisine; None where it holds too few periods."""
    start_s = max(plainest(piece.begin_s, 0.1 / course.rate_hz, most=_DIGITS), last_s)
    stop_s = plainest(piece.end_s, 0.1 / course.rate_hz, most=_DIGITS)
    turn = 2.0 * math.pi * piece.harmonics * (start_s - piece.zero_s) / piece.period_s
    phases = np.angle(piece.phasors_v * np.exp(1j * turn)) + 0.5 * math.pi
    # a period is known to a small part of a turn of its fastest line over all periods
    tolerance_s = 1e-3 * piece.period_s**2 / (piece.length_s * float(piece.harmonics.max()))
    period_s = plainest(piece.period_s, tolerance_s)
    settled_s = _settled(start_s, stop_s, period_s, SETTLED_LEG_S, fewest=2)
    if settled_s is None:
        return None
    return {
        "name": name,
        "level_v": round(piece.level_v, _DIGITS),
        "start_s": start_s,
        "settled_s": settled_s,
        "stop_s": stop_s,
        "period_s": period_s,
        "harmonics": tuple(piece.harmonics.tolist()),
        "amplitudes_v": tuple(round(float(size), _DIGITS) for size in np.abs(piece.phasors_v)),
        "phases_rad": tuple(round(float(np.mod(phase, 2.0 * math.pi)), _DIGITS) for phase in phases),
    }


def register_fields(match: RegisterMatch, name: str, last_s: float) -> dict[str, Any] | None:
    """Return the fields of a binary sequence; None where it holds too few periods."""
    clocks = 2 * ((1 << match.order) - 1)
    tolerance_s = 2e-3 * match.clock_s
    clock_s = plainest(match.clock_s, tolerance_s * match.clock_s / (match.end_s - match.begin_s))
    start_s = max(plainest(match.begin_s, tolerance_s, most=4), last_s)
    stop_s = start_s + round((match.end_s - match.begin_s) / match.clock_s) * clock_s
    settled_s = _settled(start_s, stop_s, clocks * clock_s, SETTLED_LEG_S, fewest=2)
    if settled_s is None:
        return None
    return {
        "name": name,
        "level_v": round(match.level_v, 4),
        "amplitude_v": round(match.amplitude_v, 4),
        "clock_s": clock_s,
        "order": match.order,
        "first_clock": match.first_clock,
        "start_s": start_s,
        "settled_s": settled_s,
        "stop_s": stop_s,
    }


def stairs_fields(course: Course, holds: list[Hold], name: str, last_s: float) -> dict[str, Any] | None:
    """Return the fields of a staircase; None where its levels have no common dwell."""
    dwell = dwell_of(holds)
    if dwell is None:
        return None
    dwell_s, counts = dwell
    # a jump is seen to a part of a sample
    tolerance_s = 0.5 / course.rate_hz
    plain_s = plainest(dwell_s, tolerance_s / sum(counts))
    levels = [
        plainest(hold.level_v, 2.0 * course.noise_v / math.sqrt(max(hold.length_s, 1.0)), most=4) for hold in holds
    ]
    return {
        "name": name,
        "levels_v": tuple(level for level, count in zip(levels, counts, strict=True) for _ in range(count)),
        "dwell_s": plain_s,
        "start_s": max(plainest(holds[0].begin_s, tolerance_s, most=4), last_s),
    }
