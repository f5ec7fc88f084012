"""What a nonlinear fit is put together from: drive, orders, structure, starts, numbers of limits."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from tests.made_signals import made_channels

from shaftprint.campaign import Campaign
from shaftprint.catalogue import limited
from shaftprint.errors import IdentificationError
from shaftprint.identify import Estimate, GivenStarts
from shaftprint.signals import SetPointCalibration, Signals, WorkingPoint
from shaftprint.time_domain import NonlinearSettings, record_from_arrays, structure_for
from shaftprint.time_domain.nonlinear._drive import with_exact_jumps
from shaftprint.time_domain.nonlinear._limited_sines import limited_sines
from shaftprint.time_domain.nonlinear._numbers import limit_numbers
from shaftprint.time_domain.nonlinear._orders import without_orders
from shaftprint.time_domain.nonlinear._search import SomeDrawn
from shaftprint.vessel import load_vessel

POINT = WorkingPoint(
    engine_speed_rev_s=20.0,
    shaft_torque_nm=1700.0,
    engine_speed_std_rev_s=0.002,
    shaft_torque_std_nm=17.0,
    set_point_v=-5.0,
    load_std=0.01,
)


@dataclass(frozen=True)
class Fit:
    parameters: tuple[Estimate, ...]


@pytest.fixture(scope="module")
def vessel():
    return load_vessel("stan-tug-1205")


def staircase(start_s=10.0, dwell_s=10.0):
    stair = {"name": "St1", "levels_v": (-5.0, -3.0), "dwell_s": dwell_s, "start_s": start_s}
    return Campaign.model_validate({"name": "one step", "duration_s": 60.0, "offset_v": -5.0, "staircases": [stair]})


def rung_step(time_s, at_s, height, band_hz=80.0):
    """A jump behind a symmetric low pass, a sinc of 12 lobes in a Hann window: it rings before and behind itself."""
    fine = np.linspace(-12.0, 12.0, 120_001)
    integral = np.cumsum(np.sinc(fine) * (1.0 + np.cos(np.pi * fine / 12.0)))
    integral /= integral[-1]
    return height * np.interp(2.0 * band_hz * (time_s - at_s), fine, integral)


@pytest.mark.parametrize("at_s", [20.0, 20.0013, 19.9981])
def test_a_jump_is_a_jump_again(at_s):
    time = np.arange(0.0, 40.0, 0.005)
    drive = rung_step(time, at_s, -0.4)
    assert drive.min() < -0.41
    record = record_from_arrays("St1", {"n_set": drive}, {"n": np.zeros(time.size)}, rate_hz=200.0)
    sharp = with_exact_jumps(record, staircase(), rate_hz=400.0)
    grid = (np.arange(sharp.drive["n_set"].size) - sharp.margin) / 400.0
    found = sharp.drive["n_set"]
    near = np.abs(grid - at_s) < 0.08
    before = near & (grid < at_s - 0.5 / 400.0 - 1e-4)
    after = near & (grid > at_s + 1.5 / 400.0 + 1e-4)
    assert np.allclose(found[before], 0.0, atol=1e-3)
    assert np.allclose(found[after], -0.4, atol=1e-3)
    # the ramp begins within half a sample of the jump, a sample long
    begins = grid[np.flatnonzero(np.abs(found) < 1e-3)[-1]]
    assert abs(begins - at_s) <= 0.5 / 400.0 + 2e-4
    assert sharp.every == 2


def test_where_nothing_jumps_the_drive_stays(vessel):
    time = np.arange(0.0, 40.0, 0.005)
    drive = 0.1 * np.sin(0.5 * time)
    record = record_from_arrays("C1", {"n_set": drive}, {"n": np.zeros(time.size)}, rate_hz=200.0)
    quiet = staircase().model_copy(update={"staircases": ()})
    assert np.allclose(with_exact_jumps(record, quiet, rate_hz=200.0).drive["n_set"], drive)
    still = replace(record, drive={"n_set": np.zeros(time.size)})
    assert not np.any(with_exact_jumps(still, staircase(), rate_hz=200.0).drive["n_set"])


def test_orders_of_the_shaft_leave_the_torque_and_slow_motion_stays(vessel):
    time = np.arange(0.0, 120.0, 0.005)
    speed = 20.0 + 4.0 * np.sin(2.0 * np.pi * 0.05 * time)
    turned = 20.0 * time - 4.0 / (2.0 * np.pi * 0.05) * (np.cos(2.0 * np.pi * 0.05 * time) - 1.0)
    slow = 1700.0 * (speed / 20.0) ** 2 + 60.0 * np.sin(2.0 * np.pi * 0.7 * time)
    waves = 0.13 * np.cos(2.0 * np.pi * turned / 2.0 + 0.3) + 0.09 * np.sin(2.0 * np.pi * turned / vessel.gearbox.ratio)
    signals = Signals(
        rate_hz=200.0,
        start_s=0.0,
        channels=made_channels(POINT, speed, slow * (1.0 + waves), {"n_e": {"channel": "PTM", "values": speed}}),
        working_point=POINT,
        calibration=SetPointCalibration(
            slope_rev_s_per_v=-4.0,
            intercept_rev_s=0.0,
            covariance=1e-8 * np.eye(2),
            level_v=np.array([-5.0]),
            level_rev_s=np.array([20.0]),
            level_std_rev_s=np.array([0.002]),
        ),
        dc_scale=1.0,
        dc_scale_std=0.001,
        strips=(),
        step_delays=(),
        repairs=(),
        mode="shaftprint",
        recording_sha256="0" * 64,
        recording_name="made.nc",
    )
    clean = without_orders(signals, vessel)
    inner = (time > 2.0) & (time < 118.0)
    left = (clean.shaft_torque_nm - slow)[inner]
    assert np.std(left) < 0.05 * np.std((slow * waves)[inner])
    assert abs(np.mean(left)) < 1.0
    assert clean.set_point_rev_s is signals.set_point_rev_s
    assert clean.shaft_torque_nm.flags.writeable is False
    lost = signals.with_channel("M_s", values=np.full(time.size, np.nan))
    assert np.all(np.isnan(without_orders(lost, vessel).shaft_torque_nm))


def test_what_is_known_of_the_limits_is_where_they_start(vessel):
    known = {"m_max": 2.8, "r_x": 3.8, "d_e": 0.01, "K_p": 5.0}
    model = structure_for(("torque", "rate"), vessel, POINT, start=known)
    assert model.limits == ("torque", "rate")
    assert model.start["m_max"] == 2.8
    assert model.start["r_x"] == 3.8
    assert "d_e" not in model.start
    # nothing brakes the line visibly: the lower limit is out of the way
    assert model.names == ("m_max", "T_aw", "r_x")
    lowest = next(p for p in model.structure.parameters if p.name == "m_min")
    assert (lowest.held, lowest.value) == (True, -2.0)


def test_a_motoring_limit_that_is_known_is_free(vessel):
    model = structure_for(("torque", "smoke"), vessel, POINT, start={"m_min": -0.64, "a_0": 0.5})
    assert model.start == {"m_min": -0.64, "a_0": 0.5}
    assert set(model.names) == {"m_max", "m_min", "T_aw", "a_0", "tau_tc"}


def test_limits_by_name(vessel):
    assert structure_for(("smoke",), vessel, POINT).limits == ("torque", "smoke")
    assert structure_for(("deadband",), vessel, POINT).names == ("d_e",)
    with pytest.raises(IdentificationError, match="expected some of torque, rate, deadband, ramp, smoke, found speed"):
        structure_for(("speed",), vessel, POINT)
    with pytest.raises(IdentificationError, match="found none"):
        structure_for((), vessel, POINT)


def test_starts_are_drawn_in_some_directions_only_and_wide_ranges_by_their_logarithm():
    draw = SomeDrawn(np.array([1.0, 2.0, 3.0]), (1, 2))
    starts = draw.starts(np.array([0.0, 0.1, 0.0]), np.array([2.0, 1000.0, 4.0]), 41, np.random.default_rng(1))
    assert np.array_equal(starts[0], [1.0, 2.0, 3.0])
    assert np.all(starts[:, 0] == 1.0)
    # one start in each of forty cells: ten a decade, and half below the middle
    assert [int(np.sum((starts[1:, 1] >= a) & (starts[1:, 1] < 10.0 * a))) for a in (0.1, 1.0, 10.0, 100.0)] == [10] * 4
    assert int(np.sum(starts[1:, 2] < 2.0)) == 20
    given = GivenStarts(np.array([[1.0], [5.0]]))
    assert given.starts(np.zeros(1), np.full(1, 2.0), 3, np.random.default_rng(1)).tolist() == [[1.0], [2.0], [1.0]]


def estimate(name, value, std):
    return Estimate(name=name, unit="-", value=value, std=std)


def test_numbers_of_limits_in_the_units_of_the_ship(vessel):
    engine = vessel.engine.model_copy(
        update={"full_load_speed_rpm": (600.0, 1800.0), "full_load_torque_nm": (1000.0, 1600.0)}
    )
    gearbox = vessel.gearbox.model_copy(update={"ratio": 4.0, "efficiency": 0.85})
    gauge = vessel.sensors.shaft_torque.model_copy(update={"scale_std_fraction": 0.02})
    sensors = vessel.sensors.model_copy(update={"shaft_torque": gauge})
    ship = vessel.model_copy(update={"engine": engine, "gearbox": gearbox, "sensors": sensors})
    fit = Fit((estimate("K_p", 5.0, 0.1), estimate("m_max", 3.0, 0.03), estimate("m_min", -0.5, 0.0),
               estimate("r_x", 4.0, 0.03), estimate("d_e", 0.005, 0.001), estimate("T_aw", 0.5, 0.1),
               estimate("a_0", 0.5, 0.1), estimate("tau_tc", 1.0, 0.1)))  # fmt: skip
    found = {number.name: number for number in limit_numbers(fit, POINT, ship)}
    # M_b0 = 1700 / (4 * 0.85) = 500 N m, known to 1 %; full load at 1200 rpm is 1300 N m
    assert found["M_max"].value == pytest.approx(1500.0)
    assert found["share"].value == pytest.approx(1500.0 / 1300.0)
    assert found["m_max"].std == pytest.approx(np.hypot(0.03, 2.0 * 0.01))
    # 15 N m of the fit, 5 N m of the working point, 30 N m of the gauge
    assert found["M_max"].std == pytest.approx(np.sqrt(15.0**2 + 5.0**2 + 30.0**2))
    assert found["M_min"].value == pytest.approx(-250.0)
    assert found["M_min"].std == pytest.approx(np.hypot(5.0, 5.0))
    assert found["r_x"].std == pytest.approx(np.hypot(0.03, 0.04))
    assert found["R_x"].value == pytest.approx(2000.0)
    assert found["R_x"].std == pytest.approx(np.hypot(15.0, 40.0))
    assert found["d_e_rpm"].value == pytest.approx(6.0)
    assert found["d_e_rpm"].std == pytest.approx(1.2)
    assert {"T_aw", "a_0", "tau_tc"} < set(found)
    assert "K_p" not in found


def test_what_is_not_known_stays_unknown(vessel):
    found = limit_numbers(Fit((estimate("m_max", 3.0, np.inf),)), POINT, vessel)
    assert all(np.isinf(number.std) for number in found)


def test_a_sine_is_touched_where_its_rack_moves_too_fast():
    """A slow proportional governor: at 0.5 Hz the rack follows K_p n_set, 2 * 2 pi 0.5 * 0.02 = 0.13 of X_0/s."""
    rate = limited("rate")
    loop = {"K_p": 2.0, "K_i": 1.0, "t_d": 0.05, "omega_n": 20.0, "zeta": 0.7, "tau_dn": 0.3, "tau_up": 1.0}
    time = np.arange(0.0, 20.0, 0.01)
    records = [
        record_from_arrays(
            name,
            {"n_set": size * np.sin(np.pi * time)},
            {"n": np.cos(np.pi * time), "M_s": np.sin(np.pi * time)},
            rate_hz=100.0,
            used=time > 10.0,
        )
        for name, size in (("S1", 0.02), ("S2", 0.2))
    ]
    assert limited_sines(rate, {**loop, "r_x": 0.5}, records) == ("S2",)
    assert limited_sines(rate, {**loop, "r_x": 50.0}, records) == ()
    # a line that is not stable says nothing about small signals
    assert limited_sines(rate, {**loop, "K_p": 20.0, "t_d": 0.4, "r_x": 50.0}, records[:1]) == ("S1",)


def test_settings_are_positive():
    with pytest.raises(IdentificationError, match="nonlinear fit: expected positive numbers"):
        NonlinearSettings(kept=0)
