"""Current loops of 4 to 20 mA, which show by themselves that they have failed."""

from typing import TYPE_CHECKING

from shaftprint.vessel._current_loop import ALIVE_MA

if TYPE_CHECKING:
    from shaftprint.recording._channel import Channel


def alive_counts(channel: "Channel") -> tuple[float, float]:
    """Return the lowest and the highest raw count of a channel in mA whose loop has not failed [counts]."""
    lowest, highest = sorted((end_ma - channel.offset) / channel.scale for end_ma in ALIVE_MA)
    return lowest, highest
