"""The speed channels side by side: on one rigid shaft line they must agree."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.errors import SignalError
from shaftprint.signals.kinds._speed_reading import SpeedReading

if TYPE_CHECKING:
    from shaftprint.vessel import Vessel

LARGEST_DIFFERENCE = 1e-2
"""Share by which two pick-ups of one line may differ without an error in the vessel file."""

_FINDING = 1e-3


def compare_speeds(speeds: Sequence[SpeedReading], vessel: "Vessel") -> tuple[str, ...]:
    """Compare the mean of every speed with that of the first.

    Returns
    -------
    findings
        One sentence for each speed that is off by more than 0.1 %.

    Raises
    ------
    SignalError
        If one is off by more than 1 %: a gear ratio or a number of strips in the vessel file is wrong.
    """
    shafts = {sensor.name: sensor.shaft for sensor in vessel.sensors.speed}
    first = speeds[0]
    findings = []
    for other in speeds[1:]:
        ratio = float(np.mean(other.values) / np.mean(first.values))
        if abs(ratio - 1.0) <= _FINDING:
            continue
        message = (
            f"channels {first.channel} and {other.channel}: expected the same engine-side speed, "
            f"found {other.name} / {first.name} = {ratio:.4f}"
        )
        if shafts[first.name] != shafts[other.name]:
            # the propeller side was multiplied by the ratio
            power = -1.0 if shafts[other.name] == "propeller" else 1.0
            message += (
                f", as with a gear ratio of {vessel.gearbox.ratio * ratio**power:.4f} "
                f"instead of {vessel.gearbox.ratio:g}"
            )
        if abs(ratio - 1.0) > LARGEST_DIFFERENCE:
            raise SignalError(f"{message}; check gearbox.ratio{_counted(vessel)} in the vessel file.")
        findings.append(message)
    return tuple(findings)


def _counted(vessel: "Vessel") -> str:
    """Return the fields by which turns are counted, to follow another field."""
    if any(sensor.unit == "counts" for sensor in vessel.sensors.speed):
        return ", pulses_per_revolution and counts_per_revolution"
    return " and pulses_per_revolution"
