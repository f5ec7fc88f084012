"""Whether a channel sticks at its highest or lowest value: an amplifier, a telemetry or a logger that cuts off crests.

A signal with noise reaches its extreme values once or twice. Where crests are cut off, the last value holds many more
samples than those before it, whatever full scale a file states. Where a range was changed during the test, that value
is the last one of the stretches before or after alone.
"""

from collections import defaultdict
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from shaftprint.reasons import Reason
from shaftprint.signals._channels import spots
from shaftprint.units import PERCENT

if TYPE_CHECKING:
    from shaftprint.recording._channel import Channel
    from shaftprint.signals._channels import Counts

# Which end, the value of the channel in counts, and the share of the samples that are there.
_FlatEnd: TypeAlias = tuple[str, float, float]
# So many values beside the last one tell how many samples it should hold; it holds so many times more.
_BESIDE, _TIMES = 10, 5.0
# Below this share of the samples the crests that are lost change nothing.
_LEAST_SHARE = 0.01
# What is lost once or twice, as a telemetry that holds its value, is no range.
_FEWEST_PARTS, _PART_SAMPLES, _LEAST_VISITS = 3, 4096, 20


def expect_whole_crests(channel: "Channel") -> tuple[Reason, ...]:
    """Return a reason where a channel with noise sticks at its highest or lowest value.

    ``channel``: the channel; stretches all over it are looked at.
    """
    stretches = spots(channel)
    flat_ends = [one for one in _flat_ends(np.concatenate(stretches)) if one[2] > _LEAST_SHARE]
    if not flat_ends:
        flat_ends = [one for one in _ends_of_parts(stretches) if one[2] > _LEAST_SHARE]
    if not flat_ends:
        return ()
    end, counts, share = max(flat_ends, key=lambda one: one[2])
    level = counts * channel.scale + channel.offset
    return (
        Reason(
            kind="clipping",
            where=channel.name,
            sentence=(
                f"The torque is cut off: channel {channel.name} sticks at its {end}, {level:.4g} {channel.unit}, "
                f"for {PERCENT * share:.1f} % of the time; choose a larger range of amplifier, telemetry or logger."
            ),
        ),
    )


def _flat_ends(values: NDArray[Any]) -> Iterator[_FlatEnd]:
    """Yield the ends of values at which they stick."""
    levels, visits = np.unique(values, return_counts=True)
    for end, index, order in (("highest value", -1, slice(None, None, -1)), ("lowest value", 0, slice(None))):
        if _stands_out(visits[order]):
            yield end, float(levels[index]), float(visits[index]) / values.size


def _ends_of_parts(stretches: "Sequence[Counts]") -> Iterator[_FlatEnd]:
    """Yield the values to which several parts come back again and again at one end, with their share of all samples."""
    size = sum(one.size for one in stretches)
    shares: dict[tuple[str, float], list[float]] = defaultdict(list)
    for part in (part for one in stretches for part in np.array_split(one, max(1, one.size // _PART_SAMPLES))):
        # a level at which a quiet channel stands is come to once, however long it stands there
        comings = part[np.append(True, part[1:] != part[:-1])]
        for end, value, share in _flat_ends(comings):
            if share * comings.size >= _LEAST_VISITS:
                shares[end, value].append(np.count_nonzero(part == value) / size)
    for (end, value), found in shares.items():
        if len(found) >= _FEWEST_PARTS:
            yield f"{end} in a part of the recording", value, sum(found)


def _stands_out(counts: NDArray[Any]) -> bool:
    """Return whether the first of the counts is many times those that follow."""
    following = counts[1 : 1 + _BESIDE]
    return bool(following.size == _BESIDE and counts[0] > _TIMES * np.median(following))
