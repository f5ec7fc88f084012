"""Lines that are too fast for the pulses or messages of a channel."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from shaftprint.signals._channel_signals import ExcitationSignal, SpeedSignal
    from shaftprint.signals._signals import Signals


def alias_remarks(
    frequency_hz: float, signals: "Signals", sensor: "SpeedSignal", moved: "ExcitationSignal"
) -> list[str]:
    """Return what set point, speed and torque cannot show of a line; nothing where each of them can.

    ``frequency_hz``: frequency of the line [Hz]. ``signals``: the prepared recording, whose shaft torque may come in
    messages. ``sensor``, ``moved``: the speed and what was moved.
    """
    by_limit = {
        f"half the pulse rate of {sensor.name}": sensor,
        f"half the rate of the {moved.words}'s messages": moved,
        "half the rate of the shaft torque's messages": signals.channels["M_s"],
    }
    return [
        f"above {channel.nyquist_hz:.2f} Hz, {limit}: aliased"
        for limit, channel in by_limit.items()
        if frequency_hz > channel.nyquist_hz
    ]
