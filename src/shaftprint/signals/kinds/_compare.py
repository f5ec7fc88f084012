"""The speed channels side by side: on one rigid shaft line they must agree."""

from collections.abc import Mapping, Sequence
from itertools import permutations
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import SignalError
from shaftprint.signals.kinds._speed_reading import SpeedReading

if TYPE_CHECKING:
    from shaftprint.vessel._sensors import SpeedSensor
    from shaftprint.vessel._vessel import Vessel

LARGEST_DIFFERENCE = 1e-2
"""Share by which two pick-ups of one line may differ without an error in the vessel file."""

_FINDING = 1e-3
# All orders of more are tried no longer.
_MOST_SENSORS = 7
# Means of so long tell a slip of a thousandth from the swing of the line between two pick-ups [s].
_BLOCK_S = 5.0
# A wrong ratio is the same all the time: what goes from one tenth of the time to the other by more than this share of
# the difference is none.
_STEADY, _BOTH_SIDES = 0.3, 0.5
# A count is whole within this share of it, and within so many of its teeth.
_WHOLE, _MOST_OFF_WHOLE = 1e-3, 0.05


def compare_speeds(
    speeds: Sequence[SpeedReading], vessel: "Vessel", *, rate_hz: float, start_s: float
) -> tuple[str, ...]:
    """Compare the mean of every speed with that of the first, where both have one.

    ``speeds``: the speed channels, in the order of the vessel file. ``vessel``: says which shaft carries which.
    ``rate_hz``, ``start_s``: their grid. Returns one sentence for each speed that is off by more than 0.1 %. Raises
    SignalError if one is off by more than 1 %: all the time, as with swapped channels or a wrong gear ratio or number
    of strips in the vessel file, or more at one time than at another, as with a clutch that slips or a pick-up that
    loses pulses.
    """
    shafts = {sensor.name: sensor.shaft for sensor in vessel.sensors.speed}
    first = speeds[0]
    steady = {}
    for other in speeds[1:]:
        ratios = _ratios(first, other, rate_hz=rate_hz, start_s=start_s)
        if not ratios.size:
            continue
        ratio = float(np.median(ratios))
        lowest, highest = (float(np.quantile(ratios, share)) for share in (0.1, 0.9))
        farthest = max(abs(lowest - 1.0), abs(highest - 1.0), abs(ratio - 1.0))
        # a speed that is late is as far above as below while the line swings: slip and lost pulses go one way
        to_both_sides = min(highest - 1.0, 1.0 - lowest) > _BOTH_SIDES * farthest
        if farthest > LARGEST_DIFFERENCE and highest - lowest > _STEADY * farthest and not to_both_sides:
            where = "clutch, " if shafts[first.name] != shafts[other.name] else ""
            raise SignalError(
                f"channels {first.channel} and {other.channel}: expected the same engine-side speed, found "
                f"{other.name} / {first.name} between {lowest:.4f} and {highest:.4f}; a wrong gear ratio or count "
                f"would be the same all the time: check {where}pick-ups and cables for slip and for pulses that are "
                "lost."
            )
        steady[other.name] = ratio
    swap = _swap_of(first, steady, vessel)
    if swap:
        raise SignalError(swap)
    findings = []
    for other in speeds[1:]:
        ratio = steady.get(other.name, 1.0)
        if abs(ratio - 1.0) <= _FINDING:
            continue
        message = (
            f"channels {first.channel} and {other.channel}: expected the same engine-side speed, "
            f"found {other.name} / {first.name} = {ratio:.4f}"
        )
        fitting = ""
        if shafts[first.name] != shafts[other.name]:
            # the propeller side was multiplied by the ratio
            power = -1.0 if shafts[other.name] == "propeller" else 1.0
            fitting = f"{vessel.gearbox.ratio * ratio**power:.4f}"
        like, check = what_would_agree({first.name: 1.0, **steady}, vessel, ratio=fitting)
        if abs(ratio - 1.0) > LARGEST_DIFFERENCE:
            raise SignalError(f"{message}{like}; {check}.")
        findings.append(f"{message}{like}")
    return tuple(findings)


def what_would_agree(speeds: Mapping[str, float], vessel: "Vessel", *, ratio: str) -> tuple[str, str]:
    """Return with which counts, or which gear ratio, pick-ups that contradict each other agree, and what to check.

    A count that is whole explains a difference that no one could make of a ratio by chance: it comes first.

    ``speeds``: engine speed that each one gives, by its name, in any one unit. ``ratio``: the gear ratio that fits, in
    words; empty where both are on one shaft.
    """
    counts = [
        f"{count} {'pulse' if count == 1 else 'pulses'} of {sensor.name} where {sensor.pulses_per_revolution} "
        f"{'is' if sensor.pulses_per_revolution == 1 else 'are'} stated"
        for sensor in vessel.sensors.speed
        if (count := _count_that_fits(sensor, speeds))
    ]
    fields = f"pulses_per_revolution{_of_encoder(vessel)}"
    gear = [f"a gear ratio of {ratio} instead of {vessel.gearbox.ratio:g}"] if ratio else []
    like = "".join(f"{', or' if k else ','} as with {one}" for k, one in enumerate([*counts, *gear]))
    if not ratio:
        return like, f"check {fields} in the vessel file"
    return (
        like,
        f"check {f'{fields} and gearbox.ratio' if counts else f'gearbox.ratio and {fields}'} in the vessel file",
    )


def _count_that_fits(sensor: "SpeedSensor", speeds: Mapping[str, float]) -> int | None:
    """Return the whole number of pulses with which a pick-up agrees with all others; None if there is none."""
    others = [speed for name, speed in speeds.items() if name != sensor.name]
    is_counted = sensor.wheel is None and (sensor.gives_pulses or sensor.unit == "Hz")
    if sensor.name not in speeds or not others or not is_counted or not are_alike(others):
        return None
    fitting = sensor.pulses_per_revolution * speeds[sensor.name] / float(np.mean(others))
    count = round(fitting)
    return count if count and abs(fitting - count) < min(_WHOLE * count, _MOST_OFF_WHOLE) else None


def _swap_of(first: SpeedReading, ratios: Mapping[str, float], vessel: "Vessel") -> str:
    """Return the swap that lets the pick-ups that give pulses agree, by their speeds over that of the first."""
    speeds = {first.name: 1.0, **ratios}
    sensors = [one for one in vessel.sensors.speed if one.name in speeds and one.gives_pulses]
    pulses_hz = {one.channel: speeds[one.name] / engine_turns(one, vessel) for one in sensors}
    return swapped_pick_ups(sensors, pulses_hz, vessel)


def swapped_pick_ups(sensors: Sequence["SpeedSensor"], pulses_hz: Mapping[str, float], vessel: "Vessel") -> str:
    """Return which channels of pick-ups seem to be swapped; empty where all agree, or no single swap lets them agree.

    ``sensors``: pick-ups that give pulses; of more than seven the first. ``pulses_hz``: pulses a second of each of
    their channels, all in any one unit.
    """
    sensors = sensors[:_MOST_SENSORS]
    channels = [sensor.channel for sensor in sensors]

    def turns(order: Sequence[str]) -> list[float]:
        return [
            engine_turns(sensor, vessel) * pulses_hz[channel] for sensor, channel in zip(sensors, order, strict=True)
        ]

    def moved(order: Sequence[str]) -> int:
        return sum(one != other for one, other in zip(channels, order, strict=True))

    if len(sensors) < 2 or are_alike(turns(channels)):
        return ""
    fitting = [order for order in permutations(channels) if are_alike(turns(order))]
    fewest = min(map(moved, fitting), default=0)
    likely = [order for order in fitting if moved(order) == fewest]
    if len(likely) != 1:
        return ""
    found = sorted(zip(turns(channels), (sensor.name for sensor in sensors), strict=True))
    (low, slow), (high, fast) = found[0], found[-1]
    right = [(sensor, order) for sensor, order in zip(sensors, likely[0], strict=True) if sensor.channel != order]
    names = " and ".join(sensor.channel for sensor, _ in right)
    return (
        f"channels {names} seem to be swapped: expected one engine speed, found {fast} / {slow} = {high / low:.3g}; "
        f"with {', '.join(f'{sensor.name} = {channel}' for sensor, channel in right)} all pick-ups agree. Correct the "
        "channels in the vessel file or the columns of the recording."
    )


def are_alike(speeds: Sequence[float]) -> bool:
    """Return whether the speeds of pick-ups are that of one rigid line."""
    return max(speeds) <= (1.0 + LARGEST_DIFFERENCE) * min(speeds)


def engine_turns(sensor: "SpeedSensor", vessel: "Vessel") -> float:
    """Return the turns of the engine from one pulse to the next."""
    return vessel.gearbox.engine_over(sensor.shaft) / sensor.pulses_per_revolution


def _ratios(first: SpeedReading, other: SpeedReading, *, rate_hz: float, start_s: float) -> FloatArray:
    """Return the ratios of two speeds in blocks in which neither has a gap, shape (blocks,)."""
    length = max(round(_BLOCK_S * rate_hz), 1)
    blocks = max(first.values.size // length, 1)
    cut = slice(0, min(blocks * length, first.values.size))
    means = [one.values[cut].reshape(blocks, -1).mean(axis=1) for one in (first, other)]
    begin_s = start_s + np.arange(blocks) * length / rate_hz
    kept = means[0] > 0.0
    for gap in (*first.gaps, *other.gaps):
        kept &= (begin_s + length / rate_hz <= gap.first_s) | (begin_s >= gap.last_s)
    found: FloatArray = means[1][kept] / means[0][kept]
    return found


def _of_encoder(vessel: "Vessel") -> str:
    """Return the field by which an encoder counts turns, to follow that of pulses."""
    return " or counts_per_revolution" if any(one.unit == "counts" for one in vessel.sensors.speed) else ""
