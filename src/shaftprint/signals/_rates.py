"""Whether the channels of one logger say that they run at one rate."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.reasons import Reason
from shaftprint.recording._recording import CLOCK_MAPS
from shaftprint.units import PPM

if TYPE_CHECKING:
    from shaftprint.recording._channel import Channel
    from shaftprint.recording._recording import Recording

# Rates that differ by less are one rate that was rounded; by more, different ones on purpose.
_LEAST, _MOST = 2e-6, 1e-2


def expect_one_rate(recording: "Recording", channels: "Sequence[Channel]") -> tuple[Reason, ...]:
    """Return a reason for the channel whose rate is nearly, but not quite, that of the others.

    Where recordings were merged, the clocks are known and rates may differ. Messages have the times of the logger: that
    of their sender, whose rate is found from them, says nothing.

    ``recording``: says whether it was merged. ``channels``: channels of set point, speeds and torque.
    """
    if CLOCK_MAPS in recording.attributes:
        return ()
    sampled = [channel for channel in channels if channel.stamps is None]
    if not sampled:
        return ()
    usual = float(np.median([channel.rate_hz for channel in sampled]))
    apart = [channel for channel in sampled if _LEAST < abs(channel.rate_hz / usual - 1.0) < _MOST]
    return tuple(
        Reason(
            kind="channel clock",
            where=channel.name,
            sentence=(
                f"The clock of channel {channel.name} is in doubt: its rate of {channel.rate_hz:.9g} Hz differs by "
                f"{PPM * (channel.rate_hz / usual - 1.0):+.0f} parts per million from the "
                f"{usual:.9g} Hz of the others; correct rate_hz where one logger wrote them all, merge the recordings "
                "where two did (shaftprint merge)."
            ),
        )
        for channel in apart
    )
