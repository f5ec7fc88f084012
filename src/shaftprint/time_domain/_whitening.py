"""From coloured noise to independent residuals of unit variance, started anew after each gap.

Within a stretch sample ``t`` becomes ``S^-1/2 (e_t - A_1 e_{t-1} - ... - A_p e_{t-p})``; the first ``p`` samples, whose
past is not known, are multiplied by the inverse Cholesky factor of their exact covariance. So nothing is lost at a gap,
and the sum of squares is twice the negative log-likelihood of the stretch, up to a constant of the noise.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.kernels._compiled import compiled
from shaftprint.time_domain._noise_model import NoiseModel


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Whitening:
    """A filter that makes noise of one model white."""

    noise: NoiseModel
    """The noise."""
    _start: FloatArray = field(init=False, repr=False)
    """Inverse Cholesky factor of the start-up covariance, shape (order outputs, order outputs)."""
    _rows: FloatArray = field(init=False, repr=False)
    """Weights of the samples ``t - p`` to ``t``, the earliest first, shape (outputs, (order + 1) outputs)."""

    def __post_init__(self) -> None:
        """Prepare the filter."""
        order, outputs = self.noise.order, self.noise.outputs
        root = np.linalg.inv(np.linalg.cholesky(self.noise.covariance))
        past = -self.noise.coefficients[::-1].swapaxes(0, 1).reshape(outputs, order * outputs)
        object.__setattr__(self, "_rows", np.ascontiguousarray(root @ np.concatenate([past, np.eye(outputs)], axis=1)))
        start = np.linalg.inv(np.linalg.cholesky(self.noise.start_up)) if order else np.zeros((0, 0))
        object.__setattr__(self, "_start", start)

    def whitened(self, values: FloatArray, stretches: Sequence[slice]) -> FloatArray:
        """Return the filtered stretches one after the other.

        ``values``: shape (rows, samples, outputs). ``stretches``: where they count, in order of time. Returns shape
        (rows, counted samples, outputs).
        """
        order, outputs = self.noise.order, self.noise.outputs
        whitened = []
        for stretch in stretches:
            part = np.ascontiguousarray(values[:, stretch])
            out = np.empty_like(part)
            begin = min(order, part.shape[1])
            size = begin * outputs
            start = part[:, :begin].reshape(part.shape[0], size) @ self._start[:size, :size].T
            out[:, :begin] = start.reshape(part.shape[0], begin, outputs)
            flat = part.shape[0], part.shape[1] * outputs
            predict(part.reshape(flat), self._rows, size, out.reshape(flat))
            whitened.append(out)
        return np.concatenate(whitened, axis=1)


@compiled(nogil=True, fastmath={"reassoc", "contract"})
def predict(flat, rows, begin: int, out) -> None:  # type: ignore[no-untyped-def]
    """Write the innovations from place ``begin`` on, outputs side by side."""
    outputs, length = rows.shape
    for k in range(flat.shape[0]):
        line = flat[k]
        for first in range(begin, line.size, outputs):
            window = line[first + outputs - length : first + outputs] if first + outputs >= length else line[:0]
            for i in range(outputs):
                total = 0.0
                weights = rows[i]
                for j in range(window.size):
                    total += weights[j] * window[j]
                out[k, first + i] = total
