"""Channels of two sensors that are swapped, told by what they show where one cannot be read, or follows no campaign."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from shaftprint.errors import SignalError
from shaftprint.signals.kinds._pick_up import PulseReading, Speed
from shaftprint.units import rev_s_from_rpm

if TYPE_CHECKING:
    from shaftprint.signals._clock import Clock
    from shaftprint.signals.kinds._kind import Source

# Pulses are those of a pick-up within such factors of the speed at the working point.
_AROUND = (0.3, 3.0)


def swapped_pulses(
    sources: "Sequence[Source[Any]]", problems: Mapping[str, SignalError], clock: "Clock"
) -> dict[str, SignalError]:
    """Return a better reason for each pick-up that cannot be read, where another sensor's channel has its pulses.

    ``sources``: what was read. ``problems``: why some gave nothing, by name. ``clock``: the common grid.
    """
    quiet = replace(clock, advance=lambda samples: None)
    failed = [
        one for one in sources if one.name in problems and isinstance(one.kind, Speed) and one.sensor.gives_pulses
    ]
    others = [one for one in sources if not isinstance(one.kind, Speed) and not one.channel.is_uneven]
    told = {}
    for source in failed:
        swapped = [other for other in others if _shows_pulses(source, other, quiet)]
        if len(swapped) == 1:
            own, other = source.channel.name, swapped[0].channel.name
            told[source.name] = SignalError(
                f"channels {own} and {other} seem to be swapped: expected pulses in {own}, found them in {other}, "
                f"which is to be the {swapped[0].kind.use}. Correct the channels in the vessel file or the columns of "
                "the recording."
            )
    return told


def _shows_pulses(source: "Source[Any]", other: "Source[Any]", clock: "Clock") -> bool:
    """Return whether the channel of another sensor shows what a pick-up would."""
    vessel = source.vessel
    try:
        reading = source.kind.read(replace(source, channel=other.channel), clock)
    except SignalError:
        return False
    if not isinstance(reading, PulseReading):
        return False
    share = float(np.mean(reading.values)) / rev_s_from_rpm(vessel.working_point.engine_speed_rpm)
    return _AROUND[0] < share < _AROUND[1]
