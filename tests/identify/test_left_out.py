"""How well lines are predicted that were left out of the fit: as well as the covariances say."""

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.errors import IdentificationError
from shaftprint.identify import Settings, Unweighted, identify
from shaftprint.identify.comparison._hold_out import hold_out

SETTINGS = Settings(starts=6, stability="ignored")


def repeated(make_response, truth, wanted, *, count=25, noise=0.03, settings=SETTINGS, folds=5):
    found = []
    for seed in range(count):
        rng = np.random.default_rng(seed)
        response = make_response(truth, noise=noise, correlation=0.3, rng=rng)
        fit = identify(structure(wanted), response, rng=rng, settings=settings)
        found.append(hold_out(fit, folds=folds, rng=rng))
    return np.array([f.square for f in found]), np.array([f.expected for f in found])


@pytest.mark.slow
@pytest.mark.parametrize("name", ["OL2", "CL1"])
@pytest.mark.parametrize(
    "weighting",
    [
        pytest.param(Settings().weighting, id="covariance"),
        pytest.param(Unweighted(), id="unweighted", marks=pytest.mark.long),
    ],
)
def test_the_true_structure_predicts_as_well_as_is_expected(make_response, name, weighting):
    """Over 25 tests, to three standard deviations of the mean; expected is noise and the fit's own uncertainty."""
    settings = Settings(starts=6, stability="ignored", weighting=weighting)
    square, expected = repeated(make_response, name, name, settings=settings, noise=0.01)
    gap = square - expected
    assert abs(gap.mean()) < 3.0 * gap.std(ddof=1) / np.sqrt(gap.size)
    assert np.all(expected > 1.0)


def test_one_unknown_number_written_out(make_response):
    """``K / s`` at every line with one relative noise: to predict a line from ``N - 1`` costs ``1 / (N - 1)``."""
    own = structure("OL2").held_at(K_p=0.0)
    response = make_response(own, {"K_i": 4.0, "K_p": 0.0}, noise=0.02, rng=np.random.default_rng(1))
    fit = identify(own, response, rng=np.random.default_rng(1))
    found = hold_out(fit, folds=13, rng=np.random.default_rng(1))
    # of the two parts of a line only the imaginary one is predicted with an error
    assert found.expected == pytest.approx((1.0 + 1.0 + 1.0 / 12.0) / 2.0, rel=1e-6)
    assert found.folds == 13


def test_a_wrong_structure_predicts_badly(make_response):
    right, _ = repeated(make_response, "OL5", "OL5", count=3)
    wrong, expected = repeated(make_response, "OL5", "OL2", count=3)
    assert np.all(wrong > 5.0 * right)
    assert np.all(wrong > 5.0 * expected)


def test_more_folds_than_lines_leave_out_one_line_each(make_response):
    fit = identify(structure("OL2"), make_response("OL2"), rng=np.random.default_rng(1))
    assert hold_out(fit, folds=99, rng=np.random.default_rng(1)).folds == 13


def test_the_folds_are_the_same_each_time(make_response):
    fit = identify(structure("OL2"), make_response("OL2", rng=np.random.default_rng(1)), rng=np.random.default_rng(1))
    one, two = (hold_out(fit, folds=5, rng=np.random.default_rng(seed)) for seed in (1, 2))
    assert one.square == pytest.approx(two.square, rel=1e-6)


def test_what_cannot_be_predicted_is_refused(make_response):
    fit = identify(structure("OL2"), make_response("OL2"), rng=np.random.default_rng(1))
    with pytest.raises(IdentificationError, match=r"folds: expected 2 or more, found 1"):
        hold_out(fit, folds=1, rng=np.random.default_rng(1))
    few = identify(structure("OL5"), make_response("OL5"), rng=np.random.default_rng(1), lines=["S8", "S9", "S10"])
    with pytest.raises(IdentificationError, match=r"structure OL5 without S\d+: .* measure more lines"):
        hold_out(few, folds=3, rng=np.random.default_rng(1))
