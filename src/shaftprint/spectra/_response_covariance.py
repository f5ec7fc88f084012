"""From complex amplitudes with their noise to a response with the covariance of its real and imaginary parts."""

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray

# An amplitude is never taken as better known than this part of itself: noise-free data keep a covariance.
_ROUNDING = 1e-10
_LEAST_EXCESS = 0.5


def real_covariance(covariance: ComplexArray) -> FloatArray:
    """Return the covariance of [Re, Im] of circular complex noise.

    ``covariance``: ``E[z z^H]``, Hermitian, shape (..., n, n). Returns ``1/2 [[Re C, -Im C], [Im C, Re C]]``, shape
    (..., 2n, 2n).
    """
    upper = np.concatenate([covariance.real, -covariance.imag], axis=-1)
    lower = np.concatenate([covariance.imag, covariance.real], axis=-1)
    result: FloatArray = 0.5 * np.concatenate([upper, lower], axis=-2)
    return result


def real_jacobian(jacobian: ComplexArray) -> FloatArray:
    """Return the Jacobian of [Re, Im] that belongs to a complex derivative.

    ``jacobian``: derivatives of complex-differentiable values, shape (..., outputs, inputs). Returns ``[[Re J, -Im J],
    [Im J, Re J]]``, shape (..., 2 outputs, 2 inputs).
    """
    upper = np.concatenate([jacobian.real, -jacobian.imag], axis=-1)
    lower = np.concatenate([jacobian.imag, jacobian.real], axis=-1)
    result: FloatArray = np.concatenate([upper, lower], axis=-2)
    return result


def weight_factor(complex_samples: float, outputs: int) -> float:
    """Return the factor that makes an estimated covariance right as a weight.

    A covariance estimated from ``n`` complex samples follows a complex Wishart distribution, whose inverse is too
    large by ``n / (n - outputs)`` on average (Brillinger, "Time Series: Data Analysis and Theory", section 4.2):
    without the factor weighted residuals look larger than they are. Limited where ``n`` hardly exceeds ``outputs``.

    ``complex_samples``: number of complex samples behind the covariance. ``outputs``: number of complex values that are
    weighted together. Returns the factor, at least 1.
    """
    return complex_samples / max(complex_samples - outputs, _LEAST_EXCESS)


def weight_change(degrees_of_freedom: FloatArray, before: int, after: int) -> FloatArray:
    """Return the factor on covariances when another number of outputs is weighted together.

    ``degrees_of_freedom``: real degrees of freedom behind each covariance, infinite for known ones, shape (lines,).
    ``before``, ``after``: number of outputs that the covariance was made for and will be used for. Returns
    ``weight_factor`` of the one over that of the other, shape (lines,); 1 for known covariances.
    """
    samples = 0.5 * np.where(np.isfinite(degrees_of_freedom), degrees_of_freedom, 2.0)
    pairs = [weight_factor(float(n), after) / weight_factor(float(n), before) for n in samples]
    return np.where(np.isfinite(degrees_of_freedom), pairs, 1.0)


def products(outputs: ComplexArray, inputs: ComplexArray) -> ComplexArray:
    """Return the covariance of a response to several inputs, outputs times inputs in C order.

    ``outputs``: covariance of the noise at the outputs, shape (lines, outputs, outputs). ``inputs``: covariance of the
    response to each input for noise of variance 1, shape (lines, inputs, inputs). Returns the Kronecker product of each
    line, shape (lines, outputs inputs, outputs inputs).
    """
    lines, size = len(outputs), outputs.shape[1] * inputs.shape[1]
    result: ComplexArray = np.einsum("kop,kij->koipj", outputs, inputs).reshape(lines, size, size)
    return result


def rounding_floor(power: FloatArray) -> FloatArray:
    """Return what is added to the covariance of amplitudes, so that noise-free ones keep a covariance.

    ``power``: squared magnitudes of the amplitudes, shape (lines, channels). Returns diagonal matrices, shape (lines,
    channels, channels); at a line without any amplitude that of the strongest counts.
    """
    least = np.maximum(power, _ROUNDING * power.max(axis=0)) + np.finfo(np.float64).tiny
    floor: FloatArray = _ROUNDING**2 * least[:, :, np.newaxis] * np.eye(power.shape[1])
    return floor


def response_of_line(
    amplitude: ComplexArray,
    noise: ComplexArray,
    *,
    complex_samples: float,
    weighted: int | None = None,
) -> tuple[ComplexArray, FloatArray]:
    """Return the response of one line with the covariance of [Re n, Re M_s, Im n, Im M_s] that noise gives it.

    The noise of all amplitudes is carried through ``H = [N, M] / U`` to first order, that of the input and its
    correlation with the outputs included.

    ``amplitude``: amplitudes ``U, N, M`` and further outputs over the working point, shape (1 + outputs,). ``noise``:
    covariance ``E[a a^H]`` of their noise, shape (1 + outputs, 1 + outputs). ``complex_samples``: number of complex
    samples behind it. ``weighted``: number of outputs that will be weighted together; those given here when not given.
    Returns the response, shape (outputs,), and its covariance, shape (2 outputs, 2 outputs).
    """
    response = amplitude[1:] / amplitude[0]
    jacobian = np.column_stack([-response, np.eye(response.size)]) / amplitude[0]
    floor = np.diag((_ROUNDING * np.abs(amplitude)) ** 2 + np.finfo(np.float64).tiny)
    spread = jacobian @ (noise * weight_factor(complex_samples, weighted or response.size) + floor) @ jacobian.conj().T
    return response, _symmetric(real_covariance(spread))


def with_common_error(covariance: FloatArray, direction: ComplexArray, standard_deviation: float) -> FloatArray:
    """Add a real random factor that moves all outputs of a line together.

    ``covariance``: covariance of [Re, Im], shape (2 outputs, 2 outputs). ``direction``: change of the response for a
    factor of 1, shape (outputs,). ``standard_deviation``: standard deviation of the factor. Returns the covariance with
    both.
    """
    real_direction = standard_deviation * np.concatenate([direction.real, direction.imag])
    return covariance + np.outer(real_direction, real_direction)


def _symmetric(matrix: FloatArray) -> FloatArray:
    return 0.5 * (matrix + matrix.T)
