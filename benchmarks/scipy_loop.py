"""The peer of rows 1 and 5: what an engineer writes around ``scipy.optimize.least_squares``.

Closed forms by hand, vectorised over the lines, constants taken out of the residual function; method ``trf`` with
bounds, everything else at SciPy's defaults (two-point finite differences, tolerances 1e-8), a loop over the starts.
"""

from collections.abc import Callable, Mapping

import numpy as np
from scipy.optimize import OptimizeResult, least_squares

from shaftprint.arrays import ComplexArray, FloatArray

ClosedForm = Callable[[FloatArray, ComplexArray], ComplexArray]


def _ol1(p: FloatArray, s: ComplexArray) -> ComplexArray:
    return 1.0 / (p[0] * s + 2.0)


def _ol2(p: FloatArray, s: ComplexArray) -> ComplexArray:
    return p[0] + p[1] / s


def _ol3(p: FloatArray, s: ComplexArray) -> ComplexArray:
    return (p[0] + p[1] / s) * np.exp(-s * p[2])


def _ol4(p: FloatArray, s: ComplexArray) -> ComplexArray:
    return (p[0] + p[1] / s) * p[2] ** 2 / (s * s + 2.0 * p[3] * p[2] * s + p[2] ** 2)


def _ol5(p: FloatArray, s: ComplexArray) -> ComplexArray:
    return (p[0] + p[1] / s) * np.exp(-s * p[2]) * p[3] ** 2 / (s * s + 2.0 * p[4] * p[3] * s + p[3] ** 2)


def _closed(engine: ComplexArray, tau: np.float64, s: ComplexArray) -> ComplexArray:
    """Return ``n / n_set`` and ``M_s / n_set`` one after the other."""
    core = 1.0 / (tau * s + 2.0)
    torque = engine / (1.0 + engine * core)
    return np.concatenate([core * torque, torque])


def _cl1(p: FloatArray, s: ComplexArray) -> ComplexArray:
    return _closed(_ol2(p[1:], s), p[0], s)


def _cl3(p: FloatArray, s: ComplexArray) -> ComplexArray:
    return _closed(_ol4(p[1:], s), p[0], s)


def _cl4(p: FloatArray, s: ComplexArray) -> ComplexArray:
    return _closed(_ol5(p[1:], s), p[0], s)


# Parameters in the order in which the closed forms take them.
CLOSED_FORMS: Mapping[str, tuple[ClosedForm, tuple[str, ...]]] = {
    "OL1": (_ol1, ("tau_n",)),
    "OL2": (_ol2, ("K_p", "K_i")),
    "OL3": (_ol3, ("K_p", "K_i", "t_d")),
    "OL4": (_ol4, ("K_p", "K_i", "omega_n", "zeta")),
    "OL5": (_ol5, ("K_p", "K_i", "t_d", "omega_n", "zeta")),
    "CL1": (_cl1, ("tau_n", "K_p", "K_i")),
    "CL3": (_cl3, ("tau_n", "K_p", "K_i", "omega_n", "zeta")),
    "CL4": (_cl4, ("tau_n", "K_p", "K_i", "t_d", "omega_n", "zeta")),
}


def fit(
    name: str,
    omega_rad_s: FloatArray,
    response: ComplexArray,
    std: FloatArray,
    start: FloatArray,
    lower: FloatArray,
    upper: FloatArray,
    *,
    max_nfev: int = 100,
) -> OptimizeResult:
    """Fit one closed form from one start.

    Parameters
    ----------
    response, std
        Data and standard deviation of its real and of its imaginary part, one output after the other, shape
        (outputs * lines,).
    start, lower, upper
        In the order of ``CLOSED_FORMS``.
    """
    form, _ = CLOSED_FORMS[name]
    s, weight = 1j * omega_rad_s, 1.0 / std

    def residual(p: FloatArray) -> FloatArray:
        missed = (response - form(p, s)) * weight
        return np.concatenate([missed.real, missed.imag])

    return least_squares(residual, start, bounds=(lower, upper), method="trf", max_nfev=max_nfev)


def best_of(
    name: str,
    omega_rad_s: FloatArray,
    response: ComplexArray,
    std: FloatArray,
    starts: FloatArray,
    lower: FloatArray,
    upper: FloatArray,
) -> OptimizeResult:
    """Fit one closed form from every start and return the fit of lowest cost."""
    fits = [fit(name, omega_rad_s, response, std, start, lower, upper) for start in starts]
    return min(fits, key=lambda found: found.cost)
