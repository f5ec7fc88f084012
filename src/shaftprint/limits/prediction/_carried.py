"""Derivatives that are carried along a descent: a simulation with them costs six to nine without.

Each step corrects them by what the innovations did beside what they had foretold, along the step alone (Broyden, A
class of methods for solving nonlinear simultaneous equations, 1965), parameters scaled by their influence. Those that
are found anew come of steps twice as long: innovations are as exact as before, and so is the cost; where it ends moves
by the error of the derivatives, a per cent, as a share of what the noise moves it by.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, fields, replace

import numpy as np

from shaftprint.arrays import FloatArray, IntArray
from shaftprint.identify.likelihood._term import Repeats
from shaftprint.limits.prediction._prediction_error import AWAY, PredictionError
from shaftprint.time_domain._span import qr_reduced


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class CarriedError(PredictionError):
    """The likelihood of a governor along one descent: ``table`` finds derivatives anew, ``following`` carries them."""

    last: list[tuple[FloatArray, FloatArray]] = field(default_factory=list, repr=False)
    """Free parameters and rows of the last evaluation, if there was one."""

    @classmethod
    def along(cls, term: PredictionError, near: FloatArray | None) -> "CarriedError":
        """Return a likelihood for one descent.

        ``near``: all parameters at a place near its start, whose derivatives are the first ones.
        """
        carried = cls(**{one.name: getattr(term, one.name) for one in fields(term)})
        rows = None if near is None else carried.rows(near)
        if near is not None and rows is not None:
            carried.last.append((near[list(term.free)], rows))
        return carried

    def rows(self, values: FloatArray) -> FloatArray | None:
        """Return innovations over their deviation and below them their derivatives, shape (1 + free, innovations)."""
        now = self.innovations(values)
        coarse = replace(self, record=self.recent.coarser(self.record), longest_step_s=2.0 * self.longest_step_s)
        along = coarse.simulated(values, [self.whole.names[column] for column in self.free])
        if now is None or along is None:
            return None
        return np.concatenate([now.values[None], now.filtered(-along[1:])]) / self.scale

    def table(self, theta: FloatArray, repeats: Repeats | None = None) -> FloatArray:
        """Return QR-reduced innovations and derivatives, shape (1, 1 + free, 1 + free)."""
        return self._reduced(theta[0], self.rows(self.complete(theta)[0]))

    def following(self, starts: int) -> Callable[[FloatArray, IntArray], FloatArray]:
        """Return ``table`` for one descent, the derivatives carried along after the first."""
        return lambda theta, rows: self._carried(theta) if self.last else self.table(theta)

    def _carried(self, theta: FloatArray) -> FloatArray:
        before, rows = self.last[-1]
        now = self.innovations(self.complete(theta)[0])
        if now is None:
            return self._reduced(theta[0], None)
        step, slopes = theta[0] - before, rows[1:]
        weighted = step * np.einsum("ij,ij->i", slopes, slopes)
        length = float(step @ weighted)
        values = now.values / self.scale
        if length > 0.0:
            slopes = slopes + np.outer(weighted / length, values - rows[0] - step @ slopes)
        return self._reduced(theta[0], np.concatenate([values[None], slopes]))

    def _reduced(self, theta: FloatArray, rows: FloatArray | None) -> FloatArray:
        if rows is None:
            table = np.zeros((1, self.row_count, self.row_count))
            table[0, 0, 0] = np.sqrt(2.0 * AWAY)
            return table
        self.last[:] = [(theta.copy(), rows)]
        return qr_reduced(rows)[None]
