"""A parameter that the data do not see must not stop the fit of the others."""

import numpy as np
import pytest

from shaftprint.arrays import FloatArray, IntArray
from shaftprint.identify.search._levenberg_marquardt import descend


def test_a_parameter_without_influence_stays_where_it_started_however_long_the_fit_takes() -> None:
    """The residual ``a^2`` is so flat at its zero that every step only halves ``a``: a fit without end."""

    def residuals(theta: FloatArray, starts: IntArray) -> tuple[FloatArray, FloatArray]:
        a = theta[:, :1]
        return a**2, np.stack([2.0 * a, np.zeros_like(a)], axis=1)

    start = np.array([[1.0, 0.25], [0.5, 0.75]])
    found = descend(residuals, start, np.zeros(2) - 1.0, np.ones(2), tolerance=1e-14, max_iterations=100)
    assert np.all(np.abs(found.theta[:, 0]) < 1e-6)
    assert found.theta[:, 1].tolist() == [0.25, 0.75]


@pytest.mark.parametrize("seed", [11, 15, 55, 64, 67])
def test_parameters_whose_influence_differs_by_many_decades_are_all_fitted(seed: int) -> None:
    """Straight models with two pairs of parameters that do the same; a start far from the data has such derivatives."""
    rng = np.random.default_rng(seed)
    columns = rng.integers(-3, 4, size=(20, 8)).astype(float)
    columns[:, [4, 6]] = columns[:, [3, 5]]
    data = columns @ np.ones(8) + rng.normal(size=20)
    jacobian = columns * 2.0 ** np.array([0, 3, 7, 95, 95, 96, 96, 3])
    (lowest,) = np.linalg.lstsq(columns[:, [0, 1, 2, 3, 5, 7]], data, rcond=None)[1]

    def residuals(theta: FloatArray, starts: IntArray) -> tuple[FloatArray, FloatArray]:
        return theta @ jacobian.T - data, np.repeat(jacobian.T[None], starts.size, axis=0)

    box = np.full(8, 1e6)
    found = descend(residuals, np.zeros((1, 8)), -box, box, tolerance=1e-14, max_iterations=200)
    assert found.converged.all()
    assert 2.0 * found.cost[0] == pytest.approx(lowest, rel=1e-9)
