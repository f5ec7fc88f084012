"""What was tested and what was asked of it, with the files that say so."""

import hashlib
from dataclasses import dataclass, field
from datetime import datetime
from importlib.resources import files
from pathlib import Path
from typing import Literal

from shaftprint.campaign._campaign import Campaign, load_campaign
from shaftprint.campaign._trial_conditions import TrialConditions, load_trial_conditions
from shaftprint.errors import SettingsError
from shaftprint.fingerprint._line_fingerprint import SourceFile
from shaftprint.notebook._shown import Shown
from shaftprint.settings import settings_content
from shaftprint.vessel._vessel import Vessel, load_vessel


@dataclass(frozen=True, kw_only=True, slots=True, repr=False)
class Trial(Shown):
    """What was tested: the vessel, the campaign and the files that describe them."""

    vessel: Vessel
    """The installation."""
    campaign: Campaign
    """What was asked of it."""
    sources: tuple[SourceFile, ...] = ()
    """The files with their hashes; none for what was made in a program."""
    conditions: TrialConditions = field(default_factory=TrialConditions)
    """When, where and in what water it was tested, as far as somebody says so."""

    def began(self, stated: datetime | None, by_the_recording: datetime | None) -> datetime | None:
        """Return when a test began, in the zone of its conditions where it is known without an offset.

        Raises
        ------
        SettingsError
            If clocks of its zone show that time twice or never.
        """
        conditions = self.conditions
        if stated is not None:
            conditions = conditions.model_copy(update={"tested_at": stated})
        try:
            return conditions.began(by_the_recording)
        except ValueError as error:
            raise SettingsError(f"When the test began: {error}.") from None


def load_trial(
    vessel: str | Path | Vessel,
    campaign: str | Path | Campaign,
    conditions: str | Path | TrialConditions | None = None,
) -> Trial:
    """Return vessel and campaign, each from a path, by a shipped name, or as it is.

    A density of the water that the conditions state takes the place of that of the vessel file.

    Parameters
    ----------
    vessel, campaign
        What was tested and what was asked of it.
    conditions
        When, where and in what water: a path, or loaded; nothing where it is not given.

    Raises
    ------
    SettingsError
        If one of them cannot be used.
    """
    sources: list[SourceFile] = []
    if not isinstance(vessel, Vessel):
        name = str(vessel)
        vessel = load_vessel(name)
        sources.append(_source("vessel", name))
    if not isinstance(campaign, Campaign):
        name = str(campaign)
        campaign = load_campaign(name)
        sources.append(_source("campaign", name))
    if not isinstance(conditions, TrialConditions):
        conditions = TrialConditions() if conditions is None else load_trial_conditions(conditions)
    if conditions.water_density_kg_m3 is not None:
        vessel = vessel.model_copy(update={"water_density_kg_m3": conditions.water_density_kg_m3})
    return Trial(vessel=vessel, campaign=campaign, sources=tuple(sources), conditions=conditions)


def settings_text(kind: Literal["vessel", "campaign"], path_or_name: str) -> bytes:
    """Return the content of a settings file that has been loaded before."""
    return settings_content(path_or_name, shipped=files(f"shaftprint.{kind}") / "shipped")


def _source(kind: Literal["vessel", "campaign"], path_or_name: str) -> SourceFile:
    content = settings_text(kind, path_or_name)
    return SourceFile(role=kind, name=Path(path_or_name).name, sha256=hashlib.sha256(content).hexdigest())
