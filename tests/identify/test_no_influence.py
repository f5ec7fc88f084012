"""A parameter that the data do not see must not stop the fit of the others."""

import numpy as np

from shaftprint.arrays import FloatArray, IntArray
from shaftprint.identify.search import descend


def test_a_parameter_without_influence_stays_where_it_started_however_long_the_fit_takes() -> None:
    """The residual ``a^2`` is so flat at its zero that every step only halves ``a``: a fit without end."""

    def residuals(theta: FloatArray, starts: IntArray) -> tuple[FloatArray, FloatArray]:
        a = theta[:, :1]
        return a**2, np.stack([2.0 * a, np.zeros_like(a)], axis=1)

    start = np.array([[1.0, 0.25], [0.5, 0.75]])
    found = descend(residuals, start, np.zeros(2) - 1.0, np.ones(2), tolerance=1e-14, max_iterations=100)
    assert np.all(np.abs(found.theta[:, 0]) < 1e-6)
    assert found.theta[:, 1].tolist() == [0.25, 0.75]
