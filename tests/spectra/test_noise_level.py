"""The level of the noise at a line, where its slope was fitted to the same bins."""

import numpy as np
import pytest

from shaftprint.spectra.lines._noise import Neighbours, noise_from_neighbours

REPEATS = 1500


@pytest.mark.parametrize(("count", "half_width"), [(8, 0.1), (12, 0.3), (36, 1.0)])
def test_a_fitted_slope_takes_nothing_of_the_level(count, half_width):
    """Noise whose density falls with frequency and is 1 at the line: so is the mean of what is stated."""
    log_ratio = np.linspace(-half_width, half_width, count)
    neighbours = Neighbours(bins=np.exp(log_ratio), log_ratio=log_ratio, weight=np.ones(count))
    rng = np.random.default_rng(3)
    white = rng.standard_normal((2, REPEATS, 1, count)) / np.sqrt(2.0)
    noise = (white[0] + 1j * white[1]) * np.exp(-0.5 * log_ratio)
    level = np.mean([noise_from_neighbours(one, neighbours).covariance[0, 0].real for one in noise])
    assert abs(level - 1.0) < 3.0 / np.sqrt(count * REPEATS)
