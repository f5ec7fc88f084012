"""What can go wrong with a simulated counterpart, and when."""

import math
from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True, slots=True)
class Spell:
    """From when to when something is wrong, by the time of the simulated ship [s]."""

    start_s: float = math.inf
    """When it begins [s]; infinite: never."""
    stop_s: float = math.inf
    """When it ends [s]; infinite: it lasts."""

    def holds(self, time_s: float) -> bool:
        """Return whether it is wrong at a time [s]."""
        return self.start_s <= time_s < self.stop_s


NEVER = Spell()


@dataclass(frozen=True, kw_only=True, slots=True)
class LinkFaults:
    """Faults of a simulated counterpart and of the link to it; without any it does what its contract says."""

    frozen: Spell = NEVER
    """It hangs: it sends nothing and hears nothing, and then sends all at once; its set point is played on."""
    silent: Spell = NEVER
    """The link answers nothing; the device goes on, and hears no heartbeat."""
    stale: Spell = NEVER
    """Blocks come, but their samples are those of the last good one, again and again."""
    not_a_number: Spell = NEVER
    """One channel is not a number."""
    channel: str = "M_s"
    """Which."""
    stuck_set_point: Spell = NEVER
    """It says that it plays, and puts out what it did when the fault began."""
    deaf: Spell = NEVER
    """It does not hear heartbeats, though its blocks come."""
    lost: tuple[int, ...] = ()
    """Blocks that are lost on the way, by their count."""
    doubled: tuple[int, ...] = ()
    """Blocks that come twice."""
    clock_step_at_s: float = math.inf
    """When its clock jumps [s]; infinite: never."""
    clock_step_s: float = 0.0
    """How far [s]."""
    revert_s: float = 0.5
    """Time without heartbeat after which it begins to go back to the lever [s]; infinite: it never does."""
    ignores_abort: bool = False
    """Whether it does nothing when it is asked to abort."""
