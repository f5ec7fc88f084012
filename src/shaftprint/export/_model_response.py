"""The response of a model on a grid of frequencies, with its covariance from that of the parameters."""

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from shaftprint.arrays import ComplexArray, FloatArray, frozen_complex, frozen_float
from shaftprint.errors import ExportError
from shaftprint.export._model import ExportedModel

LOWEST_RAD_S: Final = 0.05
HIGHEST_RAD_S: Final = 50.0
POINTS: Final = 241
DECIBEL: Final = 20.0 / np.log(10.0)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ModelResponse:
    """Deviation of every output over that of every input, both over the working point."""

    inputs: tuple[str, ...]
    """Names of the inputs."""
    outputs: tuple[str, ...]
    """Names of the outputs."""
    omega_rad_s: FloatArray
    """Angular frequency [rad/s], shape (frequencies,)."""
    response: ComplexArray
    """Shape (outputs, inputs, frequencies)."""
    covariance: FloatArray
    """Covariance of [Re, Im], each over outputs times inputs with inputs fastest, to first order in the parameters;
    shape (frequencies, 2 outputs inputs, 2 outputs inputs). Zero where no uncertainty is known."""

    @property
    def magnitude_db(self) -> FloatArray:
        """``20 log10 |H|`` [dB], minus infinite where an input moves nothing, shape (outputs, inputs, frequencies)."""
        with np.errstate(divide="ignore"):
            return np.asarray(20.0 * np.log10(np.abs(self.response)))

    @property
    def phase_deg(self) -> FloatArray:
        """Unwrapped phase [deg], shape (outputs, inputs, frequencies)."""
        return np.asarray(np.degrees(np.unwrap(np.angle(self.response), axis=-1)))

    @property
    def magnitude_std_db(self) -> FloatArray:
        """Standard deviation of the magnitude [dB], shape (outputs, inputs, frequencies)."""
        return np.asarray(DECIBEL * np.sqrt(self._along(self.response.real, self.response.imag)))

    @property
    def phase_std_deg(self) -> FloatArray:
        """Standard deviation of the phase [deg], shape (outputs, inputs, frequencies)."""
        return np.asarray(np.degrees(np.sqrt(self._along(-self.response.imag, self.response.real))))

    @property
    def channel_covariance(self) -> FloatArray:
        """Covariance of the real and imaginary part of each channel, shape (outputs, inputs, frequencies, 2, 2)."""
        return channel_covariance(self.covariance, self.response.shape[0])

    def _along(self, real: FloatArray, imaginary: FloatArray) -> FloatArray:
        """Return the variance along a direction of each response, over the fourth power of its size; 0 without one."""
        direction = np.stack([real, imaginary], axis=-1)
        variance = np.einsum("...i,...ij,...j->...", direction, self.channel_covariance, direction)
        size = np.abs(self.response) ** 4
        over: FloatArray = np.divide(np.maximum(variance, 0.0), size, out=np.zeros_like(size), where=size > 0.0)
        return over


def channel_covariance(covariance: FloatArray, outputs: int) -> FloatArray:
    """Return the covariance of the real and imaginary part of each channel of a response.

    ``covariance``: covariance of [Re, Im] of all channels, shape (frequencies, 2 channels, 2 channels). ``outputs``:
    number of outputs, which are slower than the inputs. Returns shape (outputs, inputs, frequencies, 2, 2).
    """
    count, channels = covariance.shape[0], covariance.shape[1] // 2
    parts = covariance.reshape(count, 2, channels, 2, channels)
    return np.asarray(np.einsum("fickc->cfik", parts).reshape(outputs, -1, count, 2, 2))


def usual_frequencies() -> FloatArray:
    """Return the frequencies at which responses are given when none are asked for [rad/s]."""
    return np.geomspace(LOWEST_RAD_S, HIGHEST_RAD_S, POINTS)


def model_response(model: ExportedModel, omega_rad_s: ArrayLike | None = None) -> ModelResponse:
    """Return the response of a model with its covariance.

    ``omega_rad_s``: frequencies [rad/s], shape (frequencies,); 0.05 to 50 rad/s if not given. Raises ExportError if the
    frequencies are not positive, ascending and finite.
    """
    omega = np.atleast_1d(np.asarray(usual_frequencies() if omega_rad_s is None else omega_rad_s, dtype=np.float64))
    if not (np.all(np.isfinite(omega)) and np.all(omega > 0.0) and np.all(np.diff(omega) > 0.0)):
        raise ExportError("export: expected positive, ascending frequencies in rad/s.")
    structure = model.structure
    response, slopes = structure.gradient(model.values, 1j * omega, model.uncertain)
    moved = np.concatenate([slopes.real, slopes.imag], axis=-2)
    covariance = np.einsum("pcf,pq,qdf->fcd", moved, model.covariance_matrix, moved)
    return ModelResponse(
        inputs=structure.inputs,
        outputs=tuple(structure.outputs),
        omega_rad_s=frozen_float(omega),
        response=frozen_complex(response.reshape(len(structure.outputs), len(structure.inputs), omega.size)),
        covariance=frozen_float(covariance),
    )
