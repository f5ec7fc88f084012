"""One simulated short test in memory, to be spoilt: channels, vessel and campaign."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from numpy.typing import NDArray

from shaftprint.campaign import Campaign, load_campaign
from shaftprint.recording import Channel, Recording, read_recording
from shaftprint.tug import Truth, sail
from shaftprint.vessel import Vessel, load_vessel

SEED = 3
VESSEL, CAMPAIGN = "stan-tug-1205", "short"
SET_POINT, SPEED, TORQUE = "U_setpoint", "PTM_e", "M_s"
PICK_UPS = ("PTM_e", "PTM_1", "PTM_4")

Values = NDArray[np.float64]
Change = Callable[["Trial"], "Trial"]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Trial:
    """A recording with the files that describe it."""

    recording: Recording
    """Channels in memory, int16 counts as the logger stored them."""
    vessel: Vessel
    """The vessel file."""
    campaign: Campaign
    """The campaign file."""

    def time_s(self, channel: str) -> Values:
        """Return when the samples of a channel were taken [s]."""
        one = self.recording.channels[channel]
        return one.time_s(0, one.count)

    def values(self, channel: str) -> Values:
        """Return the samples of a channel in its unit."""
        one = self.recording.channels[channel]
        return one.values(0, one.count)

    def with_values(self, channel: str, values: Values) -> "Trial":
        """Return the trial with other samples of a channel, in counts as a logger stores them."""
        one = self.recording.channels[channel]
        counts = np.clip(np.rint((values - one.offset) / one.scale), -32768, 32767).astype(np.int16)
        return self.with_channel(channel, source=lambda first, stop: counts[first:stop], count=counts.size)

    def with_channel(self, channel: str, **fields: object) -> "Trial":
        """Return the trial with other attributes of a channel."""
        changed = replace(self.recording.channels[channel], **fields)
        channels = {**self.recording.channels, channel: changed}
        return replace(self, recording=replace(self.recording, channels=channels))

    def with_sensor(self, sensor: str, **fields: object) -> "Trial":
        """Return the trial with other statements of the vessel file on a sensor."""
        changed = getattr(self.vessel.sensors, sensor).model_copy(update=fields)
        sensors = self.vessel.sensors.model_copy(update={sensor: changed})
        return replace(self, vessel=self.vessel.model_copy(update={"sensors": sensors}))

    def with_density(self, kg_m3: float) -> "Trial":
        """Return the trial with another density of the water in the vessel file."""
        return replace(self, vessel=self.vessel.model_copy(update={"water_density_kg_m3": kg_m3}))

    def with_vessel(self, part: str, **fields: object) -> "Trial":
        """Return the trial with other statements of the vessel file on a part of it."""
        changed = getattr(self.vessel, part).model_copy(update=fields)
        return replace(self, vessel=self.vessel.model_copy(update={part: changed}))


@cache
def clean() -> tuple[Trial, Truth]:
    """Return the trial as it was sailed, and what was put into it."""
    vessel, campaign = load_vessel(VESSEL), load_campaign(CAMPAIGN)
    with TemporaryDirectory() as folder:
        path = Path(folder) / "short.h5"
        truth = sail(vessel, campaign, path, seed=SEED)
        with read_recording(path) as opened:
            channels = {name: _in_memory(channel) for name, channel in opened.channels.items()}
            recording = replace(opened, channels=channels, release=lambda: None)
    return Trial(recording=recording, vessel=vessel, campaign=campaign), truth


def _in_memory(channel: Channel) -> Channel:
    counts = channel.read(0, channel.count)
    return replace(channel, source=lambda first, stop: counts[first:stop])
