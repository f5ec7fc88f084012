"""Both shafts of a ship from one recording: a survey of each, and what the wash of one does to the other."""

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import datetime
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np

from shaftprint.arguments import refusing_none
from shaftprint.campaign._both_shafts import SIDES, CampaignOfBoth, load_campaign_of_both
from shaftprint.campaign._trial_conditions import TrialConditions
from shaftprint.errors import SettingsError
from shaftprint.fingerprint._line_fingerprint import SourceFile
from shaftprint.models._structure import Structure
from shaftprint.notebook._shown import Shown
from shaftprint.notebook._summary import Summary
from shaftprint.settings import settings_content
from shaftprint.survey._progress import Progress
from shaftprint.survey._survey import SettingsOf, Survey, run
from shaftprint.survey._trial import Trial, load_trial
from shaftprint.survey._wash import Wash, wash_on
from shaftprint.vessel._vessel import Vessel


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class SurveyOfBoth(Shown):
    """What one recording gives of both shafts of a ship."""

    port: Survey
    """The line to port."""
    starboard: Survey
    """The line to starboard."""
    port_wash: Wash | None
    """What the wash of starboard does to port; None where no propeller torque is told."""
    starboard_wash: Wash | None
    """What the wash of port does to starboard."""

    @property
    def sides(self) -> dict[str, Survey]:
        """Each line by its side."""
        return dict(zip(SIDES, (self.port, self.starboard), strict=True))

    @property
    def washes(self) -> dict[str, Wash]:
        """What the wash of the other side does to each, where it was measured."""
        measured = zip(SIDES, (self.port_wash, self.starboard_wash), strict=True)
        return {side: wash for side, wash in measured if wash is not None}

    def summary(self) -> Summary:
        """Return the verdict of each side."""
        facts = {side: one.fingerprint.verdict.reason for side, one in self.sides.items()}
        return Summary(title=f"Survey of both shafts, {self.port.signals.recording_name}", facts=facts)


def load_trials_of_both(
    port: str | Path | Vessel,
    starboard: str | Path | Vessel,
    campaign: str | Path | CampaignOfBoth,
    conditions: str | Path | TrialConditions | None = None,
) -> tuple[Trial, Trial]:
    """Return what was tested and asked of each side.

    Parameters
    ----------
    port, starboard
        The vessel file of each line: a path, a shipped name, or loaded. They name different channels of one recording.
    campaign
        What was asked of both: a path, a shipped name, or loaded.
    conditions
        When, where and in what water: a path, or loaded.

    Raises
    ------
    SettingsError
        If one of them cannot be used, or both lines name one channel.
    """
    sources: tuple[SourceFile, ...] = ()
    if not isinstance(campaign, CampaignOfBoth):
        name = str(campaign)
        campaign = load_campaign_of_both(name)
        content = settings_content(name, shipped=files("shaftprint.campaign") / "shipped_for_both")
        sources = (SourceFile(role="campaign", name=Path(name).name, sha256=hashlib.sha256(content).hexdigest()),)
    trials = [
        load_trial(vessel, one, conditions) for vessel, one in zip((port, starboard), campaign.sides, strict=True)
    ]
    _expect_channels_of_their_own(*(trial.vessel for trial in trials))
    of_port, of_starboard = (replace(trial, sources=(*trial.sources, *sources)) for trial in trials)
    return of_port, of_starboard


def _expect_channels_of_their_own(port: Vessel, starboard: Vessel) -> None:
    """Refuse two vessel files of one line.

    Raises SettingsError if both name a channel.
    """
    of_port, of_starboard = (
        {vessel.sensors.set_point.channel, vessel.sensors.shaft_torque.channel}
        | {sensor.channel for sensor in vessel.sensors.speed}
        for vessel in (port, starboard)
    )
    twice = sorted(of_port & of_starboard)
    if twice:
        raise SettingsError(
            f"vessels {port.name} and {starboard.name}: expected channels of their own, found {', '.join(twice)} in "
            "both; name in each vessel file the channels of its line."
        )


@refusing_none(SettingsError)
def run_both(
    recording: str | Path,
    trials: tuple[Trial, Trial],
    *,
    structures: Sequence[str | Structure] = (),
    settings: SettingsOf | None = None,
    seed: int = 1,
    now: datetime | None = None,
    tested_at: datetime | None = None,
    judge: bool = True,
    hints: Mapping[str, Any] | None = None,
    progress: Progress | None = None,
) -> SurveyOfBoth:
    """Identify both lines of a ship from one recording, each on its own lines, and the wash on the other's.

    Parameters
    ----------
    recording
        Path of the raw recording, which holds the channels of both.
    trials
        What was tested and asked of each side, port first; see ``load_trials_of_both``.
    structures, settings, now, tested_at, judge, hints, progress
        As for ``run``, the same for both sides.
    seed
        For the starts of the searches, the same for both sides.

    Raises
    ------
    ShaftprintError
        If the recording does not give what a structure describes, of either side.
    """
    port, starboard = (
        run(
            recording,
            trial.vessel,
            trial.campaign,
            structures=structures,
            settings=settings,
            sources=trial.sources,
            rng=np.random.default_rng(seed),
            now=now,
            tested_at=tested_at,
            conditions=trial.conditions,
            judge=judge,
            hints=hints,
            progress=progress,
        )
        for trial in trials
    )
    return SurveyOfBoth(
        port=port,
        starboard=starboard,
        port_wash=wash_on(port, starboard),
        starboard_wash=wash_on(starboard, port),
    )
