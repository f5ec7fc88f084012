"""Stated uncertainties against the scatter over 200 simulated tests of a structure; docs/monte-carlo.md has 1000."""

from dataclasses import dataclass

import numpy as np
import pytest
from scipy.stats import kstest

from shaftprint.catalogue import structure
from shaftprint.identify import Draw, Prior, Settings, identify, profile_intervals
from shaftprint.spectra import FrequencyResponse

pytestmark = pytest.mark.slow


TESTS = 200
FREQUENCY_HZ = np.geomspace(0.0044, 3.4, 13)
# Complex samples that a recording has behind the noise of a line.
SAMPLES = 12
GAUGE = {
    "K_p": 5.7,
    "K_i": 4.27,
    "t_d": 0.0703,
    "omega_n": 10.3,
    "zeta": 0.47,
    "tau_dn": 0.32,
    "tau_up": 1.016,
    "k_q": 2.0,
    "g": -0.1,
    "t_sp": 0.0518,
    "c_set": 1.0,
    "t_gauge": 0.0,
}
PROBLEMS = {
    # name: truth, relative noise, what is known beforehand, whether the covariance is estimated
    "OL5": ({"K_p": 1.8, "K_i": 4.3, "t_d": 0.12, "omega_n": 9.5, "zeta": 0.6}, 0.02, {}, False),
    "CL4": ({"tau_n": 0.39, "K_p": 1.8, "K_i": 4.3, "t_d": 0.12, "omega_n": 9.5, "zeta": 0.6}, 0.02, {}, False),
    "CL3": ({"tau_n": 0.39, "K_p": 1.8, "K_i": 4.3, "omega_n": 9.5, "zeta": 0.6}, 0.02, {}, True),
    "GAUGE-CLOSED": (GAUGE, 0.005, {"tau_up": 0.021, "g": 0.03, "t_gauge": 0.002}, False),
}


@dataclass(frozen=True)
class AtTruth(Draw):
    point: tuple[float, ...]

    def starts(self, lower, upper, count, rng):
        return np.array([self.point])


def cholesky_factors(exact, noise):
    """Roots of the covariances of circular noise in which all outputs share half of their variance."""
    outputs = exact.shape[0]
    shared = 0.5 * np.eye(outputs) + 0.5
    return np.linalg.cholesky(shared) * noise * np.abs(exact.T)[:, :, None]


def drawn(rng, root, count):
    """Circular noise, shape (lines, outputs, count)."""
    size = (*root.shape[:2], count)
    return root @ (rng.standard_normal(size) + 1j * rng.standard_normal(size)) / np.sqrt(2.0)


def in_parts(covariance):
    upper = np.concatenate([covariance.real, -covariance.imag], axis=-1)
    return 0.5 * np.concatenate([upper, np.concatenate([covariance.imag, covariance.real], axis=-1)], axis=-2)


def least_variances(shipped, truth, covariance, known):
    """Cramer-Rao bounds: the diagonal of the inverse Fisher information, with derivatives by differences."""
    free = [p.name for p in shipped.free]

    def parts(values):
        response = shipped.response(shipped.vector(values), 2j * np.pi * FREQUENCY_HZ)
        return np.concatenate([response.real, response.imag]).T

    slopes = [
        (parts({**truth, name: truth[name] + 1e-6}) - parts({**truth, name: truth[name] - 1e-6})) / 2e-6
        for name in free
    ]
    slopes = np.stack(slopes, axis=2)
    information = np.einsum("lpa,lpb->ab", slopes, np.linalg.solve(covariance, slopes))
    for name, std in known.items():
        information[free.index(name), free.index(name)] += std**-2.0
    return np.diag(np.linalg.inv(information))


def simulated_tests(shipped, truth, root, known, *, estimated, rng):
    """Give the fits of simulated tests; what is known beforehand is drawn about the truth, as a measurement is."""
    exact = shipped.response(shipped.vector(truth), 2j * np.pi * FREQUENCY_HZ)
    outputs = exact.shape[0]
    point = tuple(truth[p.name] for p in shipped.free)
    for _ in range(TESTS):
        covariance = in_parts(root @ root.conj().swapaxes(1, 2))
        if estimated:
            beside = drawn(rng, root, SAMPLES)
            covariance = in_parts(beside @ beside.conj().swapaxes(1, 2) / (SAMPLES - outputs))
        response = FrequencyResponse(
            frequency_hz=FREQUENCY_HZ,
            response=(exact + drawn(rng, root, 1)[:, :, 0].T)[:, None],
            covariance=covariance,
            inputs=(shipped.input,),
            outputs=tuple(shipped.outputs),
            degrees_of_freedom=np.full(FREQUENCY_HZ.size, 2.0 * SAMPLES if estimated else np.inf),
        )
        priors = {parameter: Prior(rng.normal(truth[parameter], std), std) for parameter, std in known.items()}
        settings = Settings(priors=priors, starts=1, draw=AtTruth(point), stability="ignored")
        yield identify(shipped, response, rng=rng, settings=settings)


@pytest.mark.parametrize(
    "name", ["OL5", *(pytest.param(name, marks=pytest.mark.long) for name in PROBLEMS if name != "OL5")]
)
def test_intervals_cover_the_truth_and_errors_are_as_large_as_they_must_be(name):
    truth, noise, known, estimated = PROBLEMS[name]
    shipped = structure(name)
    free = [p.name for p in shipped.free]
    root = cholesky_factors(shipped.response(shipped.vector(truth), 2j * np.pi * FREQUENCY_HZ), noise)
    rng = np.random.default_rng([4, len(name)])
    errors, inside, p_values = [], [], []
    for fit in simulated_tests(shipped, truth, root, known, estimated=estimated, rng=rng):
        intervals = profile_intervals(fit)
        errors.append([fit.value(parameter) - truth[parameter] for parameter in free])
        inside.append([intervals[p].lower <= truth[p] <= intervals[p].upper for p in free])
        p_values.append(fit.p_value)
    coverage = dict(zip(free, np.mean(inside, axis=0), strict=True))
    # 95 % of 200 is 190 +/- 3.1
    assert all(0.88 <= share <= 0.99 for share in coverage.values()), coverage
    least = least_variances(shipped, truth, in_parts(root @ root.conj().swapaxes(1, 2)), known)
    ratio = dict(zip(free, np.mean(np.square(errors), axis=0) / least, strict=True))
    # A variance from 200 draws is good to 10 %. Weights from 12 samples of two outputs cost a sixth of the information.
    assert all(0.65 < value < (1.7 if estimated else 1.4) for value in ratio.values()), ratio
    assert kstest(p_values, "uniform").pvalue > 0.01
