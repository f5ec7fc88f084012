"""The colour of the torque's noise, found together with the governor: the one-step prediction error.

Noise of the engine moves the speed, and the governor answers. A noise model that is estimated first, from what a wrong
governor leaves, blames the governor for it. So the autoregression takes its best values for every governor (variable
projection: Golub and Pereyra, The differentiation of pseudo-inverses and nonlinear least squares problems whose
variables separate, 1973; without the small term of Kaufman, 1975): the prediction-error method for a closed loop
(Ljung, System Identification, second edition, section 13.4).
"""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray

# Coefficients: 1.6 s of memory at 12.5 Hz.
ORDER = 20
RIDGE = 1e-10


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Innovations:
    """A residual without its colour."""

    values: FloatArray
    """What its past does not predict, 0 where a gap is near, shape (samples - order,)."""
    taps: FloatArray
    """The whitening filter, newest sample first, shape (order + 1,)."""
    lags: FloatArray
    """The residual's past, shape (samples - order, order)."""
    inverse: FloatArray
    """Inverse of ``lags' lags``, shape (order, order)."""
    kept: BoolArray
    """Where no gap is near, shape (samples - order,)."""

    @property
    def count(self) -> int:
        """Number of samples that count."""
        return int(np.count_nonzero(self.kept))

    @property
    def squares(self) -> float:
        """Sum of squares."""
        return float(self.values @ self.values)

    def filtered(self, rows: FloatArray) -> FloatArray:
        """Return changes of the residual, shape (rows, samples), as changes at the best colour, (rows, innovations)."""
        white = np.stack([np.convolve(row, self.taps, "valid") for row in rows]) * self.kept
        return np.asarray(white - ((white @ self.lags) @ self.inverse) @ self.lags.T)


def without_gaps(used: BoolArray) -> BoolArray:
    """Return which samples are used with all of the past that predicts them, shape (samples - order,)."""
    return np.asarray(np.lib.stride_tricks.sliding_window_view(used, ORDER + 1).all(axis=1), dtype=np.bool_)


def innovations(residual: FloatArray, used: BoolArray) -> Innovations:
    """Fit the colour of a residual, shape (samples,), and take it away."""
    windows = np.lib.stride_tricks.sliding_window_view(residual, ORDER + 1)
    kept = without_gaps(used)
    past = np.ascontiguousarray(windows[:, :ORDER][:, ::-1]) * kept[:, None]
    now = windows[:, ORDER] * kept
    gram = past.T @ past
    gram[np.diag_indices(ORDER)] *= 1.0 + RIDGE
    inverse = np.linalg.inv(gram)
    coefficients = inverse @ (past.T @ now)
    return Innovations(
        values=now - past @ coefficients,
        taps=np.concatenate([[1.0], -coefficients]),
        lags=past,
        inverse=np.asarray(inverse),
        kept=kept,
    )
