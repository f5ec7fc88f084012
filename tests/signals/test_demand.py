"""The demand inside the control unit, logged beside the set point: how late it is."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.errors import SignalError
from shaftprint.recording import Recording
from shaftprint.signals import WorkingPoint, prepare_signals
from shaftprint.signals._signals import SetPointDelay
from shaftprint.survey import priors_of
from shaftprint.vessel import Vessel

LATE_S = 0.08
# a line of which nothing is known of its bend
UNBENT = SimpleNamespace(bend=0.0, bend_std=np.inf)


def vessel_with_demand(vessel, **changes):
    content = vessel.model_dump()
    demand = {"channel": "Desired", "unit": "rpm", "cycle_s": 0.02, "latency_s": 0.0}
    content["sensors"]["demand"] = demand | changes
    return Vessel.model_validate(content)


def with_demand(ship, make_channel, *, held=False, rpm=None, step=0.125, unit="rpm"):
    """Messages every 20 ms with 15 % of jitter, a tenth of them lost; or each held on the clock of the logger."""
    rng = np.random.default_rng(8)
    time = 0.0137 + 0.02 * np.arange(12_400) + (0.0 if held else 0.003) * np.sqrt(3.0) * rng.uniform(-1.0, 1.0, 12_400)
    time = time if held else time[rng.random(time.size) > 0.1]
    asked = 60.0 * np.interp(time - LATE_S, ship.time_s, ship.set_point_rev_s) if rpm is None else rpm(time)
    shown = step * np.rint(asked / step)
    if held:
        # the logger sees a message half a sample after it came, on average
        start_s = float(time[0]) + 0.5 / 2000.0
        channel = make_channel(np.repeat(shown, 40), name="Desired", unit=unit, rate_hz=2000.0, start_s=start_s)
    else:
        channel = make_channel(shown, name="Desired", unit=unit, rate_hz=50.0, start_s=float(time[0]))
        channel = replace(channel, stamps=lambda first, stop: time[first:stop], is_uneven=True)
    channels = dict(replace(ship, prepared=ship).recording().channels) | {"Desired": channel}
    return Recording(path=Path("ship.nc"), sha256="0" * 64, format="memory", channels=channels)


@pytest.mark.parametrize("held", [False, True])
def test_the_demand_tells_the_latency_of_the_set_point(vessel, ship, campaign, make_channel, held):
    raw = with_demand(ship, make_channel, held=held)
    signals = prepare_signals(raw, vessel_with_demand(vessel, latency_s=0.03), campaign)
    found = signals.set_point_delay
    # 30 of the 80 ms are the bus
    assert (found.channel, found.lines) == ("Desired", 3)
    assert found.std_s < 5e-4
    assert found.delay_s == pytest.approx(LATE_S - 0.03, abs=max(4.0 * found.std_s, 1e-4))
    (finding,) = [one for one in signals.findings if "Desired" in one]
    assert finding.startswith("the demand in channel Desired comes 5")
    assert finding.endswith(" ms behind the set point, which is taken for its latency")
    # it is no answer of the line
    assert "Desired" not in {one.channel for one in signals.channels.values()}


def test_another_course_tells_nothing(vessel, ship, campaign, make_channel):
    """Set points of another engine: the same lines, each late by another time."""

    def other(time):
        late = np.where(time < 162.0, 0.1, np.where(time < 201.0, 1.0, 2.2))
        return 60.0 * np.interp(time - late, ship.time_s, ship.set_point_rev_s)

    signals = prepare_signals(with_demand(ship, make_channel, rpm=other), vessel_with_demand(vessel), campaign)
    assert signals.set_point_delay is None
    assert any("channel Desired does not follow the set point with one delay" in one for one in signals.findings)
    still = with_demand(ship, make_channel, rpm=lambda time: np.full(time.size, 1200.0))
    signals = prepare_signals(still, vessel_with_demand(vessel), campaign)
    assert signals.set_point_delay is None
    assert any("expected at least 3 sines that it shows, found 0" in one for one in signals.findings)


def test_a_demand_that_is_not_there_is_named(vessel, ship, campaign, make_channel):
    raw = with_demand(ship, make_channel, unit="%")
    with pytest.raises(SignalError, match=r'channel Desired: expected the unit "rpm" for the demand, found "%"'):
        prepare_signals(raw, vessel_with_demand(vessel), campaign)
    with pytest.raises(SignalError, match=r"or take \[sensors.demand\] out where it was not logged"):
        prepare_signals(raw, vessel_with_demand(vessel, channel="Other"), campaign)


def test_what_was_found_is_known_of_the_latency(vessel):
    point = WorkingPoint(
        engine_speed_rev_s=19.7, shaft_torque_nm=1725.0, engine_speed_std_rev_s=0.01, shaft_torque_std_nm=3.0,
        set_point_v=-5.0, load_std=0.001,
    )  # fmt: skip
    found = SetPointDelay(channel="Desired", delay_s=0.052, std_s=0.0003, lines=9)
    of_test = {"working_point": point, "mode": "shaftprint", "excitations": {}, "calibration": UNBENT}
    of_test["channels"] = {"M_s": SimpleNamespace(value_rate_hz=2000.0)}
    signals = SimpleNamespace(set_point_delay=found, dc_scale_std=0.0, **of_test)
    known = vessel_with_demand(vessel, latency_s=0.01, latency_std_s=0.0004)
    prior = priors_of(structure("GAUGE-CLOSED"), known, signals)["t_sp"]
    assert (prior.mean, prior.std) == (0.052, pytest.approx(0.0005))
    assert prior.sources == {"demand noise": 0.0003, "demand latency": 0.0004}
    without = SimpleNamespace(set_point_delay=None, dc_scale_std=0.0, **of_test)
    assert "t_sp" not in priors_of(structure("GAUGE-CLOSED"), known, without)
