"""What an estimate from few samples makes of a covariance."""

import numpy as np

from shaftprint.arrays import FloatArray


def estimated_shapes(freedom: FloatArray, channels: int, count: int, rng: np.random.Generator) -> FloatArray:
    """Return what an estimate makes of a unit covariance, shape (repeats, lines, 2 channels, 2 channels).

    Covariances of complex samples follow a complex Wishart distribution, here by its Bartlett decomposition (Goodman,
    Statistical analysis based on a certain multivariate complex Gaussian distribution, 1963); a known one stays 1.
    """
    exact = np.isinf(freedom)
    samples = np.where(exact, np.inf, np.maximum(0.5 * freedom, channels))
    triangle = np.zeros((count, freedom.size, channels, channels), dtype=np.complex128)
    safe = np.where(exact, channels, samples)
    for i in range(channels):
        triangle[:, :, i, i] = np.sqrt(rng.gamma(safe - i, size=(count, freedom.size)))
        real, imaginary = rng.standard_normal((2, count, freedom.size, i)) * np.sqrt(0.5)
        triangle[:, :, i, :i] = real + 1j * imaginary
    wishart = triangle @ triangle.conj().swapaxes(2, 3) / safe[:, None, None]
    shape = np.block([[wishart.real, -wishart.imag], [wishart.imag, wishart.real]])
    shape[:, exact] = np.eye(2 * channels)
    return np.asarray(shape)
