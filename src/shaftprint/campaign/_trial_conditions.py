"""When, where and in what water a test was made: what no recording shows, from a TOML file of its own."""

from datetime import datetime
from pathlib import Path
from typing import Annotated, Self

from pydantic import AfterValidator, Field, model_validator

from shaftprint.arguments import refusing_none
from shaftprint.errors import SettingsError
from shaftprint.settings import Name, NotNegativeNumber, Settings, read_settings
from shaftprint.zones import in_zone, possible, time_zone


def _zone_name(name: str) -> str:
    time_zone(name)
    return name


def _between(low: float, high: float) -> object:
    return Field(strict=True, allow_inf_nan=False, ge=low, le=high)


class TrialConditions(Settings):
    """The conditions of one test; what is not stated is not known."""

    tested_at: datetime | None = None
    """When the recording began, with the offset from UTC or in ``time_zone``; that of its file where not stated."""
    time_zone: Annotated[Name, AfterValidator(_zone_name)] | None = None
    """Zone of the logger's clock and of ``tested_at`` without an offset, such as ``Europe/Amsterdam`` or ``+02:00``."""
    place: Name | None = None
    """Where it was made; that of the campaign file where not stated."""
    draught_m: Annotated[float, _between(0.0, 50.0)] | None = None
    """Mean draught of the ship [m]."""
    trim_m: Annotated[float, _between(-30.0, 30.0)] | None = None
    """Draught aft minus draught forward [m]."""
    water_temperature_c: Annotated[float, _between(-3.0, 45.0)] | None = None
    """Temperature of the water [degrees Celsius]."""
    water_density_kg_m3: Annotated[float, _between(900.0, 1300.0)] | None = None
    """Density of the water [kg/m3]; takes the place of that of the vessel file."""
    depth_m: NotNegativeNumber | None = None
    """Depth of the water [m]."""
    wind_m_s: Annotated[float, _between(0.0, 100.0)] | None = None
    """Speed of the true wind [m/s]."""

    @model_validator(mode="after")
    def _is_an_instant(self) -> Self:
        if self.tested_at is not None:
            possible(self.tested_at)
        self.began(None)
        return self

    def began(self, by_the_recording: datetime | None) -> datetime | None:
        """Return when the test began: as stated, else by the logger's clock; None where neither says it.

        Without offset and zone it is what a clock showed somewhere, and comes without an offset.

        Parameters
        ----------
        by_the_recording
            What the recording's file says.

        Raises
        ------
        ValueError
            If clocks of the zone show that time twice or never.
        """
        began = self.tested_at or by_the_recording
        return began if began is None or self.time_zone is None else in_zone(began, time_zone(self.time_zone))


@refusing_none(SettingsError)
def load_trial_conditions(path: str | Path) -> TrialConditions:
    """Read the file of a test's conditions.

    Raises
    ------
    SettingsError
        If the file cannot be used; the message lists every field that is wrong.
    """
    return read_settings(path, TrialConditions)
