"""Percent torque on the CAN bus: its clock, its steps, its latency, and that nothing else hears of it."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.tug.ideal_signals import simulate_signals

from shaftprint.errors import SettingsError
from shaftprint.recording import read_recording
from shaftprint.tug import Noise, Tug, sail
from shaftprint.tug.plant._voyage import Stretch
from shaftprint.tug.sensors._bus import Bus
from shaftprint.tug.sensors._control_unit import ControlUnit
from shaftprint.vessel import RackSensor, Vessel, load_vessel

Make = Callable[..., Any]

SHIP = load_vessel("stan-tug-1205-ecu")


def with_sensor(vessel: Vessel, **changes: Any) -> Vessel:
    content = vessel.model_dump()
    content["sensors"]["rack"] |= changes
    return Vessel.model_validate(content)


def stretch_of(rack: np.ndarray, start: int = 0, *, engine_rpm: float = 0.0) -> Stretch:
    zeros = np.zeros(rack.size)
    return Stretch(
        time_s=(start + np.arange(rack.size)) / 2000.0,
        shaft_speed_rev_s=zeros + engine_rpm / 60.0 / 3.82,
        shaft_angle_rev=zeros,
        engine_speed_rev_s=zeros + engine_rpm / 60.0 / 3.82,
        engine_angle_rev=zeros,
        shaft_torque_nm=zeros,
        brake_torque_nm=zeros,
        rack_given=rack,
        limited=zeros > 0.0,
        machine_nm=zeros,
        pitch_change=zeros,
        ship_speed_m_s=zeros,
        demand_rev_s=zeros,
    )


def test_bus_adds_a_channel_and_changes_no_other(
    vessel: Vessel, vessel_with_bus: Vessel, ask: Make, tmp_path: Path
) -> None:
    for name, ship in (("without", vessel), ("with", vessel_with_bus)):
        sail(ship, ask(20.0), tmp_path / f"{name}.nc", seed=5)
    with read_recording(tmp_path / "without.nc") as plain, read_recording(tmp_path / "with.nc") as logged:
        assert set(logged.channels) - set(plain.channels) == {"X_percent"}
        for name, channel in plain.channels.items():
            assert np.array_equal(channel.read(0, channel.count), logged.channel(name).read(0, channel.count))
        bus = logged.channel("X_percent")
        assert (bus.unit, bus.rate_hz, bus.scale, bus.offset) == ("%", 20.0, 1.0, -125.0)
        assert 0.0 < bus.start_s < 0.05
        assert bus.count == 400
        assert bus.read(0, 400).dtype == np.int16
        # 465.54 of 1172.44 N m is 39.7 %
        assert np.mean(bus.values(0, 400)) == pytest.approx(39.7, abs=1.0)


@pytest.mark.parametrize(
    ("sensor", "latency_s"),
    [
        ({}, 0.01),
        ({"cycle_s": 0.02, "resolution_percent": 0.1, "latency_s": 0.0433}, 0.0433),
        ({"cycle_s": 0.1, "latency_s": 0.0}, 0.0),
        ({"cycle_s": 0.033}, 0.0721),
    ],
)
def test_every_message_holds_what_the_governor_gave_a_latency_ago(
    vessel_with_bus: Vessel,
    ask: Make,
    sine: Make,
    quiet: Noise,
    tmp_path: Path,
    sensor: dict[str, float],
    latency_s: float,
) -> None:
    campaign = ask(21.0, sines=[sine(0.8, 0.6)])
    ship = with_sensor(vessel_with_bus, **sensor)
    stated = ship.sensors.rack.latency_s
    tug = Tug(noise=quiet, rack_latency_s=None if stated == latency_s else latency_s)
    truth = sail(ship, campaign, tmp_path / "bus.nc", tug=tug, seed=1)
    assert truth.normalised["t_rack"] == pytest.approx(latency_s - stated, abs=1e-15)
    with read_recording(tmp_path / "bus.nc") as recording:
        bus = recording.channel("X_percent")
        time_s, percent = bus.time_s(0, bus.count), bus.values(0, bus.count)
    true = simulate_signals(ship, campaign, tug=tug, rate_hz=2000.0)
    expected = 100.0 * np.interp(time_s - latency_s, true.time_s, true.rack_given)
    step = ship.sensors.rack.resolution_percent
    assert np.abs(percent - expected).max() < 0.5001 * step
    assert np.abs(percent - expected).max() > 0.4 * step
    assert percent / step == pytest.approx(np.round(percent / step), abs=1e-9)
    assert np.ptp(percent) > 20.0
    assert 0.0 <= 21.0 - time_s[-1] < ship.sensors.rack.cycle_s + 1e-3


def test_beyond_125_percent_the_message_cannot_go() -> None:
    sensor = RackSensor(channel="X", unit="%", cycle_s=0.01, latency_s=0.0)
    unit = ControlUnit(sensor, SHIP, latency_s=0.0, first_rack=0.4, rate_hz=2000.0, rng=np.random.default_rng(1))
    counts = unit.next(stretch_of(np.concatenate([np.full(200, 1.6), np.full(200, -1.6)])))
    assert set(counts.tolist()) == {250, 0}


def test_stretches_shorter_than_a_message_lose_none() -> None:
    sensor = RackSensor(channel="X", unit="%", cycle_s=0.05, latency_s=0.02, resolution_percent=0.01)
    rack = 0.4 + 1e-4 * np.arange(3000.0)
    counts = []
    for size in (3000, 7, 1):
        unit = ControlUnit(sensor, SHIP, latency_s=0.02, first_rack=0.4, rate_hz=2000.0, rng=np.random.default_rng(1))
        parts = [unit.next(stretch_of(rack[start : start + size], start)) for start in range(0, 3000, size)]
        counts.append(np.concatenate(parts))
        # of a ramp of 20 % a second
        expected = 40.0 + 20.0 * (unit.times.start_s + 0.05 * np.arange(counts[-1].size) - 0.02)
        assert counts[-1] * 0.01 - 125.0 == pytest.approx(np.maximum(expected, 40.0), abs=0.0051)
        assert unit.faults() == []
    assert counts[0].size == 30
    assert np.array_equal(counts[0], counts[1])
    assert np.array_equal(counts[0], counts[2])


def test_latency_may_be_longer_than_the_cycle(vessel_with_bus: Vessel, ask: Make, quiet: Noise, tmp_path: Path) -> None:
    levels = {"name": "St", "levels_v": [-5.0, -6.0], "dwell_s": 5.0, "start_s": 0.0}
    tug = replace(Tug(noise=quiet), rack_latency_s=0.4)
    sail(vessel_with_bus, ask(10.0, staircases=[levels]), tmp_path / "late.nc", tug=tug, seed=1)
    with read_recording(tmp_path / "late.nc") as recording:
        bus = recording.channel("X_percent")
        time_s, percent = bus.time_s(0, bus.count), bus.values(0, bus.count)
    # step at 5 s, set-point latency 51.8 ms, then the bus
    assert time_s[np.flatnonzero(percent > 41.0)[0]] == pytest.approx(5.0518 + 0.4, abs=0.05)


def test_messages_with_jitter_and_losses_carry_the_rack_of_their_own_times(
    vessel_with_bus: Vessel, ask: Make, sine: Make, quiet: Noise, tmp_path: Path
) -> None:
    campaign = ask(61.0, sines=[sine(0.8, 0.6)])
    ship = with_sensor(vessel_with_bus, cycle_s=0.02, resolution_percent=0.01)
    tug = Tug(noise=quiet, message_jitter=0.15, messages_lost=0.05)
    sail(ship, campaign, tmp_path / "bus.nc", tug=tug, seed=1)
    with read_recording(tmp_path / "bus.nc") as recording:
        bus = recording.channel("X_percent")
        assert bus.is_uneven
        time_s, percent = bus.time_s(0, bus.count), bus.values(0, bus.count)
    true = simulate_signals(ship, campaign, tug=tug, rate_hz=2000.0)
    expected = 100.0 * np.interp(time_s - 0.01, true.time_s, true.rack_given)
    assert np.abs(percent - expected).max() < 0.00501
    assert bus.count == pytest.approx(0.95 * 61.0 / 0.02, rel=0.01)
    # as far from the cycle as was asked for
    place = (time_s - time_s.mean()) / 0.02
    away = 0.02 * (place - np.rint(place))
    assert away.std() == pytest.approx(0.003, rel=0.05)
    assert 0.0 <= time_s[0] < 0.05 < 60.9 < time_s[-1] < 61.0


def test_times_of_messages_do_not_depend_on_how_the_voyage_is_cut() -> None:
    sensor = RackSensor(channel="X", unit="%", cycle_s=0.02, latency_s=0.03, resolution_percent=0.01)
    rack = 0.4 + 1e-4 * np.arange(6000.0)
    results = []
    for size in (6000, 11, 1):
        unit = ControlUnit(
            sensor, SHIP, latency_s=0.03, first_rack=0.4, rate_hz=2000.0, rng=np.random.default_rng(1),
            bus=Bus(jitter=0.25, lost=0.2),
        )  # fmt: skip
        parts = [unit.messages(stretch_of(rack[start : start + size], start)) for start in range(0, 6000, size)]
        counts, times = (np.concatenate(column) for column in zip(*parts, strict=True))
        assert counts * 0.01 - 125.0 == pytest.approx(np.maximum(40.0 + 20.0 * (times - 0.03), 40.0), abs=0.0051)
        results.append((counts, times))
    for counts, times in results[1:]:
        assert np.array_equal(times, results[0][1])
        assert np.array_equal(counts, results[0][0])


def test_messages_that_wait_carry_the_rack_of_their_cycle() -> None:
    """The stamps are as far from the cycle as with values of their own, the values are those of the cycle."""
    sensor = RackSensor(channel="X", unit="%", cycle_s=0.02, latency_s=0.03, resolution_percent=0.01)
    rack = 0.4 + 1e-4 * np.arange(6000.0)
    bus = Bus(jitter=0.25, lost=0.2, waits=True)
    unit = ControlUnit(
        sensor, SHIP, latency_s=0.03, first_rack=0.4, rate_hz=2000.0, rng=np.random.default_rng(1), bus=bus
    )
    counts, times = unit.messages(stretch_of(rack))
    cycle = unit.times.start_s + 0.02 * np.rint((times - unit.times.start_s) / 0.02)
    assert counts * 0.01 - 125.0 == pytest.approx(np.maximum(40.0 + 20.0 * (cycle - 0.03), 40.0), abs=0.0051)
    assert (times - cycle).std() == pytest.approx(0.005, rel=0.1)


@pytest.mark.parametrize("changes", [{"message_jitter": 0.3}, {"messages_lost": 1.0}, {"message_jitter": -0.1}])
def test_a_bus_that_cannot_be_is_refused(
    vessel_with_bus: Vessel, ask: Make, tmp_path: Path, changes: dict[str, float]
) -> None:
    with pytest.raises(SettingsError, match="expected"):
        sail(vessel_with_bus, ask(5.0), tmp_path / "bus.nc", tug=Tug(**changes), seed=1)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("fields", "expected", "step"),
    [
        # half way on the full-load curve from 1038 N m at 819 rpm to 1277 N m at 981 rpm; 1172.44 N m are rated
        ({"unit": "%", "shows": "load"}, 40.0 * 1172.44 / 1157.5, 1.0),
        # half of the rated speed
        ({"unit": "L/h", "rated_l_h": 58.0}, 58.0 * 0.4 * 0.5, 0.05),
    ],
)
def test_load_and_fuel_rate_are_those_of_rack_and_speed(fields: Any, expected: float, step: float) -> None:
    sensor = RackSensor(channel="X", cycle_s=0.02, latency_s=0.0, **fields)
    unit = ControlUnit(sensor, SHIP, latency_s=0.0, first_rack=0.4, rate_hz=2000.0, rng=np.random.default_rng(1))
    counts = unit.next(stretch_of(np.full(4000, 0.4), engine_rpm=900.0))
    assert (unit.logged.scale, unit.logged.offset) == (step, 0.0)
    assert counts * step == pytest.approx(expected, abs=0.51 * step)
