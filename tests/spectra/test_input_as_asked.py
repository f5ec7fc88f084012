"""What sizes and phases of the sines say of the channel of what was moved, against the campaign file."""

import numpy as np
import pytest

from shaftprint.spectra.lines._input_band import band_reasons, input_band
from shaftprint.spectra.lines._input_clock import drift_of_phases

HERTZ = np.array([0.02, 0.035, 0.06, 0.15, 0.3, 0.5, 0.8, 1.25, 1.8, 2.4])
OMEGA = 2.0 * np.pi * HERTZ
NOISE = np.full(HERTZ.size, 2e-4)
MIDDLE_S = np.linspace(290.0, 850.0, HERTZ.size)


def shown(gain, rng):
    """What is logged of sines of one size, with a scale that is 1 % off."""
    return 1.01 * np.abs(gain) * (1.0 + NOISE * rng.standard_normal(HERTZ.size))


@pytest.fixture
def rng():
    return np.random.default_rng(8)


@pytest.mark.parametrize("corner_hz", [2.0, 5.0, 10.0])
def test_a_low_pass_is_named_with_its_corner(corner_hz, rng):
    band = input_band(HERTZ, shown(1.0 / (1.0 + 1j * HERTZ / corner_hz), rng), NOISE)
    assert band.late_s == pytest.approx(1.0 / (2.0 * np.pi * corner_hz), rel=0.05)
    (reason,) = band_reasons(band, channel="U", symbol="n_set")
    assert (reason.kind, reason.where) == ("set-point band", "n_set")
    assert f"low-pass of {corner_hz:.2g} Hz" in reason.sentence


@pytest.mark.parametrize("mean_s", [0.04, 0.1, 0.2])
def test_a_mean_or_hold_is_late_by_half_its_length(mean_s, rng):
    band = input_band(HERTZ, shown(np.sinc(HERTZ * mean_s), rng), NOISE)
    assert band.late_s == pytest.approx(0.5 * mean_s, rel=0.05)


def test_sines_as_they_were_asked_for_are_no_filter():
    """Of 300 healthy tests none; and what is not seen is stated, not less than it is."""
    rng = np.random.default_rng(9)
    bands = [input_band(HERTZ, shown(np.ones(HERTZ.size), rng), NOISE) for _ in range(300)]
    assert not any(band.late_s for band in bands)
    # a generator that steps every 10 ms is late by 5 ms, and no reason
    stepped = [input_band(HERTZ, shown(np.sinc(HERTZ * 0.01), rng), NOISE) for _ in range(50)]
    assert not any(band.late_s for band in stepped)
    assert np.mean([band.widest_s > 0.005 for band in stepped]) > 0.95


@pytest.mark.parametrize("size", [0.02, -0.03])
def test_a_size_that_changes_in_mid_test_is_no_filter(size, rng):
    band = input_band(HERTZ, shown(1.0 + size * (MIDDLE_S > 587.0), rng), NOISE)
    assert band.late_s == 0.0


# A torque behind the set point: a closed loop of 1 Hz, and the inertia behind the gauge.
TORQUE = 3.0 * (1.0 + 0.3j * OMEGA) / (1.0 + 2.0 * 0.4j * HERTZ - HERTZ**2)


@pytest.mark.parametrize("share", [0.02, -0.02, 0.05])
def test_a_share_of_another_channel_is_named_and_no_filter(share, rng):
    """What is logged is ``u + a y``; its response to what is logged is ``y / (u + a y)``."""
    logged = 1.0 + share * TORQUE
    answers = {"M_s": (TORQUE / logged).real, "n": (1.0 / (1.0 + 0.2j * OMEGA)).real}
    band = input_band(HERTZ, shown(logged, rng), NOISE, answers=answers)
    assert (band.beside, band.late_s) == ("M_s", 0.0)
    (reason,) = band_reasons(band, channel="U", symbol="n_set")
    assert (reason.kind, reason.where) == ("set-point shape", "n_set")
    assert "Channel U shows a share of another channel, M_s" in reason.sentence


def test_sines_as_they_were_asked_for_hold_no_other_channel():
    rng = np.random.default_rng(10)
    answers = {"M_s": TORQUE.real}
    bands = [input_band(HERTZ, shown(np.ones(HERTZ.size), rng), NOISE, answers=answers) for _ in range(300)]
    assert not any(band.beside for band in bands)
    # and a filter stays one where a torque answers
    filtered = input_band(HERTZ, shown(1.0 / (1.0 + 1j * HERTZ / 5.0), rng), NOISE, answers=answers)
    assert (filtered.beside, filtered.late_s > 0.0) == ("", True)


def late(delay_s, drift):
    """Phases by which sines are late, to whole turns."""
    turn = OMEGA * (delay_s + drift * MIDDLE_S)
    return np.angle(np.exp(1j * turn))


@pytest.mark.parametrize("delay_s", [0.0, -3.2, 1.7])
@pytest.mark.parametrize("drift", [0.0, 20e-6, -50e-6])
def test_a_clock_that_runs_beside_the_campaign_is_told_to_millionths(delay_s, drift, rng):
    turn = late(delay_s, drift) + 2e-4 * rng.standard_normal(HERTZ.size)
    assert drift_of_phases(OMEGA, turn, NOISE, MIDDLE_S) == pytest.approx(drift, abs=1e-6)


def test_sines_that_were_begun_by_hand_tell_no_clock(rng):
    turn = late(0.0, 0.0) + OMEGA * rng.normal(0.0, 0.2, HERTZ.size)
    assert drift_of_phases(OMEGA, np.angle(np.exp(1j * turn)), NOISE, MIDDLE_S) is None
