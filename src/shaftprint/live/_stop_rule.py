"""The stop rule, and what is played next: by what is predicted of the recording so far for the wishes of its plan."""

import asyncio
from collections.abc import Awaitable, Callable
from typing import TYPE_CHECKING

from shaftprint.campaign._campaign import Campaign
from shaftprint.errors import ShaftprintError
from shaftprint.live._changes import Advice
from shaftprint.live._timetable import played_until, shifted
from shaftprint.recording._read import read_recording
from shaftprint.rehearsal._continue import standing_after
from shaftprint.survey._measurement import measure
from shaftprint.survey._trial import Trial

if TYPE_CHECKING:
    from pathlib import Path

    from shaftprint.design.planned_test._planned_test import PlannedTest
    from shaftprint.design.standing._standing import Standing
    from shaftprint.live._course import Course
    from shaftprint.vessel._vessel import Vessel


def advice_by(
    planned: "PlannedTest", *, told: "Callable[[Standing], None]" = lambda standing: None
) -> "Callable[[Course], Awaitable[Advice | None]]":
    """Return what tells a live test how much of which leg is still needed for the wishes of its plan.

    Deviations are those that are predicted with the whole periods so far, not those that were estimated with them: see
    `continue`. It is worked out beside the loop, which goes on with its blocks: the answer is there at the end of a
    later period. What cannot be fitted yet has none, nor has a wish that no number of periods meets.

    ``told``: is told how far the test has come.
    """
    pending: list[asyncio.Task[Advice | None]] = []

    async def worked_out(test: "Course") -> Advice | None:
        begun_s = test.recorded_s(0.0)
        campaign = played_until(test.campaign, test.campaign_s)
        if campaign is None:
            return None
        try:
            standing = await asyncio.to_thread(
                standing_of_journal, test.record.journal_path, test.vessel, shifted(campaign, begun_s), planned
            )
        except ShaftprintError:
            return None
        told(standing)
        if standing.more is None:
            return None
        recorded = {leg.name: leg.periods for leg in campaign.legs}
        return Advice(more=standing.more, recorded=recorded, sentence=" ".join(standing.sentences))

    async def advice(test: "Course") -> Advice | None:
        if not pending:
            pending.append(asyncio.create_task(worked_out(test)))
            if not test.waits:
                return None
            await pending[0]
        return pending.pop().result() if pending[0].done() else None

    return advice


def standing_of_journal(path: "Path", vessel: "Vessel", campaign: Campaign, planned: "PlannedTest") -> "Standing":
    """Return how far a planned test has come with what a journal holds now."""
    trial = Trial(vessel=vessel, campaign=campaign)
    with read_recording(path) as recording:
        return standing_after(planned, measure(recording, trial), trial)
