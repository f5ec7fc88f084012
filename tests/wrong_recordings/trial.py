"""Two simulated tests in memory, to be spoilt: channels, vessel and campaign."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import lru_cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from numpy.typing import NDArray

from shaftprint.campaign import Campaign, load_campaign
from shaftprint.recording import Channel, Recording, read_recording
from shaftprint.tug import Noise, Truth, Tug, sail
from shaftprint.vessel import Vessel, load_vessel

SEED = 3
VESSEL = "stan-tug-1205"
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


@dataclass(frozen=True, kw_only=True, slots=True)
class Sailed:
    """A test that was sailed, and by what ship."""

    words: str
    """What it is, in words."""
    file: str
    """Name of its recording."""
    campaign: str
    """Shipped name or path of the campaign."""
    tug: Tug = field(default_factory=Tug)
    """The ship."""
    levels_v: tuple[float, ...]
    """Voltage of the working point, and of another that takes its place where the first one is lost [V]."""

    @property
    def speeds_rpm(self) -> tuple[float, ...]:
        """Return the true speeds there: the line bends about -5 V, at which it gives the speed of the vessel file."""
        slope, bend = self.tug.set_point_slope_rpm_per_v, self.tug.set_point_bend_per_v
        return tuple(1183.8 + slope * (v + 5.0) * (1.0 + 0.5 * bend * (v + 5.0)) for v in self.levels_v)


ONE_SPEED = Sailed(words="a campaign of 14 minutes at one speed", file="short.h5", campaign="short", levels_v=(-5.0,))
# The noise is not that of the ship for which the test was planned, and the lever is none of a laboratory.
TWO_SPEEDS = Sailed(
    words="a planned test of 12 minutes at two speeds",
    file="planned.h5",
    campaign=str(Path(__file__).parent / "planned.toml"),
    levels_v=(-5.707450199203, -3.971839043825),
    tug=Tug(
        set_point_bend_per_v=0.0015,
        set_point_hysteresis_v=0.004,
        generator_step_v=0.0049,
        noise=replace(
            Noise().scaled(1.2, but=("inflow_rms", "surge_rms")),
            inflow_rms=0.018,
            inflow_corner_hz=1.0 / (2.0 * np.pi * 30.0),
            surge_rms=0.003,
            surge_hz=0.12,
        ),
    ),
)


# The two good ones and the last of another ship.
@lru_cache(maxsize=3)
def clean(test: Sailed) -> tuple[Trial, Truth]:
    """Return the trial as it was sailed, and what was put into it."""
    vessel, campaign = load_vessel(VESSEL), load_campaign(test.campaign)
    with TemporaryDirectory() as folder:
        path = Path(folder) / test.file
        truth = sail(vessel, campaign, path, seed=SEED, tug=test.tug)
        with read_recording(path) as opened:
            channels = {name: _in_memory(channel) for name, channel in opened.channels.items()}
            recording = replace(opened, channels=channels, release=lambda: None)
    return Trial(recording=recording, vessel=vessel, campaign=campaign), truth


def of_ship(test: Sailed, tug: Mapping[str, object]) -> Sailed:
    """Return a test that another ship sailed."""
    return replace(test, tug=replace(test.tug, **tug)) if tug else test


def _in_memory(channel: Channel) -> Channel:
    counts = channel.read(0, channel.count)
    return replace(channel, source=lambda first, stop: counts[first:stop])
