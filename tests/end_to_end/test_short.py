"""A test of a quarter of an hour, from the raw recording on: what may not depend on how it was stored or read."""

import hashlib

import numpy as np
import pytest

from shaftprint.fingerprint import physical_quantities
from shaftprint.identify import profile_intervals
from shaftprint.recording import read_recording, write_mat_v73, write_recording
from shaftprint.signals import prepare_signals


@pytest.fixture(scope="module")
def found(short_trip, short_campaign, identified):
    return identified(short_trip.path, short_campaign)


def expect_same(one, other):
    """All signals, calibrations and repairs are the same to the last bit."""
    assert np.array_equal(one.set_point_rev_s, other.set_point_rev_s)
    assert np.array_equal(one.shaft_torque_nm, other.shaft_torque_nm)
    assert list(one.speeds) == list(other.speeds)
    for name in one.speeds:
        assert np.array_equal(one.speeds[name].speed_rev_s, other.speeds[name].speed_rev_s)
        assert one.speeds[name].pulse_rate_hz == other.speeds[name].pulse_rate_hz
    assert one.working_point == other.working_point
    assert (one.dc_scale, one.dc_scale_std) == (other.dc_scale, other.dc_scale_std)
    assert one.calibration.slope_rev_s_per_v == other.calibration.slope_rev_s_per_v
    assert np.array_equal(one.calibration.covariance, other.calibration.covariance)
    for strips, others in zip(one.strips, other.strips, strict=True):
        assert np.array_equal(strips.angle_rev, others.angle_rev)
    assert one.step_delays == other.step_delays
    assert one.repairs == other.repairs
    assert one.findings == other.findings


def test_truth_lies_inside_the_intervals(found, short_trip):
    truth = dict(short_trip.truth.normalised) | {"c_set": 1.0, "t_gauge": 0.0}
    outside = [
        name
        for name, interval in profile_intervals(found.fit).items()
        if name in truth and not (interval.lower <= truth[name] <= interval.upper)
    ]
    # 11 parameters or so, 95 % each: two or more outside for 10 % of the seeds
    assert len(outside) <= 1


def test_inertia_slope_and_delay_are_near_the_truth(found, vessel):
    """Wider than after the full campaign: a tenth of its length."""
    physical = {q.name: q.value for q in physical_quantities(found.fit, found.signals.working_point, vessel)}
    assert physical["I_dn"] == pytest.approx(17.0, rel=0.03)
    assert found.fit.value("k_q") == pytest.approx(2.0, rel=0.02)
    total = next(c for c in found.fit.combinations if c.name == "t_d + t_sp")
    assert total.value == pytest.approx(0.1221, abs=4.0 * total.std)
    assert total.std < 0.05 * total.value


@pytest.mark.slow
@pytest.mark.parametrize("mode", ["shaftprint", "thesis"])
def test_signals_do_not_depend_on_how_much_is_read_at_a_time(short_trip, vessel, short_campaign, mode):
    with read_recording(short_trip.path) as recording:
        whole, *cut = [
            prepare_signals(recording, vessel, short_campaign, mode=mode, chunk_s=seconds)
            for seconds in (None, 7.3, 61.0)
        ]
    for signals in cut:
        expect_same(whole, signals)


@pytest.fixture(scope="module")
def matlab_path(short_trip, tmp_path_factory):
    path = tmp_path_factory.mktemp("matlab") / "short.mat"
    with read_recording(short_trip.path) as recording:
        write_mat_v73(path, recording.channels.values())
    return path


@pytest.mark.long
def test_matlab_file_gives_the_same(short_campaign, identified, found, matlab_path):
    """It holds values where the logger's own file holds counts: all that differs is the rounding of one product."""
    converted = identified(matlab_path, short_campaign)
    one, other = found.signals, converted.signals
    for name in one.speeds:
        assert np.array_equal(one.speeds[name].speed_rev_s, other.speeds[name].speed_rev_s)
    assert other.set_point_rev_s == pytest.approx(one.set_point_rev_s, rel=1e-13)
    assert other.shaft_torque_nm == pytest.approx(one.shaft_torque_nm, rel=1e-13)
    assert one.repairs == other.repairs
    assert other.recording_sha256 != one.recording_sha256
    assert other.recording_name == "short.mat"
    assert converted.fit.values == pytest.approx(found.fit.values, rel=1e-4)
    assert converted.fit.cost == pytest.approx(found.fit.cost, rel=1e-8)


@pytest.mark.slow
def test_same_values_in_another_container_give_the_same_to_the_last_bit(
    short_campaign, identified, matlab_path, tmp_path
):
    path = tmp_path / "values.nc"
    with read_recording(matlab_path) as recording:
        write_recording(path, recording.channels.values())
    matlab, native = identified(matlab_path, short_campaign), identified(path, short_campaign)
    expect_same(matlab.signals, native.signals)
    assert np.array_equal(matlab.spectra.response.response, native.spectra.response.response)
    assert np.array_equal(matlab.fit.values, native.fit.values)
    assert np.array_equal(matlab.fit.covariance, native.fit.covariance)


def test_same_seed_gives_the_same_fit(short_trip, short_campaign, identified, found):
    again = identified(short_trip.path, short_campaign)
    assert np.array_equal(again.fit.values, found.fit.values)


def test_other_starts_find_the_same_optimum(short_trip, short_campaign, identified, found):
    other = identified(short_trip.path, short_campaign, seed=2)
    assert other.fit.cost == pytest.approx(found.fit.cost, rel=1e-6)
    scatter = (other.fit.values - found.fit.values)[[not p.held for p in found.fit.structure.parameters]]
    assert np.abs(scatter / np.sqrt(np.diag(found.fit.covariance))).max() < 0.01


def test_raw_file_is_only_read(short_trip, found):
    assert hashlib.sha256(short_trip.path.read_bytes()).hexdigest() == found.signals.recording_sha256
