"""What a job of the fleet works on: one recording, the files that belong to it, and what is known of ship and water."""

from datetime import datetime
from pathlib import Path
from typing import Annotated, Any, Final

from pydantic import Field, ValidationError, field_validator

from shaftprint.campaign._trial_conditions import TrialConditions
from shaftprint.errors import SettingsError, StoreError
from shaftprint.records import faults
from shaftprint.settings import Name, PositiveInteger, Settings
from shaftprint.store._nouns import Line, Ship
from shaftprint.store._stated import Stated
from shaftprint.vessel._ship import ImoNumber, ShortName

OF_CONDITIONS: Final = tuple(TrialConditions.model_fields)
"""Facts of a test that no recording shows; they go into the fingerprint."""


class OnlyLine(Settings):
    """The line that a job may write to, and no other: whoever asked for it has a right to this one."""

    ship: ShortName
    """Name of the ship; what tells it from all others where it has no IMO number."""
    imo: ImoNumber | None = None
    """Its IMO number."""
    line: ShortName
    """Which of its lines."""


class JobArguments(Settings):
    """One recording to be identified."""

    recording: Name
    """Path of the recording, as every computer that works sees it."""
    vessel: Name
    """Path of the vessel file, or the name of a shipped one."""
    campaign: Name
    """Path of the campaign file, or the name of a shipped one."""
    structure: Name | None = None
    """Name of a shipped structure; that of vessel and campaign, as ``identify`` takes it, where there is none.

    Files with structures of one's own are programs, and no job runs them."""
    legs: tuple[Name, ...] = ()
    """Names of the legs of the campaign to use; all where there are none."""
    starts: PositiveInteger = 50
    """Starts of the search."""
    seed: Annotated[int, Field(strict=True, ge=0, le=2**63 - 1)] = 1
    """Seed of the starts."""
    ship: ShortName | None = None
    """Name of the ship, where the vessel file does not say it."""
    imo: ImoNumber | None = None
    """Its IMO number, where the vessel file does not say it."""
    line: ShortName | None = None
    """Its shaft line, where the vessel file does not say it."""
    class_name: ShortName | None = None
    """What its sister ships have in common, where the vessel file does not say it."""
    only: OnlyLine | None = None
    """The only line to which the result may be put; None where fingerprint and statements say which."""
    conditions: TrialConditions = TrialConditions()
    """When, where and in what water the test was made."""
    sha256: dict[str, str] = Field(default_factory=dict)
    """SHA-256 of recording, vessel file and campaign file when the job was asked for."""

    @field_validator("legs", mode="before")
    @classmethod
    def _from_json(cls, value: Any) -> Any:
        return tuple(value) if isinstance(value, list) else value

    @property
    def stated(self) -> Stated:
        """What is stated of the ship beside its fingerprint."""
        return Stated(ship=self.ship, imo_number=self.imo, line=self.line, class_name=self.class_name)

    @property
    def only_line(self) -> Line | None:
        """The only line to which the result may be put."""
        only = self.only
        return None if only is None else Line(ship=Ship(name=only.ship, imo_number=only.imo), position=only.line)

    def settings(self) -> dict[str, Any]:
        """Return what the result depends on besides the content of the files, as JSON has it."""
        elsewhere = {"recording", "vessel", "campaign", "sha256"}
        # a job of an earlier version, which knew neither, is the same one
        elsewhere |= {name for name in ("only", "class_name") if getattr(self, name) is None}
        return self.model_dump(mode="json", exclude=elsewhere)


def arguments_of(content: Any, *, named: str) -> JobArguments:
    """Return the arguments that a ledger holds.

    Raises StoreError if they are not those of such a job.
    """
    try:
        return JobArguments.model_validate(content)
    except ValidationError as error:
        raise StoreError(f"{named}: {faults(error)}; expected what shaftprint fleet run puts in.") from None


def job_arguments(
    recording: str | Path, vessel: str | Path, campaign: str | Path, *, named: str, **facts: Any
) -> JobArguments:
    """Return arguments for a recording, with paths that do not depend on the folder one is in.

    ``recording``, ``vessel``, ``campaign``: the files; vessel and campaign may be shipped names. ``named``: where they
    are stated, for errors. ``facts``: other fields of ``JobArguments`` and of ``TrialConditions``; those that are None
    count as not stated. Raises SettingsError if a field cannot be used.
    """
    known = {name: value for name, value in facts.items() if value is not None}
    conditions = {name: known.pop(name) for name in OF_CONDITIONS if name in known}
    began = conditions.get("tested_at")
    if isinstance(began, str):
        conditions["tested_at"] = _moment(began, named=named)
    try:
        return JobArguments(
            recording=str(Path(recording).absolute()),
            vessel=_absolute(vessel),
            campaign=_absolute(campaign),
            conditions=TrialConditions(**conditions),
            **known,
        )
    except ValidationError as error:
        raise SettingsError(f"{named}: {faults(error)}.") from None


def _absolute(path_or_name: str | Path) -> str:
    text = str(path_or_name)
    is_path = isinstance(path_or_name, Path) or text.endswith(".toml") or "/" in text or "\\" in text
    return str(Path(text).absolute()) if is_path else text


def _moment(text: str, *, named: str) -> datetime:
    try:
        return datetime.fromisoformat(text)
    except ValueError:
        raise SettingsError(
            f"{named}: tested_at: expected a time such as 2026-03-31T09:30+02:00, found {text[:40]!r}."
        ) from None
