"""Noise of a leg that swells and fades with the load: the number of independent bins behind its covariance."""

import numpy as np

from shaftprint.spectra.lines._noise import Neighbours, noise_from_neighbours

REPEATS, PERIODS, LENGTH, SWING = 1000, 4, 512, 0.3
BINS = np.array([k for k in range(380, 430) if k % PERIODS])


def test_the_scatter_of_the_stated_level_is_that_of_the_stated_number_of_samples():
    """White noise times the square of a speed: drawn, so that its bins are related as such noise relates them."""
    phase = 2.0 * np.pi * np.arange(PERIODS * LENGTH) / LENGTH
    load = (1.0 + SWING * np.sqrt(2.0) * np.cos(phase)) ** 2
    power = np.abs(np.fft.rfft(load**2)) ** 2
    related = (power / power[0])[np.abs(BINS[:, np.newaxis] - BINS)]
    log_ratio = np.log(BINS / 404.0)
    neighbours = Neighbours(
        bins=BINS.astype(np.float64), log_ratio=log_ratio, weight=np.ones(BINS.size), related=related
    )
    rng = np.random.default_rng(4)
    noise = np.fft.rfft(load * rng.standard_normal((REPEATS, 1, load.size)))[:, :, BINS] / np.sqrt((load**2).sum())
    stated = [noise_from_neighbours(one, neighbours) for one in noise]
    level = np.array([one.covariance[0, 0].real for one in stated])
    samples = np.array([one.complex_samples for one in stated])
    assert abs(level.mean() - 1.0) < 0.02
    # the scatter of a variance from 1000 repeats is 4.5 %
    assert abs(level.var() * samples.mean() - 1.0) < 0.14
    assert samples.max() < 0.75 * BINS.size
