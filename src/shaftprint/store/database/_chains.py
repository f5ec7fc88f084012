"""Fingerprints of one recording as a chain in the order of their making: each takes the place of the one before.

A recording that two versions of the program identified is one test, whichever of the two was put in first.
"""

from bisect import insort
from collections.abc import Sequence
from dataclasses import dataclass, field
from datetime import datetime
from typing import Any

import sqlalchemy as sa

from shaftprint.store._record import Record
from shaftprint.store.database._rows import trial_columns
from shaftprint.store.database._tables import FINGERPRINT, TRIAL


@dataclass(kw_only=True, slots=True)
class Link:
    """A fingerprint in its chain."""

    id: int
    """Its number."""
    made_at: datetime
    """When it was made."""
    sha256: str
    """SHA-256 of its document."""
    record: Record | None = None
    """What is to be put in; None for one that is there."""
    supersedes: int | None = None
    """Number of the one before it."""
    was: int | None = None
    """The same, as the database has it."""

    def __lt__(self, other: "Link") -> bool:
        """Return whether it comes before another one; of two made at one time, the one that was put in first."""
        return (self.made_at, self.id) < (other.made_at, other.id)


@dataclass(kw_only=True, slots=True)
class Chains:
    """The chains to which some records belong."""

    known: dict[str, int]
    """Line of each document that is there, by its SHA-256."""
    trials: dict[tuple[int, str], dict[str, Any]]
    """Rows of the tests that are there, by line and recording."""
    links: dict[int, list[Link]]
    """The chain of each test, by its number."""
    new_trials: list[dict[str, Any]] = field(default_factory=list)
    """Rows of tests to be put in."""
    restated: dict[int, dict[str, Any]] = field(default_factory=dict)
    """Rows of tests that are there and of which a newer fingerprint says something else."""
    trial_of: dict[int, int] = field(default_factory=dict)
    """Test of each new fingerprint, by its number."""

    @classmethod
    def of(cls, connection: sa.Connection, records: Sequence[Record]) -> "Chains":
        """Return the chains to which records belong, as they are."""
        hashes = [record.sha256 for record in records]
        known = (
            sa.select(FINGERPRINT.c.sha256, TRIAL.c.line_id)
            .join(TRIAL, TRIAL.c.id == FINGERPRINT.c.trial_id)
            .where(FINGERPRINT.c.sha256.in_(hashes))
        )
        recordings = [record.trial.recording_sha256 for record in records if record.trial.recording_sha256]
        trials = [
            dict(row._mapping)
            for row in connection.execute(sa.select(TRIAL).where(TRIAL.c.recording_sha256.in_(recordings)))
        ]
        columns = (FINGERPRINT.c[name] for name in ("id", "made_at", "sha256", "supersedes", "trial_id"))
        of_trials = sa.select(*columns).where(FINGERPRINT.c.trial_id.in_([row["id"] for row in trials]))
        links: dict[int, list[Link]] = {row["id"]: [] for row in trials}
        for row in connection.execute(of_trials) if trials else ():
            link = Link(
                id=row.id, made_at=row.made_at, sha256=row.sha256, supersedes=row.supersedes, was=row.supersedes
            )
            insort(links[row.trial_id], link)
        return cls(
            known={row[0]: row[1] for row in connection.execute(known)},
            trials={(row["line_id"], row["recording_sha256"]): row for row in trials},
            links=links,
        )

    def add(self, link: Link, line_id: int, *, trial_id: int) -> tuple[Link | None, Link | None]:
        """Put a new fingerprint into the chain of its recording.

        ``link``: the fingerprint. ``line_id``: number of its line. ``trial_id``: number of its test, if that is not
        there yet. Returns its neighbours; None where it has none.
        """
        record = link.record
        if record is None:
            return None, None
        row = self.trials.get((line_id, record.trial.recording_sha256 or ""))
        if row is None:
            row = {"id": trial_id, "line_id": line_id} | trial_columns(record.trial)
            self.new_trials.append(row)
            self.links[trial_id] = []
            if record.trial.recording_sha256 is not None:
                self.trials[line_id, record.trial.recording_sha256] = row
        chain = self.links[row["id"]]
        insort(chain, link)
        self.trial_of[link.id] = row["id"]
        self.known[link.sha256] = line_id
        place = chain.index(link)
        before = chain[place - 1] if place else None
        after = chain[place + 1] if place + 1 < len(chain) else None
        link.supersedes = None if before is None else before.id
        if after is not None:
            after.supersedes = link.id
        elif before is not None:
            self._restate(row, record)
        return before, after

    def _restate(self, row: dict[str, Any], record: Record) -> None:
        """Let a test say what its newest fingerprint says; what earlier ones said stays in their documents."""
        row |= trial_columns(record.trial)
        if all(row is not one for one in self.new_trials):
            self.restated[row["id"]] = row

    @property
    def new(self) -> list[Link]:
        """The fingerprints to be put in, in the order in which they came."""
        return sorted((one for one in self._all() if one.record is not None), key=lambda one: one.id)

    @property
    def changed(self) -> list[Link]:
        """The fingerprints that take the place of another one than the database says."""
        return [one for one in self._all() if one.supersedes != one.was]

    def _all(self) -> list[Link]:
        return [one for chain in self.links.values() for one in chain]
