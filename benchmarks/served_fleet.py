"""A small fleet for pages: histories drawn from one fingerprint with the covariance that it states itself."""

import json
import math
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from typing import Any

import numpy as np

from shaftprint.store import Store, add_document, record_event

NEWEST = datetime(2026, 10, 6, 8, 30, tzinfo=UTC)
QUARTER = timedelta(days=91)
CLASS = "Stan Tug 1205"
P_ACTION, I_ACTION = "governor proportional action", "governor integral action"
SEED = 5


@dataclass(frozen=True, kw_only=True, slots=True)
class Life:
    """A line, and what happens to it."""

    ship: str
    """Name of the ship."""
    imo_number: int | None
    """Its IMO number."""
    line: str = "port"
    """Which line."""
    tests: int = 12
    """How many quarterly tests."""
    class_name: str | None = CLASS
    """Its class."""
    numbers: tuple[str, ...] = ()
    """Numbers that change."""
    step: float = 0.0
    """By which share, at the eighth test."""
    per_year: float = 0.0
    """Or how fast."""
    events: tuple[tuple[str, int, str], ...] = ()
    """What was done, before which test, and a note."""
    age: timedelta = timedelta()
    """How long before ``NEWEST`` the newest test was made."""
    trustworthy: bool = True
    """Whether its newest test is."""


LIVES = (
    Life(ship="Ada", imo_number=9074729, numbers=(P_ACTION,), step=-0.05, events=(("docking", 5, "class survey"),)),
    Life(ship="Ada", imo_number=9074729, line="starboard", events=(("docking", 5, "class survey"),)),
    Life(ship="Meander", imo_number=9000003, numbers=("K_Q",), per_year=0.06),
    Life(ship="Stormvogel", imo_number=9000015),
    Life(ship="Waal", imo_number=9000027, age=timedelta(days=600), tests=6),
    Life(ship="Merwede", imo_number=9000039, trustworthy=False, tests=5),
    Life(ship="Lek", imo_number=9000041, tests=1),
    Life(ship="Zwaluw", imo_number=None, class_name=None, tests=8,
         events=(("governor-changed", 4, "new control unit, gains as before"),)),
)  # fmt: skip


def documents(base: dict[str, Any], life: Life, seed: int) -> Iterator[bytes]:
    """Give the fingerprint of each test of a line, the earliest first."""
    joint, rng = base["joint"], np.random.default_rng([SEED, seed])
    own = np.array(joint["own_covariance"], dtype=float)
    names, begin = joint["names"], NEWEST - life.age - (life.tests - 1) * QUARTER
    for test, drawn in enumerate(rng.multivariate_normal(np.zeros(len(names)), own, size=life.tests)):
        content = json.loads(json.dumps(base))
        at = begin + test * QUARTER
        changes = dict(zip(names, drawn, strict=True))
        for number in (*content["physical"], *content["parameters"]):
            share = 1.0 + (life.step if test >= 7 else 0.0) if number["name"] in life.numbers else 1.0
            if number["name"] in life.numbers:
                share *= math.exp(life.per_year * test / 4.0)
            moved = float(number["value"] * share + changes.get(number["name"], 0.0))
            interval = number.get("interval_95")
            if interval is not None:
                number["interval_95"] = [one if one is None else one + moved - number["value"] for one in interval]
            number["value"] = moved
        for source in content["sources"]:
            if source["role"] == "recording":
                source["sha256"] = f"{seed:032x}{test:032x}"
        ship = {"name": life.ship, "imo_number": life.imo_number, "class_name": life.class_name, "line": life.line}
        content["conditions"] |= {"tested_at": at.isoformat(), "ship": ship, "place": "IJmuiden"}
        content["created"] = (at + timedelta(hours=2)).isoformat().replace("+00:00", "Z")
        if not life.trustworthy and test == life.tests - 1:
            content["verdict"]["trustworthy"] = False
        yield json.dumps(content).encode()


def fill(store: Store, base: dict[str, Any], *, now: datetime) -> None:
    """Put the fleet into a store."""
    for seed, life in enumerate(LIVES):
        for document in documents(base, life, seed):
            add_document(store, document, named=life.ship, now=now)
        for kind, test, note in life.events:
            at = NEWEST - life.age - (life.tests - 1 - test) * QUARTER - timedelta(days=30)
            record_event(store, str(life.imo_number or life.ship), kind, at=at, lines=(life.line,), note=note)
