"""The measurement chain: every raw channel against what its sensor is said to do."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.tug.ideal_signals import simulate_signals

from shaftprint.recording import read_recording
from shaftprint.tug import Noise, Truth, Tug, sail
from shaftprint.tug.sensors._faults import draw_dropouts, draw_times
from shaftprint.tug.sensors._gauge import shaft_orders
from shaftprint.vessel import Vessel

Make = Callable[..., Any]
RATE_HZ = 2000.0


def recorded(vessel: Vessel, campaign: Any, tug: Tug, path: Path, seed: int = 4) -> tuple[dict[str, Any], Truth]:
    truth = sail(vessel, campaign, path, tug=tug, seed=seed, overwrite=True)
    with read_recording(path) as recording:
        values = {name: channel.values(0, channel.count) for name, channel in recording.channels.items()}
    return values, truth


def edges_s(voltage: np.ndarray) -> np.ndarray:
    """Times at which the middle of the pulse height is crossed upwards."""
    threshold = 0.5 * (voltage.min() + voltage.max())
    before = np.flatnonzero((voltage[:-1] < threshold) & (voltage[1:] >= threshold))
    part = (threshold - voltage[before]) / (voltage[before + 1] - voltage[before])
    return (before + part) / RATE_HZ


@pytest.fixture(scope="module")
def steady(
    vessel: Vessel, ask: Make, quiet_tug: Tug, tmp_path_factory: pytest.TempPathFactory
) -> tuple[dict[str, Any], Truth]:
    return recorded(vessel, ask(40.0), quiet_tug, tmp_path_factory.mktemp("steady") / "steady.nc")


def test_channels_are_those_of_the_vessel(steady: tuple[dict[str, Any], Truth]) -> None:
    values, _ = steady
    assert set(values) == {"U_setpoint", "PTM_e", "PTM_1", "PTM_4", "M_s"}
    assert all(channel.size == 80_000 for channel in values.values())


def test_pulses_come_once_a_revolution(steady: tuple[dict[str, Any], Truth]) -> None:
    values, _ = steady
    assert np.diff(edges_s(values["PTM_e"])) == pytest.approx(60.0 / 1183.8, abs=3e-5)
    assert np.diff(edges_s(values["PTM_1"])) == pytest.approx(3.82 * 60.0 / 1183.8, abs=3e-5)


def test_strips_have_the_angles_of_table_3_4(steady: tuple[dict[str, Any], Truth]) -> None:
    values, truth = steady
    strips = {strip.channel: strip for strip in truth.strips}["PTM_4"]
    times = edges_s(values["PTM_4"])
    speed = 1183.8 / 60.0 / 3.82
    # the first strip to pass is the first whose edge lies ahead of where the shaft stands at the start
    edge_deg = np.concatenate(([0.0], np.cumsum(strips.angle_deg)))[:4]
    first = int(np.searchsorted(edge_deg, strips.start_deg)) % 4
    expected = np.array([90.40, 87.24, 90.74, 91.64]) * 360.0 / 360.02
    found = np.array([np.diff(times)[(k - first) % 4 :: 4].mean() for k in range(4)]) * speed * 360.0
    assert found == pytest.approx(expected, abs=0.05)
    assert strips.angle_deg == pytest.approx(expected)
    ahead = (edge_deg[first] - strips.start_deg) % 360.0
    assert times[0] == pytest.approx(ahead / 360.0 / speed, abs=3e-5)


def test_pulse_width_and_levels(steady: tuple[dict[str, Any], Truth]) -> None:
    values, _ = steady
    for channel, width_deg in (("PTM_e", 19.8), ("PTM_1", 25.4), ("PTM_4", 4 * 25.4)):
        assert np.mean(values[channel] > 2.5) == pytest.approx(width_deg / 360.0, rel=0.03)
        assert (values[channel].min(), values[channel].max()) == pytest.approx((0.35, 4.6), abs=0.01)


def test_edges_stand_where_the_angle_is_whole(
    vessel: Vessel, ask: Make, sine: Make, quiet_tug: Tug, tmp_path: Path
) -> None:
    campaign = ask(21.0, sines=[sine(0.5, 0.6)])
    values, truth = recorded(vessel, campaign, quiet_tug, tmp_path / "sine.nc")
    signals = simulate_signals(vessel, campaign, tug=quiet_tug, rate_hz=RATE_HZ)
    steps = 0.5 * (signals.engine_speed_rev_s[1:] + signals.engine_speed_rev_s[:-1]) / RATE_HZ
    angle = np.concatenate(([0.0], np.cumsum(steps)))
    start = next(strip.start_deg for strip in truth.strips if strip.channel == "PTM_e") / 360.0
    revolutions = np.interp(edges_s(values["PTM_e"]), signals.time_s, angle) + start
    assert revolutions == pytest.approx(np.round(revolutions), abs=25e-6 * 22.0)
    assert np.array_equal(np.diff(np.round(revolutions)), np.ones(revolutions.size - 1))


def test_falling_edge_marks_the_strip_where_the_vessel_says_so(
    vessel: Vessel, ask: Make, quiet_tug: Tug, tmp_path: Path
) -> None:
    content = vessel.model_dump()
    content["sensors"]["speed"][0].update(edge="falling", pulse_width_deg=None)
    values, truth = recorded(Vessel.model_validate(content), ask(5.0), quiet_tug, tmp_path / "falling.nc")
    falling = edges_s(-values["PTM_e"])
    start = truth.strips[0].start_deg / 360.0
    revolutions = falling * 19.73 + start
    assert revolutions == pytest.approx(np.round(revolutions), abs=1e-3)
    assert np.mean(values["PTM_e"] > 2.5) == pytest.approx(0.07, rel=0.05)


def test_jitter_has_its_size(vessel: Vessel, ask: Make, quiet: Noise, tmp_path: Path) -> None:
    tug = Tug(noise=replace(quiet, pulse_jitter_s=80e-6))
    values, _ = recorded(vessel, ask(60.0), tug, tmp_path / "jitter.nc")
    times = edges_s(values["PTM_e"])
    line = np.polynomial.Polynomial.fit(np.arange(times.size), times, 1)
    assert (times - line(np.arange(times.size))).std() == pytest.approx(80e-6, rel=0.12)


def test_missing_and_doubled_pulses_are_where_the_truth_says(
    vessel: Vessel, ask: Make, quiet: Noise, tmp_path: Path
) -> None:
    tug = Tug(noise=replace(quiet, missing_pulse_interval_s=6.0, doubled_pulse_interval_s=9.0))
    values, truth = recorded(vessel, ask(60.0), tug, tmp_path / "faults.nc")
    for channel, period in (("PTM_e", 60.0 / 1183.8), ("PTM_1", 3.82 * 60.0 / 1183.8)):
        times = edges_s(values[channel])
        number = np.round((times - times[0]) / period).astype(int)
        told = {
            kind: [fault.time_s for fault in truth.faults if (fault.channel, fault.kind) == (channel, kind)]
            for kind in ("missing pulse", "doubled pulse")
        }
        assert min(len(faults) for faults in told.values()) > 2
        absent = np.setdiff1d(np.arange(number[-1]), number)
        assert times[0] + period * absent == pytest.approx(told["missing pulse"], abs=1e-4)
        assert times[:-1][np.diff(number) == 0] == pytest.approx(told["doubled pulse"], abs=1e-4)


def test_steady_torque_is_scaled_and_stepped(steady: tuple[dict[str, Any], Truth], vessel: Vessel) -> None:
    values, _ = steady
    torque = vessel.sensors.shaft_torque.torque_nm(values["M_s"])
    # half a step of the telemetry and half a count of the logger
    assert torque == pytest.approx(1725.0, abs=1.22 + 0.08)
    assert np.unique(values["M_s"]).size == 1


def test_zero_and_reversed_gauge_are_undone_by_the_vessel(
    vessel: Vessel, ask: Make, quiet_tug: Tug, tmp_path: Path
) -> None:
    content = vessel.model_dump()
    content["sensors"]["shaft_torque"] |= {
        "zero_nm": 40.0,
        "scale_nm_per_unit": -250.0,
        "resolution_nm": None,
        "latency_s": 0.0,
    }
    content["logger"] = None
    other = Vessel.model_validate(content)
    values, _ = recorded(other, ask(2.0), quiet_tug, tmp_path / "zero.nc")
    assert values["M_s"] == pytest.approx(-(1725.0 + 40.0) / 250.0, abs=1e-3)
    assert other.sensors.shaft_torque.torque_nm(values["M_s"]) == pytest.approx(1725.0, abs=0.1)


def test_zero_that_nobody_knows_of_stays_in_the_torque(
    vessel: Vessel, ask: Make, quiet_tug: Tug, tmp_path: Path
) -> None:
    values, _ = recorded(vessel, ask(2.0), replace(quiet_tug, torque_zero_offset_nm=51.75), tmp_path / "offset.nc")
    shown = vessel.sensors.shaft_torque.torque_nm(values["M_s"])
    assert shown == pytest.approx(1725.0 + 51.75, abs=1.22 + 0.08)


def test_torque_is_late_by_the_latency_of_the_vessel(
    vessel: Vessel, ask: Make, sine: Make, quiet_tug: Tug, tmp_path: Path
) -> None:
    campaign = ask(21.0, sines=[sine(0.8, 0.6)])
    values, _ = recorded(vessel, campaign, quiet_tug, tmp_path / "late.nc")
    true = simulate_signals(vessel, campaign, tug=quiet_tug, rate_hz=RATE_HZ).shaft_torque_nm
    measured = vessel.sensors.shaft_torque.torque_nm(values["M_s"])
    slope = np.gradient(true, 1.0 / RATE_HZ)
    late = -((measured - true) @ slope) / (slope @ slope)
    assert late == pytest.approx(0.005, abs=5e-5)


def test_orders_of_the_torque_have_their_amplitudes(vessel: Vessel, ask: Make, quiet: Noise, tmp_path: Path) -> None:
    loud = Noise()
    names = ("half_order", "shaft_order", "blade_order", "twice_blade_order", "firing_order")
    tug = Tug(noise=replace(quiet, **{name: getattr(loud, name) for name in names}))
    values, _ = recorded(vessel, ask(40.0), tug, tmp_path / "orders.nc")
    torque = 500.0 * values["M_s"] / 1725.0
    shaft_hz = 1183.8 / 60.0 / 3.82
    time = np.arange(torque.size) / RATE_HZ
    for order, amplitude in ((1.0, 0.09), (3.0, 0.035), (6.0, 0.008), (1.91, 0.13), (11.46, 0.30)):
        turns = np.exp(-2j * np.pi * order * shaft_hz * time) * np.hanning(time.size) * 2.0
        # the low-pass filter takes 1 % at the firing order
        assert 2.0 * np.abs(np.mean(turns * torque)) == pytest.approx(amplitude, rel=0.02, abs=2e-4)
    assert sorted(shaft_orders(loud, vessel)) == pytest.approx([1.0, 1.91, 3.0, 6.0, 11.46])


def test_torque_noise_is_twice_the_signal_as_in_table_3_6(vessel: Vessel, ask: Make, tmp_path: Path) -> None:
    """0.5751 = sqrt(signal / (signal + noise)): with 25 % amplitude that is about a quarter of the mean torque."""
    values, _ = recorded(vessel, ask(60.0), Tug(noise=Noise().without(faults=True)), tmp_path / "noise.nc")
    assert 0.18 < values["M_s"].std() * 500.0 / 1725.0 < 0.33
    assert values["U_setpoint"].std() == pytest.approx(0.0008, rel=0.02)
    low = values["PTM_1"][values["PTM_1"] < 0.45]
    assert low.std() == pytest.approx(0.02, rel=0.1)


def test_spikes_and_dropouts_are_where_the_truth_says(vessel: Vessel, ask: Make, quiet: Noise, tmp_path: Path) -> None:
    noise = replace(
        quiet,
        torque_spike_interval_s=4.0,
        set_point_spike_interval_s=4.0,
        torque_dropout_interval_s=5.0,
        torque_broadband_rms=0.02,
    )
    values, truth = recorded(vessel, ask(60.0), Tug(noise=noise), tmp_path / "faults.nc")
    kinds = {(fault.channel, fault.kind) for fault in truth.faults}
    assert kinds == {("M_s", "spike"), ("M_s", "hold"), ("M_s", "rail"), ("U_setpoint", "spike")}
    torque, voltage = values["M_s"], values["U_setpoint"]
    found = np.flatnonzero(np.abs(voltage + 5.0495) > 0.9) / RATE_HZ
    assert found == pytest.approx([fault.time_s for fault in truth.faults if fault.channel == "U_setpoint"])
    rails = np.zeros(torque.size, dtype=bool)
    # a dropout hides the spike within it
    for fault in sorted(truth.faults, key=lambda fault: (fault.kind != "spike", fault.time_s)):
        if fault.channel != "M_s":
            continue
        first = round(fault.time_s * RATE_HZ)
        last = first + round(fault.duration_s * RATE_HZ)
        if fault.kind == "hold":
            assert np.unique(torque[first - 1 : last]).size == 1
            rails[first:last] = rails[first - 1]
        elif fault.kind == "rail":
            assert torque[first:last] == pytest.approx(-10.0, abs=0.01)
            rails[first:last] = True
        else:
            assert first + 1 == last
            rails[first] = True
    assert np.flatnonzero(np.abs(torque - 3.45) > 0.6).tolist() == np.flatnonzero(rails).tolist()


def test_faults_are_drawn_within_the_recording() -> None:
    rng = np.random.default_rng(0)
    times = draw_times(1.0, 50.0, rng)
    assert np.all(np.diff(times) > 0.0)
    assert times.min() > 5.0
    assert times.max() < 50.0
    assert draw_times(0.0, 50.0, rng).size == 0
    crowded = replace(Noise(), torque_dropout_interval_s=0.05)
    dropouts = draw_dropouts(crowded, 50.0, RATE_HZ, rng)
    assert np.all(dropouts.start[1:] >= dropouts.stop[:-1])
    assert np.all(dropouts.stop > dropouts.start)


def test_a_current_loop_shows_no_torque_as_its_live_zero(
    vessel: Vessel, ask: Make, quiet_tug: Tug, tmp_path: Path
) -> None:
    content = vessel.model_dump()
    content["sensors"]["shaft_torque"] |= {"unit": "mA", "scale_nm_per_unit": 625.0, "reading_at_zero": 12.0}
    content["sensors"]["shaft_torque"] |= {"resolution_nm": None, "latency_s": 0.0}
    content["logger"] = None
    values, _ = recorded(Vessel.model_validate(content), ask(2.0), quiet_tug, tmp_path / "loop.nc")
    # 1725 N m of +/- 5000 in 8 mA about 12
    assert values["M_s"] == pytest.approx(12.0 + 1725.0 / 625.0, abs=1e-3)


def test_a_set_point_is_shown_in_its_unit(vessel: Vessel, ask: Make, quiet_tug: Tug, tmp_path: Path) -> None:
    content = vessel.model_dump()
    content["sensors"]["set_point"] |= {"unit": "mA", "v_per_unit": 0.625, "v_at_zero": -12.5}
    content["logger"] = None
    values, _ = recorded(Vessel.model_validate(content), ask(2.0), quiet_tug, tmp_path / "lever.nc")
    # 4 to 20 mA for -10 to 0 V, and the potentiometer's 0.0495 V below the -5 V of the campaign
    assert values["U_setpoint"] == pytest.approx(12.0 - 0.0495 * 1.6, abs=0.005)
