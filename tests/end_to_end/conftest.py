"""The simulated tug and the whole way from its raw recording to a fit."""

from dataclasses import dataclass, replace

import numpy as np
import pytest

from shaftprint.campaign import load_campaign
from shaftprint.catalogue import structure
from shaftprint.identify import Identification, Prior, Settings, identify
from shaftprint.recording import read_recording, write_recording
from shaftprint.signals import Signals, prepare_signals
from shaftprint.spectra import Spectra, estimate_spectra
from shaftprint.tug import Truth, sail
from shaftprint.vessel import load_vessel


@dataclass(frozen=True, kw_only=True)
class Trip:
    """A raw recording and the truth behind it."""

    path: object
    truth: Truth


@dataclass(frozen=True, kw_only=True)
class Found:
    """What was made of a recording."""

    signals: Signals
    spectra: Spectra
    fit: Identification


@dataclass(frozen=True, kw_only=True)
class SecondLogger:
    """A logger whose clock is behind and slow, and which was started later."""

    offset_s: float = 0.4
    drift: float = 30e-6
    began_s: float = 5.0

    def true_time_s(self, own_s):
        """Return the first logger's time of a time of this one."""
        return own_s + self.offset_s + self.drift * own_s

    def of(self, channel):
        """Return what it makes of the voltage of a channel, in 16 bits of +/-10 V."""
        count = int((channel.duration_s - self.true_time_s(self.began_s)) * channel.rate_hz) - 4000

        def source(start, stop):
            if start == stop:
                return np.empty(0, dtype=np.int16)
            own_s = self.began_s + np.arange(start, stop) / channel.rate_hz
            places = (self.true_time_s(own_s) - channel.start_s) * channel.rate_hz
            first = int(places[0])
            values = channel.values(first, int(places[-1]) + 2)
            return np.rint(np.interp(places, first + np.arange(values.size), values) * 3276.8).astype(np.int16)

        return replace(channel, start_s=self.began_s, count=count, scale=1.0 / 3276.8, offset=0.0, source=source)


@pytest.fixture(scope="session")
def second_logger():
    return SecondLogger()


@pytest.fixture(scope="session")
def vessel():
    return load_vessel("stan-tug-1205")


@pytest.fixture(scope="session")
def short_campaign():
    return load_campaign("short")


@pytest.fixture(scope="session")
def short_trip(vessel, short_campaign, tmp_path_factory):
    path = tmp_path_factory.mktemp("short") / "short.nc"
    return Trip(path=path, truth=sail(vessel, short_campaign, path, seed=3))


@pytest.fixture(scope="session")
def identified(vessel):
    """The way from a raw recording to the gauge-aware fit; ``g`` is known to 0.1, everything else is not."""

    def find(path, campaign, seed=1, ship=vessel):
        with read_recording(path) as recording:
            signals = prepare_signals(recording, ship, campaign)
        spectra = estimate_spectra(signals, campaign)
        fit = identify(
            structure("GAUGE-CLOSED"),
            spectra.response,
            rng=np.random.default_rng(seed),
            settings=Settings(priors={"g": Prior(0.0, 0.1)}),
        )
        return Found(signals=signals, spectra=spectra, fit=fit)

    return find


@pytest.fixture(scope="session")
def spoil(short_trip):
    """A copy of the short recording with some channels left out or their values changed."""

    def write(path, change=None, *, channels=None, leave_out=(), unit=None):
        with read_recording(short_trip.path) as recording:
            copied = []
            for name, channel in recording.channels.items():
                if name in leave_out:
                    continue
                if channels is None or name in channels:
                    values = change(channel.values(0, channel.count)) if change else channel.values(0, channel.count)
                    channel = replace(
                        channel,
                        unit=channel.unit if unit is None else unit,
                        scale=1.0,
                        offset=0.0,
                        count=values.size,
                        source=lambda start, stop, values=values: values[start:stop],
                    )
                copied.append(channel)
            write_recording(path, copied)
        return path

    return write
