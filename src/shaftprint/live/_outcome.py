"""Who watches a live test, and how it ended."""

from collections import deque
from collections.abc import Awaitable, Callable
from dataclasses import dataclass, field
from enum import StrEnum
from typing import TYPE_CHECKING

from shaftprint.live._judgement import LineJudgement
from shaftprint.live._watch import Breach

if TYPE_CHECKING:
    from shaftprint.campaign._campaign import Campaign


async def _agrees(question: str) -> bool:
    return True


class Ask(StrEnum):
    """What the operator may ask for while a test is played."""

    HOLD = "hold"
    GO_ON = "go on"
    SKIP = "skip"
    REPEAT = "repeat"


@dataclass(kw_only=True)
class Operator:
    """Who watches the test: agrees to it, changes its course, and stops it at any time."""

    confirm: Callable[[str], Awaitable[bool]] = _agrees
    """Asks on the bridge."""
    stops: str = ""
    """Why the operator wants the test aborted; empty while he does not. It may be set from any thread."""
    asks: deque[Ask] = field(default_factory=deque)
    """What is asked for and not done yet. It may be added to from any thread."""


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """How a live test ended."""

    word: str
    """``played``, ``refused`` or ``aborted``."""
    reason: str
    """Why, in a sentence; empty where all was played."""
    breach: Breach | None
    """The rule that was broken, where one was."""
    campaign: "Campaign | None"
    """The campaign as it was played, by the time of the recording; None where nothing was."""
    judgements: tuple[LineJudgement, ...]
    """Every line that was judged."""
    is_back: bool
    """Whether a block has shown that the lever rules again."""
