"""Where an error of a model can lie: all of it stays, and p-values and intervals are right with less noise."""

import numpy as np
import pytest
from scipy.signal import butter, sosfiltfilt

from shaftprint.validation.measures._misfit import Compared, Unfiltered, misfit_of
from shaftprint.validation.measures._noise_pieces import NoisePieces
from shaftprint.validation.measures._reach import EVERYWHERE, Swept, WhileSettling, while_settling

RATE_HZ = 50.0
SAMPLES = 700
TIME_S = np.arange(SAMPLES) / RATE_HZ - 2.0
LOW_PASS = butter(4, 4.0, fs=RATE_HZ, output="sos")
RESONANCE = butter(1, (0.9, 1.6), "bandpass", fs=RATE_HZ, output="sos")
SETTLING = WhileSettling(first=100, stop=300, stride=3)
SWEPT = Swept(rate_hz=RATE_HZ, lowest_hz=1.6)
AFTER = np.clip(TIME_S, 0.0, None)
# a loop of natural frequency 3 rad/s and damping 0.5 settles to 5 % in 2 s
STEP = 1.0 - np.exp(-1.5 * AFTER) * (np.cos(2.6 * AFTER) + 0.58 * np.sin(2.6 * AFTER))
RINGING = np.exp(-1.5 * AFTER) * np.sin(5.0 * AFTER) * (TIME_S > 0.0)


def noise(rng, rows):
    """As in a governed line: most of it in a band about the closed loop's resonance, lasting all the time."""
    white = rng.standard_normal((rows, SAMPLES + 400))
    coloured = sosfiltfilt(RESONANCE, white, axis=-1) + 0.1 * sosfiltfilt(LOW_PASS, white, axis=-1)
    return coloured[:, 200:-200]


@pytest.mark.parametrize("reach", [EVERYWHERE, SETTLING, SWEPT])
def test_reach_is_an_orthogonal_projection_without_mean(reach):
    a, b = np.random.default_rng(1).standard_normal((2, SAMPLES))
    assert reach.of(reach.of(a)) == pytest.approx(reach.of(a), abs=1e-12)
    assert a @ reach.of(b) == pytest.approx(reach.of(a) @ b, abs=1e-9)
    assert reach.of(a).mean() == pytest.approx(0.0, abs=1e-12)


def test_reach_holds_what_follows_a_step_and_what_a_sweep_excites():
    levels = np.where(TIME_S < 0.0, 0.3, 0.1)
    late = np.where((TIME_S >= 0.0) & (TIME_S < 4.0), RINGING, 0.0)
    assert SETTLING.of(levels + late) == pytest.approx(EVERYWHERE.of(levels + late), abs=1e-12)
    # whole numbers of periods: 1.5 Hz at the beginning of a sweep, twice that, and a mean that moves once in 14 s
    for hertz in (1.5, 3.0, 1.0 / 14.0):
        sine = np.sin(2.0 * np.pi * hertz * TIME_S)
        assert SWEPT.of(sine) == pytest.approx(sine, abs=1e-9)
    assert np.abs(SWEPT.of(np.sin(2.0 * np.pi * 1.0 * TIME_S))).max() < 1e-9


@pytest.mark.parametrize("reach", [EVERYWHERE, SETTLING, SWEPT])
def test_trace_is_half_the_variance_of_the_energy(reach):
    rng = np.random.default_rng(2)
    pieces = reach.of(noise(rng, 4000))
    variance = np.var(np.sum(pieces**2, axis=1))
    autocovariance = noise_pieces(noise(rng, 400)).autocovariances[0]
    trace = reach.trace_of_square(reach.of(noise(rng, 2000)), autocovariance, SAMPLES)
    # 4000 draws know a variance to 3 %; the autocovariance lacks what the mean took off
    assert 2.0 * trace == pytest.approx(variance, rel=0.1)


def noise_pieces(cut):
    cut = cut - cut.mean(axis=1, keepdims=True)
    return NoisePieces(pieces=np.stack([cut, cut], axis=1), as_long=True)


def judged(rng, reach, *, error=0.0, shape=RINGING, pieces=24, scale=1.0):
    drawn = scale * noise(rng, pieces + 1)
    one = Compared(
        output="n",
        place=0,
        measured=STEP + error * shape + drawn[0],
        model=STEP,
        slopes=np.zeros((0, SAMPLES)),
        noise=noise_pieces(drawn[1:]),
        reach=reach,
    )
    raw = Unfiltered(measured=one.measured, model=one.model, noise_variance=1.0)
    return misfit_of(raw, one, np.zeros((0, 0)), largest_error=0.15, coverage=0.95)


@pytest.mark.slow
@pytest.mark.parametrize("reach", [SETTLING, SWEPT])
@pytest.mark.parametrize("pieces", [3, 24])
def test_p_values_of_the_true_model_are_even(reach, pieces):
    rng = np.random.default_rng(3)
    p = np.array([judged(rng, reach, pieces=pieces).p_value for _ in range(400)])
    # binomial: 5 % +- 1.1 %, 50 % +- 2.5 %; the scaled chi-square and few pieces may cost as much again
    assert np.mean(p < 0.05) == pytest.approx(0.05, abs=0.045)
    assert np.mean(p < 0.5) == pytest.approx(0.5, abs=0.1)


@pytest.mark.slow
@pytest.mark.parametrize("error", [0.5, 1.5])
def test_intervals_of_the_error_hold_it(error):
    rng = np.random.default_rng(4)
    share = error * np.std(RINGING) / np.std(STEP + error * RINGING)
    held = []
    for _ in range(300):
        low, high = judged(rng, SETTLING, error=error, scale=0.3).error_interval
        held.append(low <= share <= high)
    assert np.mean(held) == pytest.approx(0.95, abs=0.04)


@pytest.mark.slow
def test_noise_that_lasts_hides_less_of_what_is_over_soon():
    found = {}
    for name, reach in (("everywhere", EVERYWHERE), ("settling", SETTLING)):
        rng = np.random.default_rng(5)
        true = [judged(rng, reach, scale=0.55).outcome for _ in range(60)]
        # 29 % of the motion are missed, 15 % are allowed
        wrong = [judged(rng, reach, error=1.0, scale=0.55).outcome for _ in range(60)]
        found[name] = true.count("passes"), true.count("fails"), wrong.count("fails"), wrong.count("passes")
    assert found["settling"][0] > found["everywhere"][0] + 30
    assert found["settling"][2] > found["everywhere"][2] + 5
    for _, true_fails, _, wrong_passes in found.values():
        assert true_fails + wrong_passes <= 1


def test_settling_is_twice_that_of_the_model():
    reach = while_settling(STEP, TIME_S, settled_share=0.05, highest_hz=4.0)
    # natural frequency 3 rad/s, damping 0.5: within 5 % from 1.76 s on (5.28 over the natural frequency)
    assert reach == WhileSettling(first=100, stop=reach.stop, stride=3)
    assert TIME_S[reach.stop] == pytest.approx(2.0 * 5.28 / 3.0, abs=0.05)


def test_a_model_that_does_not_settle_is_judged_everywhere():
    assert while_settling(np.sin(3.0 * TIME_S) + TIME_S, TIME_S, settled_share=0.05, highest_hz=4.0) is EVERYWHERE
