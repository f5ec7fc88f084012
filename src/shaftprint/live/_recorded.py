"""A test with its record, from the first word to the device until it is let go: on board, rehearsed, measured."""

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from shaftprint.live._engine import LiveTest
from shaftprint.live._outcome import Outcome
from shaftprint.live._record import Left, LiveRecord

if TYPE_CHECKING:
    from shaftprint.live._counterpart import Counterpart


async def recorded(counterpart: "Counterpart", path: Path, make: "partial[LiveTest]") -> tuple[LiveTest, Outcome, Left]:
    """Reach a counterpart, play the test that is made for it, and write what it leaves.

    ``make``: makes the test, of all but counterpart and record.
    """
    try:
        await counterpart.connect()
        record = LiveRecord(path, counterpart.channels, {"vessel": make.keywords["vessel"].name})
        test = make(counterpart=counterpart, record=record)
        try:
            outcome = await test.run()
        finally:
            record.close()
    finally:
        await counterpart.close()
    return test, outcome, record.finish(outcome.campaign)
