"""One wrong recording: what was done to a good one, and what an answer must name."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from tests.wrong_recordings.trial import ONE_SPEED, Change, Sailed, of_ship


@dataclass(frozen=True, kw_only=True, slots=True)
class Case:
    """One wrong recording."""

    name: str
    """What is wrong, in words."""
    change: Change = field(default=lambda trial: trial)
    """What was done to the good one."""
    cause: str
    """What an error or one of the first three reasons must match, case ignored."""
    truth: Mapping[str, float] = field(default_factory=dict)
    """Numbers whose truth the change moves, as factors on the truth of the good one."""
    assumption: str = ""
    """What one of the printed assumptions must match, where no evidence in the recording can show the fault."""
    test: Sailed = ONE_SPEED
    """The test that is spoilt."""
    ship: Mapping[str, object] = field(default_factory=dict)
    """In what the ship that sailed is another than the vessel file lets expect."""
    both: bool = False
    """Whether the test of two speeds is spoilt so as well, as one of each kind is."""
    fast: bool = False
    """Whether it is among the few of every test run."""

    @property
    def sailed(self) -> Sailed:
        """The test, by its ship."""
        return of_ship(self.test, self.ship)
