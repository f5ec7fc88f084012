"""Whether the stated p-values, intervals and ceilings are right, over many records with known truth."""

import numpy as np
import pytest
from scipy.signal import lfilter

from shaftprint.validation.measures._misfit import Compared, Unfiltered, misfit_of
from shaftprint.validation.measures._noise_pieces import NoisePieces, autocorrelated

SAMPLES = 400
TIME = np.arange(SAMPLES) / 20.0
MOTION = np.sin(0.9 * TIME) + 0.6 * np.sin(2.3 * TIME + 1.0)
WRONG = np.cos(1.7 * TIME)
WRONG -= WRONG.mean()
NO_PARAMETER = np.zeros((0, SAMPLES))


def coloured(rng, rows, std=0.2):
    """First-order noise: correlated over about half a second."""
    white = rng.standard_normal((rows, SAMPLES + 200))
    noise = lfilter([1.0], [1.0, -0.9], white)[:, 200:]
    return std * np.sqrt(1.0 - 0.81) * noise


def compared(rng, *, error=0.0, pieces=24, std=0.2, slopes=NO_PARAMETER, shift=0.0):
    noise = coloured(rng, pieces + 1, std)
    cut = noise[1:] - noise[1:].mean(axis=1, keepdims=True)
    return Compared(
        output="n",
        place=0,
        measured=MOTION + error * WRONG + noise[0] + 0.3,
        model=MOTION + shift,
        slopes=slopes,
        noise=NoisePieces(pieces=np.stack([cut, cut], axis=1), as_long=True),
    )


def judged(one, covariance=None, largest_error=0.15):
    covariance = np.zeros((one.slopes.shape[0],) * 2) if covariance is None else covariance
    unfiltered = Unfiltered(
        measured=one.measured, model=one.model, noise_variance=float(np.mean(one.noise.pieces[:, one.place] ** 2))
    )
    return misfit_of(unfiltered, one, covariance, largest_error=largest_error, coverage=0.95)


@pytest.mark.parametrize("pieces", [4, 24])
def test_p_values_of_the_true_model_are_even(pieces):
    rng = np.random.default_rng(1)
    p = np.array([judged(compared(rng, pieces=pieces)).p_value for _ in range(400)])
    # binomial: 5 % +- 1.1 %, 50 % +- 2.5 %; the scaled chi-square and few pieces may cost as much again
    assert np.mean(p < 0.05) == pytest.approx(0.05, abs=0.045)
    assert np.mean(p < 0.5) == pytest.approx(0.5, abs=0.1)


@pytest.mark.parametrize("error", [0.2, 0.4])
def test_intervals_of_the_error_hold_it(error):
    rng = np.random.default_rng(2)
    held, found = [], []
    for _ in range(300):
        one = judged(compared(rng, error=error))
        # of the motion that was measured, without its noise: the definition divides by what is seen
        share = error * np.std(WRONG) / np.std(compared(rng, error=error).measured)
        held.append(one.error_interval[0] <= share <= one.error_interval[1])
        found.append(one.error / share)
    assert np.mean(held) == pytest.approx(0.95, abs=0.04)
    assert np.mean(found) == pytest.approx(1.0, abs=0.05)


def test_a_true_model_never_fails_and_a_wrong_one_does():
    rng = np.random.default_rng(3)
    true = [judged(compared(rng)).outcome for _ in range(200)]
    wrong = [judged(compared(rng, error=0.6)).outcome for _ in range(200)]
    assert true.count("fails") == 0
    assert wrong.count("fails") > 190
    assert wrong.count("passes") == 0


def test_noise_that_hides_everything_leaves_it_undecided():
    rng = np.random.default_rng(4)
    found = [judged(compared(rng, std=2.0)).outcome for _ in range(50)]
    assert found.count("fails") == 0
    assert found.count("undecided") > 40


def test_what_the_parameters_may_be_off_is_no_error():
    # a parameter known to 0.3 that moves the model along the motion, off by one standard deviation
    rng = np.random.default_rng(5)
    slopes = MOTION[None]
    p, errors = [], []
    for _ in range(300):
        one = compared(rng, std=0.05, slopes=slopes)
        off = 0.3 * rng.standard_normal()
        moved = Compared(
            output=one.output,
            place=one.place,
            measured=one.measured + off * MOTION,
            model=one.model,
            slopes=slopes,
            noise=one.noise,
        )
        found = judged(moved, np.array([[0.09]]))
        p.append(found.p_value)
        errors.append(found.outcome == "fails")
    # one parameter has one degree of freedom, of which a chi-square is exact
    assert np.mean(np.array(p) < 0.05) == pytest.approx(0.05, abs=0.04)
    assert np.mean(errors) < 0.06


def test_an_offset_of_the_model_does_not_count():
    one = compared(np.random.default_rng(6), shift=-0.5)
    other = compared(np.random.default_rng(6))
    assert judged(one).error == pytest.approx(judged(other).error)
    assert judged(one).fit_percent < judged(other).fit_percent


def test_the_true_model_reaches_the_ceiling_on_average():
    rng = np.random.default_rng(7)
    gap = []
    for _ in range(200):
        one = compared(rng)
        centred = Compared(
            output="n",
            place=0,
            measured=one.measured - 0.3,
            model=one.model,
            slopes=one.slopes,
            noise=one.noise,
        )
        found = judged(centred)
        gap.append(found.fit_ceiling - found.fit_percent)
    # noise of 0.2 on a motion of 0.82: 76 %; the mean taken off the pieces hides a twentieth of the variance
    assert np.mean(gap) == pytest.approx(0.0, abs=1.0)


def test_fit_percent_of_equation_2_41():
    one = compared(np.random.default_rng(8), std=1e-9)
    residual = one.measured - one.model
    expected = 100.0 * (1.0 - np.linalg.norm(residual) / np.linalg.norm(one.measured - one.measured.mean()))
    assert judged(one).fit_percent == pytest.approx(expected)


def test_without_noise_an_exact_model_passes_and_any_error_is_sure():
    silent = NoisePieces(pieces=np.zeros((3, 2, SAMPLES)), as_long=True)
    for error, outcome, p_value in ((0.0, "passes", 1.0), (0.5, "fails", 0.0)):
        one = Compared(
            output="n",
            place=0,
            measured=MOTION + error * WRONG,
            model=MOTION,
            slopes=NO_PARAMETER,
            noise=silent,
        )
        found = judged(one)
        assert (found.outcome, found.p_value) == (outcome, p_value)
        assert found.fit_ceiling == pytest.approx(100.0)


def test_sums_of_products_at_lags_are_those_of_the_definition():
    rng = np.random.default_rng(4)
    pieces = rng.standard_normal((3, 57))
    lagged = [sum(piece[: 57 - lag] @ piece[lag:] for piece in pieces) for lag in range(57)]
    assert autocorrelated(*pieces) == pytest.approx(np.array(lagged), abs=1e-12)
