"""The nouns of the ledger: a job that was asked for, what has become of it, and how many there are of each state."""

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Any, Final, Literal, TypeAlias

JobState: TypeAlias = Literal["waiting", "running", "done", "refused"]
"""Where a job stands."""
JOB_STATES: Final[tuple[JobState, ...]] = ("waiting", "running", "done", "refused")
"""All of them, in the order in which a job goes through them."""
LEASE_S: Final = 60.0
"""How long a worker that is not heard of keeps its job [s]."""
MOST_TRIES: Final = 3
"""After so many workers that died a job is refused."""


@dataclass(frozen=True, kw_only=True, slots=True)
class JobRequest:
    """A job that is asked for."""

    key: str
    """SHA-256 of all that its result depends on, hexadecimal: the same job is kept once."""
    args: Mapping[str, Any]
    """What it works on, as JSON has it."""
    version: str
    """Version of shaftprint that does it; workers of others leave it alone."""
    kind: str = "identify"
    """What is to be done."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Job:
    """A job of the ledger."""

    id: int
    """Its number; jobs are begun in this order."""
    key: str
    """SHA-256 of all that its result depends on."""
    kind: str
    """What is to be done."""
    args: Mapping[str, Any]
    """What it works on."""
    version: str
    """Version of shaftprint that does it."""
    state: JobState
    """Where it stands."""
    tries: int
    """How often a worker has begun it."""
    enqueued_at: datetime
    """When it was asked for."""
    ended_at: datetime | None = None
    """When it was done or refused."""
    lease_until: datetime | None = None
    """Until when its worker has it; another may take it afterwards. None where nobody has it."""
    owner: str | None = None
    """The worker that has it, or had it last."""
    progress: str | None = None
    """The step that its worker is at."""
    sentence: str | None = None
    """Why it was refused."""
    result: str | None = None
    """SHA-256 of the fingerprint that it gave."""


@dataclass(frozen=True, kw_only=True, slots=True)
class JobCounts:
    """How many jobs of a ledger are in which state."""

    waiting: int = 0
    """Nobody has begun them, or a worker gave them back."""
    running: int = 0
    """A worker has them."""
    done: int = 0
    """Their results are in the store."""
    refused: int = 0
    """They cannot be done; the sentence of each says why."""

    @property
    def open(self) -> int:
        """How many are still to be done."""
        return self.waiting + self.running

    @property
    def all(self) -> int:
        """How many there are."""
        return self.open + self.done + self.refused
