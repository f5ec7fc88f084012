"""The stop rule: a leg ends early where what is predicted of the recording so far meets the wishes of its plan."""

import asyncio
from collections.abc import Awaitable, Callable
from typing import TYPE_CHECKING

from shaftprint.campaign._campaign import Campaign
from shaftprint.errors import ShaftprintError
from shaftprint.live._timetable import played_until, shifted
from shaftprint.recording._read import read_recording
from shaftprint.rehearsal._continue import standing_after
from shaftprint.survey._measurement import measure
from shaftprint.survey._trial import Trial

if TYPE_CHECKING:
    from pathlib import Path

    from shaftprint.design.planned_test._planned_test import PlannedTest
    from shaftprint.design.standing._standing import Standing
    from shaftprint.live._engine import LiveTest
    from shaftprint.vessel._vessel import Vessel


def enough_by(
    planned: "PlannedTest", *, told: "Callable[[Standing], None]" = lambda standing: None
) -> "Callable[[LiveTest, str, int], Awaitable[bool]]":
    """Return what tells a live test whether the rest of a leg is needed for the wishes of its plan.

    Deviations are those that are predicted with the whole periods so far, not those that were estimated with them: see
    `continue`. It is worked out beside the loop, which goes on with its blocks; until the answer is there the leg goes
    on. What cannot be fitted yet is not enough.

    ``told``: is told how far the test has come.
    """
    pending: dict[str, asyncio.Task[bool]] = {}

    async def worked_out(test: "LiveTest", until_s: float) -> bool:
        begun_s = test.recorded_s(0.0)
        campaign = played_until(test.campaign, until_s)
        if campaign is None:
            return False
        try:
            standing = await asyncio.to_thread(
                standing_of_journal, test.record.journal_path, test.vessel, shifted(campaign, begun_s), planned
            )
        except ShaftprintError:
            return False
        told(standing)
        return standing.is_enough

    async def is_enough(test: "LiveTest", name: str, periods: int) -> bool:
        task = pending.get(name)
        if task is None:
            pending[name] = asyncio.create_task(worked_out(test, test.campaign_s))
            if not test.waits:
                return False
            task = pending[name]
            await task
        if not task.done():
            return False
        del pending[name]
        return task.result()

    return is_enough


def standing_of_journal(path: "Path", vessel: "Vessel", campaign: Campaign, planned: "PlannedTest") -> "Standing":
    """Return how far a planned test has come with what a journal holds now."""
    trial = Trial(vessel=vessel, campaign=campaign)
    with read_recording(path) as recording:
        return standing_after(planned, measure(recording, trial), trial)
