"""The noun ``Bound``: a limit as a straight line in the deviations of ``SIGNALS``."""

from dataclasses import dataclass

from shaftprint.arrays import FloatArray

# Standard deviations of the noise that a search leaves free where lines have their crests, and the share of the room
# that it keeps for them at least: how strong a finished leg may be is seen by the share of time beyond the limit.
_SEARCH_SIGMAS, _LEAST_FREE = 2.5, 0.25


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Bound:
    """``weights . signals + noise <= room``, but for a share of the time."""

    name: str
    """Limit that it stands for."""
    weights: FloatArray
    """What it weighs, in the order of ``SIGNALS``, shape (signals,)."""
    room: float
    """What is left at the working point, positive."""
    noise: float = 0.0
    """Standard deviation of the noise of what is weighed."""

    @property
    def free(self) -> float:
        """What crests have of the room while lines are looked for."""
        return max(self.room - _SEARCH_SIGMAS * self.noise, _LEAST_FREE * self.room)
