"""Channels in memory, and a small ship in closed form that fills them."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from shaftprint.campaign import Campaign, setpoint
from shaftprint.recording import Channel, Recording
from shaftprint.vessel import Vessel, load_vessel

Array = NDArray[np.float64]


def channel_of(
    values: NDArray[Any], *, name: str = "X", unit: str = "V", rate_hz: float = 2000.0, **more: Any
) -> Channel:
    return Channel(
        name=name,
        unit=unit,
        rate_hz=rate_hz,
        start_s=more.pop("start_s", 0.0),
        count=values.size,
        source=lambda first, stop: values[first:stop],
        **more,
    )


def blocks_of(values: NDArray[Any], size: int) -> Iterator[NDArray[Any]]:
    """Cut an array into consecutive blocks."""
    for first in range(0, values.size, size):
        yield values[first : first + size]


def pulses_at(angle_rev: Array, places_rev: Array, *, width_rev: float = 0.06, ramp_rev: float = 0.03) -> Array:
    """Return pulses between 0 and 1 whose leading flank is half way up at each place of a revolution."""
    train = np.zeros(angle_rev.size)
    for place in places_rev:
        turned = (angle_rev - place + 0.5) % 1.0 - 0.5
        rise = np.clip(turned / ramp_rev + 0.5, 0.0, 1.0)
        fall = np.clip((width_rev - turned) / ramp_rev + 0.5, 0.0, 1.0)
        train = np.maximum(train, np.minimum(rise, fall))
    return train


@dataclass(kw_only=True)
class Ship:
    """A ship whose speed follows the set point with a first-order lag, and whose torque is quadratic in it."""

    campaign: Campaign
    rate_hz: float = 2000.0
    noise: float = 1.0
    extra_s: float = 0.0
    changes: dict[str, Callable[[NDArray[Any]], NDArray[Any]]] = field(default_factory=dict)
    """What to do to the raw counts of a channel."""
    units: dict[str, str] = field(default_factory=dict)
    gear_ratio: float = 3.82
    slope_rev_s_per_v: float = -4.18
    intercept_rev_s: float = -1.39
    lag_s: float = 0.15
    strips_rev: tuple[float, ...] = (0.26, 0.23, 0.27, 0.24)
    torque_latency_s: float = 0.005

    prepared: "Ship | None" = None

    def __post_init__(self) -> None:
        if self.prepared is not None:
            self.counts = self.prepared.counts
            return
        rng = np.random.default_rng(7)
        count = round((self.campaign.duration_s + self.extra_s) * self.rate_hz)
        self.time_s = np.arange(count) / self.rate_hz
        volts = setpoint(self.campaign, self.time_s)
        self.set_point_rev_s = self.slope_rev_s_per_v * volts + self.intercept_rev_s
        # exact for a set point that is constant between samples
        share = 1.0 - np.exp(-1.0 / (self.rate_hz * self.lag_s))
        speed = np.empty(count)
        state = self.set_point_rev_s[0]
        for k, asked in enumerate(self.set_point_rev_s.tolist()):
            speed[k] = state
            state += share * (asked - state)
        self.speed_rev_s = speed
        self.angle_rev = np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1])) / self.rate_hz]) + 0.3
        self.torque_nm = 1700.0 * (speed / 19.5) ** 2
        late = np.interp(self.time_s - self.torque_latency_s, self.time_s, self.torque_nm)
        shaft = self.angle_rev / self.gear_ratio
        strips = np.concatenate([[0.0], np.cumsum(self.strips_rev[:-1])]) + 0.1
        analog = {
            "PTM_e": 0.3 + 4.0 * pulses_at(self.angle_rev, np.array([0.2])),
            "PTM_1": 0.3 + 4.0 * pulses_at(shaft, np.array([0.7])),
            "PTM_4": 0.3 + 4.0 * pulses_at(shaft, strips),
            "M_s": late / 500.0 + 0.06 * self.noise * rng.standard_normal(count),
            "U_setpoint": volts + 0.0005 * self.noise * rng.standard_normal(count),
        }
        self.counts = {
            name: np.rint(
                (values + (0.01 * self.noise * rng.standard_normal(count) if "PTM" in name else 0.0)) * 3200.0
            )
            .clip(-32768, 32767)
            .astype(np.int16)
            for name, values in analog.items()
        }

    def recording(self) -> Recording:
        channels = {}
        for name, counts in self.counts.items():
            changed = self.changes.get(name, lambda values: values)(counts.copy())
            floating = changed.dtype != np.int16
            channels[name] = channel_of(
                changed / 3200.0 if floating else changed,
                name=name,
                unit=self.units.get(name, "V"),
                rate_hz=self.rate_hz,
                scale=1.0 if floating else 1.0 / 3200.0,
            )
        return Recording(path=Path("ship.nc"), sha256="0" * 64, format="memory", channels=channels)


@pytest.fixture(scope="session")
def make_channel() -> Callable[..., Channel]:
    return channel_of


@pytest.fixture(scope="session")
def cut() -> Callable[[NDArray[Any], int], Iterator[NDArray[Any]]]:
    return blocks_of


@pytest.fixture(scope="session")
def pulse_train() -> Callable[..., Array]:
    return pulses_at


@pytest.fixture(scope="session")
def vessel() -> Vessel:
    return load_vessel("stan-tug-1205")


@pytest.fixture(scope="session")
def campaign() -> Campaign:
    """One minute of levels and a minute of slow sines."""
    return Campaign.model_validate(
        {
            "name": "short",
            "duration_s": 250.0,
            "offset_v": -5.0,
            "staircases": [{"name": "St", "levels_v": [-4.0, -5.5, -5.0], "dwell_s": 22.0, "start_s": 20.0}],
            "sines": [
                {
                    "name": f"S{number}",
                    "frequency_hz": frequency,
                    "amplitude_v": 0.5,
                    "start_s": start,
                    "settled_s": start + 8.0,
                    "stop_s": stop,
                }
                for number, frequency, start, stop in (
                    (1, 0.05, 110.0, 160.0),
                    (2, 0.1, 165.0, 200.0),
                    (3, 0.15, 202.0, 230.0),
                )
            ],
        }
    )


@pytest.fixture(scope="session")
def ship(campaign: Campaign) -> Ship:
    return Ship(campaign=campaign)


@pytest.fixture(scope="session")
def silent_ship(campaign: Campaign) -> Ship:
    """The same without noise."""
    return Ship(campaign=campaign, noise=0.0)


@pytest.fixture(scope="session")
def spoiled(ship: Ship) -> Callable[..., Recording]:
    """The recording of the ship with changes to the counts of some channels."""

    def record(units: dict[str, str] | None = None, **changes: Callable[[NDArray[Any]], NDArray[Any]]) -> Recording:
        return replace(ship, changes=changes, units=units or {}, prepared=ship).recording()

    return record
