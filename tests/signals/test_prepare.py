from dataclasses import replace

import numpy as np
import pytest

from shaftprint.signals import Signals, prepare_signals


@pytest.fixture(scope="module")
def signals(ship, vessel, campaign) -> Signals:
    return prepare_signals(ship.recording(), vessel, campaign)


@pytest.fixture(scope="module")
def silent(silent_ship, vessel, campaign) -> Signals:
    return prepare_signals(silent_ship.recording(), vessel, campaign)


@pytest.fixture(scope="module")
def thesis(silent_ship, vessel, campaign) -> Signals:
    return prepare_signals(silent_ship.recording(), vessel, campaign, mode="thesis")


def away_from_steps(count: int = 50_000) -> np.ndarray:
    time = np.arange(count) / 200.0
    away = (time > 1.0) & (time < 249.0)
    for step in (20.0, 42.0, 64.0, 86.0, 110.0, 160.0, 165.0, 200.0, 202.0, 230.0):
        away &= np.abs(time - step - 0.4) > 1.0
    return away


def test_grid_and_provenance(signals):
    assert (signals.rate_hz, signals.start_s, signals.samples) == (200.0, 0.0, 50_000)
    assert (signals.recording_name, signals.recording_sha256) == ("ship.nc", "0" * 64)
    assert signals.mode == "shaftprint"
    assert list(signals.speeds) == ["n_e", "n_e1", "n_e4"]
    assert signals.engine_speed.name == "n_e"
    assert not signals.shaft_torque_nm.flags.writeable


def test_speeds_are_those_of_the_engine_on_every_channel(signals, ship):
    true = ship.speed_rev_s[::10]
    away = away_from_steps()
    # one count of noise in a flank of a hundred counts; few knots on the slow shaft
    for name, error in (("n_e", 6e-4), ("n_e1", 1e-3), ("n_e4", 6e-4)):
        found = signals.speeds[name]
        assert np.sqrt(np.mean((found.speed_rev_s / true - 1.0)[away] ** 2)) < error
        assert (found.averaging_s, found.hold_s, found.delay_s) == (0.0, 0.0, 0.0)
    mean = float(np.mean(ship.speed_rev_s))
    rates = [signals.speeds[name].pulse_rate_hz for name in ("n_e", "n_e1", "n_e4")]
    assert rates == pytest.approx([mean, mean / 3.82, 4.0 * mean / 3.82], rel=2e-3)
    assert signals.speeds["n_e4"].nyquist_hz == pytest.approx(2.0 * mean / 3.82, rel=2e-3)


def test_strip_angles_within_a_hundredth_of_a_degree(signals, ship):
    (strips,) = signals.strips
    assert strips.channel == "PTM_4"
    true = np.array(ship.strips_rev) * 360.0
    turned = min(np.abs(np.roll(strips.angle_rev * 360.0, k) - true).max() for k in range(4))
    assert turned < 0.01


def test_line_and_scale_of_the_set_point(signals, ship):
    line = signals.calibration
    assert line.slope_rev_s_per_v == pytest.approx(ship.slope_rev_s_per_v, rel=5e-4)
    assert line.level_v == pytest.approx([-5.5, -5.0, -4.0], abs=2e-3)
    assert line.level_rev_s == pytest.approx(ship.slope_rev_s_per_v * line.level_v + ship.intercept_rev_s, rel=2e-4)
    assert signals.dc_scale * line.slope_rev_s_per_v == pytest.approx(ship.slope_rev_s_per_v, rel=5e-4)
    assert 0.0 < signals.dc_scale_std < 1e-3
    away = away_from_steps()
    assert signals.set_point_rev_s[away] == pytest.approx(ship.set_point_rev_s[::10][away], rel=1e-3)


def test_torque_is_on_time_and_in_newton_metres(silent, silent_ship):
    away = away_from_steps()
    # one count is 0.16 N m
    assert silent.shaft_torque_nm[away] == pytest.approx(silent_ship.torque_nm[::10][away], abs=0.3)


def test_working_point(signals, ship):
    n_0 = ship.slope_rev_s_per_v * -5.0 + ship.intercept_rev_s
    point = signals.working_point
    assert point.engine_speed_rev_s == pytest.approx(n_0, rel=1e-4)
    assert point.shaft_torque_nm == pytest.approx(1700.0 * (n_0 / 19.5) ** 2, rel=1e-3)
    assert point.set_point_v == pytest.approx(-5.0, abs=1e-3)
    assert 0.0 < point.engine_speed_std_rev_s < 1e-3 * n_0


def test_delay_of_a_first_order_lag_is_its_half_time(signals, ship):
    half_time = ship.lag_s * np.log(2.0)
    assert [delay.rising for delay in signals.step_delays] == [True, False]
    for delay, instant in zip(signals.step_delays, (42.0, 64.0), strict=True):
        # the set point of sample k holds from k to k + 1
        assert delay.set_point_time_s == pytest.approx(instant, abs=1e-3)
        # within a revolution of 50 ms the spline must guess
        assert delay.delay_s == pytest.approx(half_time, abs=0.015)


def test_clean_recording_needs_no_repair(signals):
    assert signals.repairs == ()
    assert signals.findings == ()


def test_faults_are_repaired_and_listed_in_order_of_time(spoiled, vessel, campaign, signals):
    def torque(counts):
        counts[[100_000, 200_000]] = -3000
        counts[300_000:300_100] = counts[300_000]
        return counts

    def set_point(counts):
        counts[150_000] = 20_000
        return counts

    def pulses(counts):
        # one revolution at 39 pulses in 2 s: the pulse after 40 s disappears
        counts[80_000:80_110] = np.minimum(counts[80_000:80_110], 1200)
        return counts

    found = prepare_signals(spoiled(M_s=torque, U_setpoint=set_point, PTM_e=pulses), vessel, campaign)
    assert [(repair.channel, repair.kind, round(repair.time_s, 1)) for repair in found.repairs] == [
        ("PTM_e", "missing pulse", 40.0),
        ("M_s", "outlier", 50.0),
        ("U_setpoint", "outlier", 75.0),
        ("M_s", "outlier", 100.0),
        ("M_s", "dropout", 150.0),
    ]
    assert found.shaft_torque_nm == pytest.approx(signals.shaft_torque_nm, abs=40.0)
    assert found.set_point_rev_s == pytest.approx(signals.set_point_rev_s, abs=1e-3)
    assert found.engine_speed.speed_rev_s == pytest.approx(signals.engine_speed.speed_rev_s, rel=5e-3)


@pytest.mark.slow
@pytest.mark.parametrize("mode", ["shaftprint", "thesis"])
def test_any_chunk_gives_the_same_bits(ship, vessel, campaign, mode):
    whole = prepare_signals(ship.recording(), vessel, campaign, mode=mode)
    for chunk_s in (0.0085, 3.3333):
        cut = prepare_signals(ship.recording(), vessel, campaign, mode=mode, chunk_s=chunk_s)
        assert np.array_equal(cut.set_point_rev_s, whole.set_point_rev_s)
        assert np.array_equal(cut.shaft_torque_nm, whole.shaft_torque_nm)
        for name, speed in whole.speeds.items():
            assert np.array_equal(cut.speeds[name].speed_rev_s, speed.speed_rev_s)
        assert cut.repairs == whole.repairs
        assert cut.working_point == whole.working_point


def test_progress_runs_from_nothing_to_all(ship, vessel, campaign):
    shares = []
    prepare_signals(ship.recording(), vessel, campaign, chunk_s=50.0, progress=shares.append)
    assert shares == sorted(shares)
    assert len(shares) == 5 * 5
    assert shares[-1] == 1.0


def test_thesis_mode_shows_the_symptoms_of_the_thesis(thesis, silent, silent_ship):
    assert thesis.mode == "thesis"
    assert (thesis.dc_scale, thesis.dc_scale_std) == (1.0, 0.0)
    n_e, n_e4 = thesis.speeds["n_e"], thesis.speeds["n_e4"]
    assert n_e.delay_s == n_e.averaging_s == n_e.hold_s == pytest.approx(1.0 / n_e.pulse_rate_hz, rel=1e-6)
    steady = slice(1000, 3800)
    # uneven strips: 0.23 of a turn taken for a quarter reads 25/23 of the speed
    ratio = n_e4.speed_rev_s[steady] / silent_ship.speed_rev_s[::10][steady]
    assert ratio.max() == pytest.approx(0.25 / 0.23, rel=0.01)
    assert ratio.min() == pytest.approx(0.25 / 0.27, rel=0.01)
    # the speed comes a period late, and the torque with the latency of its telemetry
    late = [np.mean([step.delay_s for step in signals.step_delays]) for signals in (thesis, silent)]
    assert late[0] - late[1] == pytest.approx(n_e.delay_s, abs=0.03)
    assert thesis.shaft_torque_nm[8001:8200] == pytest.approx(silent_ship.torque_nm[80_000:82_000:10][1:200], abs=0.3)
    # the angles are found all the same
    assert thesis.strips[0].angle_rev == pytest.approx(silent.strips[0].angle_rev, abs=1e-12)


@pytest.mark.slow
def test_each_channel_has_its_own_clock(silent_ship, vessel, campaign):
    recording = silent_ship.recording()
    torque = recording.channels["M_s"]
    # every other sample, from sample 2001 on
    half = replace(
        torque,
        rate_hz=1000.0,
        start_s=2001 / 2000.0,
        count=248_999,
        source=lambda first, stop: torque.read(2001, torque.count)[::2][first:stop],
    )
    found = prepare_signals(replace(recording, channels={**recording.channels, "M_s": half}), vessel, campaign)
    assert found.start_s == 1.0005
    away = away_from_steps()
    away[:201] = False
    instants = np.flatnonzero(away)
    instants = instants[(instants > 300) & (instants < 49_700)]
    # sample j of the grid is raw sample 2001 + 10 j
    raw = 2001 + 10 * (instants - 201)
    assert found.shaft_torque_nm[instants - 201] == pytest.approx(silent_ship.torque_nm[raw], abs=0.4)
    assert found.set_point_rev_s[instants - 201] == pytest.approx(silent_ship.set_point_rev_s[raw], rel=1e-3)


def test_other_rate_of_the_grid(silent_ship, vessel, campaign, silent):
    found = prepare_signals(silent_ship.recording(), vessel, campaign, rate_hz=100.0)
    assert found.samples == 25_000
    assert found.engine_speed.speed_rev_s == pytest.approx(silent.engine_speed.speed_rev_s[::2], rel=1e-12)
    assert found.working_point.engine_speed_rev_s == pytest.approx(silent.working_point.engine_speed_rev_s, rel=1e-4)
