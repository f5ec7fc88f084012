"""Robust fits: what they cost without bad lines, and what they save with one."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.errors import IdentificationError
from shaftprint.identify import MaximumLikelihood, Settings, StudentT, identify, profile_intervals, refit
from shaftprint.identify.fit._covariance import estimate_covariance

REPEATS = 2000
TRUTHS = {
    "OL5": {"K_p": 4.36, "K_i": 4.2664, "t_d": 0.1023, "omega_n": 8.202, "zeta": 0.88},
    "CL4": {"tau_n": 0.39, "K_p": 1.8, "K_i": 4.3, "t_d": 0.12, "omega_n": 9.0, "zeta": 1.2},
}
ROBUST = Settings(weighting=StudentT(), starts=20)
PLAIN = Settings(weighting=MaximumLikelihood(), starts=20)


def rng():
    return np.random.default_rng(1)


def simulated(make_response, name, *, repeats=REPEATS, seed=7):
    """A response, and many others that differ in their noise, shape (repeats, outputs, lines)."""
    response = make_response(name, TRUTHS[name], noise=0.01, correlation=0.3)
    roots = np.linalg.cholesky(response.covariance)
    lines, size, _ = roots.shape
    noise = np.einsum("lab,rlb->ral", roots, np.random.default_rng(seed).standard_normal((repeats, lines, size)))
    channels = size // 2
    return response, response.response[:, 0] + noise[:, :channels] + 1j * noise[:, channels:]


def spoiled(response, measured, line, distance):
    """The same with one line moved by so many standard deviations of it."""
    size = response.covariance.shape[1]
    step = np.linalg.cholesky(response.covariance[line]) @ np.full(size, distance / size**0.5)
    moved = measured.copy()
    moved[..., line] += step[: size // 2] + 1j * step[size // 2 :]
    return moved


@pytest.fixture(params=TRUTHS)
def tests(make_response, request):
    """Truth, response, simulated tests, and both fits of the response."""
    response, measured = simulated(make_response, request.param)
    shipped = structure(request.param)
    fits = {s.weighting: identify(shipped, response, rng=rng(), settings=s) for s in (PLAIN, ROBUST)}
    return np.array([TRUTHS[request.param][p.name] for p in shipped.free]), response, measured, fits


def test_without_bad_lines_variances_are_at_most_a_tenth_above_the_least(tests):
    """Averaged over the parameters, each within what 2000 tests can tell."""
    truth, _, measured, fits = tests
    plain, robust = (
        refit(fits[w], measured, start=truth).values.var(axis=0) for w in (MaximumLikelihood(), StudentT())
    )
    assert np.mean(plain / robust) >= 0.9
    assert np.all(plain / robust >= 0.87)
    assert np.all(plain / robust < 1.01)


@pytest.mark.slow
@pytest.mark.parametrize("line", ["S3", "S8"])
def test_one_line_20_deviations_off_moves_only_the_plain_fit(tests, line):
    """In standard deviations of the plain fit without it, on average over noise; the last lines alone fix the lag."""
    truth, response, measured, fits = tests
    moved = spoiled(response, measured, response.lines.index(line), 20.0)
    std = np.sqrt(np.diag(fits[MaximumLikelihood()].covariance))
    shift = {}
    for weighting, fit in fits.items():
        before, after = (refit(fit, data, start=truth).values for data in (measured, moved))
        shift[weighting] = np.mean(np.abs(after - before), axis=0) / std
    assert np.all(shift[StudentT()] < 0.5)
    assert shift[MaximumLikelihood()].max() > (0.9 if line == "S3" else 2.5)


@pytest.mark.long
@pytest.mark.parametrize("bad", [None, "S8"])
def test_stated_deviations_and_profiles_cover_the_truth(tests, bad):
    """95 % of the tests, with a bad line and without: the average information, and rises of the cost below 3.84 / 2."""
    truth, response, measured, fits = tests
    fit = fits[StudentT()]
    if bad:
        measured = spoiled(response, measured, response.lines.index(bad), 20.0)
    found = refit(fit, measured, start=truth)
    std = np.sqrt(np.diag(estimate_covariance(fit.objective, truth, expected=True)))
    for i, parameter in enumerate(fit.objective.free_parameters):
        held = fit.structure.held_at(**{parameter.name: truth[i]})
        other = identify(held, response, rng=rng(), settings=ROBUST)
        rest = refit(other, measured, start=np.delete(truth, i))
        profiled = np.mean(2.0 * (rest.cost - found.cost) < 3.8415)
        assert 0.92 < profiled < 0.97, parameter.name
        inside = np.mean(np.abs(found.values[:, i] - truth[i]) < 1.96 * std[i])
        assert (0.85 if bad else 0.935) < inside < 0.97, parameter.name


def test_a_bad_line_is_named_and_counts_little_in_the_deviations(make_response):
    """20 deviations off: squared distance near 400, p-value near nothing; deviations near those without the line."""
    good, measured = simulated(make_response, "CL4", repeats=1)
    moved = spoiled(good, measured, good.lines.index("S8"), 20.0)
    response = replace(good, response=moved[0][:, None])
    found = identify(structure("CL4"), response, rng=rng(), settings=ROBUST)
    tests = {t.name: t for t in found.line_tests}
    assert tests["S8"].distance == pytest.approx(400.0, rel=0.25)
    assert tests["S8"].p_value < 1e-50
    assert all(t.p_value > 1e-4 for name, t in tests.items() if name != "S8")
    assert found.p_value < 1e-20
    others = [name for name in good.lines if name != "S8"]
    without = identify(structure("CL4"), response, rng=rng(), settings=ROBUST, lines=others)
    for one, other in zip(found.parameters, without.parameters, strict=True):
        assert one.std == pytest.approx(other.std, rel=0.03)
        assert one.value == pytest.approx(other.value, abs=0.3 * other.std)
    assert without.p_value > 1e-3
    assert set(profile_intervals(found)) == {p.name for p in found.parameters}


def test_a_robust_fit_of_a_good_response_is_nearly_the_plain_one(make_response):
    response = make_response("CL4", TRUTHS["CL4"], noise=0.01, correlation=0.3, rng=rng())
    plain, robust = (identify(structure("CL4"), response, rng=rng(), settings=s) for s in (PLAIN, ROBUST))
    assert robust.is_likelihood
    for one, other in zip(robust.parameters, plain.parameters, strict=True):
        assert one.value == pytest.approx(other.value, abs=0.8 * other.std)
        assert one.std == pytest.approx(other.std / 0.9066**0.5, rel=0.02)


@pytest.mark.parametrize("freedom", [0.0, -4.0, float("nan")])
def test_degrees_of_freedom_must_be_positive(freedom):
    with pytest.raises(IdentificationError, match="Student-t weighting: expected positive degrees of freedom, found"):
        StudentT(degrees_of_freedom=freedom)
