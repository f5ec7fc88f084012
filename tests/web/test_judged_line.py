"""The judgement of a line in the process beside the server: how many of its tests are judged together."""

import asyncio
import json
from datetime import UTC, datetime, timedelta

import pytest

pytest.importorskip("sqlalchemy", reason="a store needs SQLAlchemy")

from benchmarks.store_documents import document

from shaftprint.store import add_document, create_store
from shaftprint.web.calculator._client import Calculator

FIRST = datetime(2020, 1, 1, tzinfo=UTC)
MEMORY = 4 * 2**30


@pytest.mark.slow
def test_fingerprints_that_another_has_taken_the_place_of_are_no_tests(tmp_path):
    """Of 42 recordings, ten of them identified by two versions of the program, the newest 40 are judged together."""
    with create_store(str(tmp_path / "fleet.db")) as store:
        for day in range(42):
            at = (FIRST + timedelta(days=day)).isoformat()
            ship = {"name": "Meander", "imo_number": 9074729, "line": "port"}
            for version in ("0.1.0", "0.2.0") if day >= 32 else ("0.1.0",):
                content = json.loads(document(tested_at=at, recording=f"{day:064x}", ship=ship))
                content["shaftprint_version"] = version
                content["created"] = f"2026-0{version[2]}-01T00:00:00Z"
                add_document(store, json.dumps(content).encode(), named="one.json", now=FIRST)

    (tmp_path / "day.nc").write_bytes(b"no recording")
    job = {"kind": "submit", "recording": str(tmp_path / "day.nc"), "vessel": "stan-tug-1205", "campaign": "short"}
    job |= {"structure": None, "ship": "Ada", "imo": 9074729, "line": "port", "facts": {}}

    async def asked():
        calculator = Calculator(store=str(tmp_path / "fleet.db"), most_memory=MEMORY, scratch=tmp_path / "scratch")
        try:
            line = {"kind": "line", "ship": {"name": "Ada", "imo_number": 9074729}, "line": "port"}
            found = await calculator.ask(line, longest_s=300.0)
            # what a process leaves when it is killed lies there
            (tmp_path / "scratch" / "left").write_bytes(b"x")
            return found, await calculator.ask(job, longest_s=300.0)
        finally:
            await calculator.close()

    found, asked_for = asyncio.run(asked())
    assert asked_for["args"]["only"] == {"ship": "Ada", "imo": 9074729, "line": "port"}
    assert not (tmp_path / "scratch").exists()
    assert found["earlier"] == 2
    # none has a joint covariance; those that were superseded are told of too
    assert len(found["left_out"]) == 50
