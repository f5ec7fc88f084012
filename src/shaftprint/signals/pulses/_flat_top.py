"""Whether a channel sticks at its highest or lowest value: an amplifier, a telemetry or a logger that cuts off crests.

A signal with noise reaches its extreme values once or twice. Where crests are cut off, the last value holds many more
samples than those before it, whatever full scale a file states.
"""

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from shaftprint.reasons import Reason
from shaftprint.signals._channels import spots

if TYPE_CHECKING:
    from shaftprint.recording import Channel

# So many values beside the last one tell how many samples it should hold; it holds so many times more.
_BESIDE, _TIMES = 10, 5.0
# Below this share of the samples the crests that are lost change nothing.
_LEAST_SHARE = 0.01
_PERCENT = 100.0


def expect_whole_crests(channel: "Channel") -> tuple[Reason, ...]:
    """Return a reason where a channel with noise sticks at its highest or lowest value.

    Parameters
    ----------
    channel
        The channel; stretches all over it are looked at.
    """
    values = np.concatenate(spots(channel))
    levels, counts = np.unique(values, return_counts=True)
    flat_ends = []
    for end, index, order in (("highest", -1, slice(None, None, -1)), ("lowest", 0, slice(None))):
        share = counts[index] / values.size
        if share > _LEAST_SHARE and _stands_out(counts[order]):
            level = float(levels[index]) * channel.scale + channel.offset
            flat_ends.append((end, level, share))
    if not flat_ends:
        return ()
    end, level, share = max(flat_ends, key=lambda one: one[2])
    return (
        Reason(
            kind="clipping",
            where=channel.name,
            sentence=(
                f"The torque is cut off: channel {channel.name} sticks at its {end} value, {level:.4g} {channel.unit}, "
                f"for {_PERCENT * share:.1f} % of the time; choose a larger range of amplifier, telemetry or logger."
            ),
        ),
    )


def _stands_out(counts: NDArray[Any]) -> bool:
    """Return whether the first of the counts is many times those that follow."""
    following = counts[1 : 1 + _BESIDE]
    return bool(following.size == _BESIDE and counts[0] > _TIMES * np.median(following))
