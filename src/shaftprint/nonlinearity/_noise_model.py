"""The colour of the torque's noise, found together with the governor, and what is left when it is taken away.

The residual is taken to be autoregressive. Engine noise moves the speed, the governor answers: least squares on a
residual of the wrong colour blames the governor for it. With the coefficients at their best for every governor
(variable projection: Golub and Pereyra, "The differentiation of pseudo-inverses and nonlinear least squares problems
whose variables separate", 1973; without the term that Kaufman, 1975, shows to be small) the governor is found without
that bias: the one-step prediction error of the closed loop (Ljung, "System Identification", chapter on closed loops).
"""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray

ORDER = 30
"""Coefficients of the noise: more than a second of memory at 25 Hz."""

_RIDGE = 1e-10


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Whitened:
    """A residual without its colour."""

    residual: FloatArray
    """Innovations, shape (values - order,)."""
    taps: FloatArray
    """The whitening filter, newest value first, shape (order + 1,)."""
    lags: FloatArray
    """The residual's past, shape (values - order, order)."""
    inverse: FloatArray
    """Inverse of ``lags' lags``, shape (order, order)."""

    @property
    def squares(self) -> float:
        """Sum of the squared innovations."""
        return float(self.residual @ self.residual)

    def filtered(self, columns: FloatArray) -> FloatArray:
        """Return changes of the residual, shape (values, columns), as changes of the innovations at the best colour."""
        whitened = np.stack([np.convolve(column, self.taps, "valid") for column in columns.T], axis=1)
        free: FloatArray = whitened - self.lags @ (self.inverse @ (self.lags.T @ whitened))
        return free


def whiten(residual: FloatArray) -> Whitened:
    """Fit the colour of a residual, shape (values,), and take it away."""
    windows = np.lib.stride_tricks.sliding_window_view(residual, ORDER + 1)
    past = np.ascontiguousarray(windows[:, :ORDER][:, ::-1])
    now = windows[:, ORDER]
    gram = past.T @ past
    gram[np.diag_indices(ORDER)] *= 1.0 + _RIDGE
    inverse: FloatArray = np.asarray(np.linalg.inv(gram), dtype=np.float64)
    coefficients = inverse @ (past.T @ now)
    return Whitened(
        residual=now - past @ coefficients,
        taps=np.concatenate([[1.0], -coefficients]),
        lags=past,
        inverse=inverse,
    )
