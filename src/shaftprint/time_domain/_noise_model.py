"""The colour of noise: a vector autoregression of the residuals of all outputs.

    e_t = A_1 e_{t-1} + ... + A_p e_{t-p} + v_t,     v_t independent with covariance S.

Torque and speed noise have common causes, so that the coefficients are matrices. Any spectrum without zeros, that of a
moving average as well, is met as closely as the data can tell by a sufficient order (Lutkepohl, New Introduction to
Multiple Time Series Analysis, 2005, chapters 3, 4 and 15). Nothing reaches across a gap.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray, frozen_float
from shaftprint.errors import IdentificationError

# Longest memory that is tried by default [s]: beyond it drift terms take what is slow.
LONGEST_S = 2.0
# A coefficient must have so many samples of one output to be estimated from.
SAMPLES_A_COEFFICIENT = 10
# Poles nearer to the unit circle than this have no start-up covariance worth the name.
LARGEST_POLE = 1.0 - 1e-6
DOUBLINGS = 60


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class NoiseModel:
    """A stable vector autoregression."""

    coefficients: FloatArray
    """``A_1`` to ``A_p``, shape (order, outputs, outputs)."""
    covariance: FloatArray
    """Covariance ``S`` of the innovations, shape (outputs, outputs)."""

    @property
    def order(self) -> int:
        """Number of samples that the noise remembers."""
        return int(self.coefficients.shape[0])

    @property
    def outputs(self) -> int:
        """Number of outputs."""
        return int(self.covariance.shape[0])

    @property
    def power(self) -> FloatArray:
        """Covariance of a sample of the noise, shape (outputs, outputs)."""
        return self.start_up[: self.outputs, : self.outputs] if self.order else self.covariance

    @property
    def start_up(self) -> FloatArray:
        """Covariance of ``order`` samples in a row, the earliest first, shape (order outputs, order outputs)."""
        size = self.order * self.outputs
        step, total = _companion(self.coefficients), np.zeros((size, size))
        total[: self.outputs, : self.outputs] = self.covariance
        # sum of step^k total step^kT by doubling (Smith, Matrix equation XA + BX = C, 1968)
        for _ in range(DOUBLINGS):
            more = step @ total @ step.T
            total = total + more
            step = step @ step
            if np.abs(more).max() <= 1e-17 * np.abs(total).max():
                break
        blocks = total.reshape(self.order, self.outputs, self.order, self.outputs)[::-1, :, ::-1]
        return np.asarray(blocks.reshape(size, size))

    @property
    def can_be_whitened(self) -> bool:
        """Whether its covariances have an inverse: of noise that is sharp peaks or drift alone rounding leaves none."""
        try:
            with np.errstate(over="ignore", invalid="ignore"):
                np.linalg.cholesky(self.covariance)
                return bool(np.isfinite(np.linalg.cholesky(self.start_up)).all())
        except np.linalg.LinAlgError:
            return False

    def driven(self, innovations: FloatArray) -> FloatArray:
        """Return what innovations give that follow each other from rest, both of shape (rows, samples, outputs)."""
        noise = innovations.copy()
        for sample in range(1, noise.shape[1]):
            past = noise[:, max(sample - self.order, 0) : sample][:, ::-1]
            noise[:, sample] += np.einsum("rpj,pij->ri", past, self.coefficients[: past.shape[1]])
        return noise

    def spectrum(self, frequency_hz: FloatArray, rate_hz: float) -> ComplexArray:
        """Return the two-sided power spectral density [1/Hz], shape (frequencies, outputs, outputs)."""
        turn = np.exp(-2j * np.pi * np.asarray(frequency_hz)[:, None] / rate_hz * np.arange(1, self.order + 1))
        inverse = np.eye(self.outputs) - np.einsum("fp,pij->fij", turn, self.coefficients)
        transfer = np.linalg.inv(inverse)
        return np.asarray(transfer @ (self.covariance / rate_hz) @ transfer.conj().swapaxes(1, 2))


def white_noise(residuals: FloatArray, stretches: Sequence[slice]) -> NoiseModel:
    """Return noise without memory that is as strong as the residuals, outputs independent of each other.

    ``residuals``: shape (samples, outputs). ``stretches``: where they count.
    """
    kept = np.concatenate([residuals[stretch] for stretch in stretches])
    outputs = residuals.shape[1]
    power = np.maximum(np.mean(kept**2, axis=0), np.finfo(np.float64).tiny)
    return NoiseModel(
        coefficients=frozen_float(np.zeros((0, outputs, outputs))), covariance=frozen_float(np.diag(power))
    )


def estimate_noise(residuals: FloatArray, stretches: Sequence[slice], *, max_order: int) -> NoiseModel:
    """Return the noise that residuals show, its order chosen by the criterion of Schwarz (1978).

    Orders are compared by the equations of Yule and Walker, solved order by order (Whittle, On the fitting of
    multivariate autoregressions, and the approximate canonical factorization of a spectral density matrix, 1963). The
    chosen one is estimated by least squares, which does not flatten sharp peaks; where that gives no stable noise the
    solution of Yule and Walker, always stable, stays, or one of a lower order.

    ``residuals``: shape (samples, outputs). ``stretches``: where they count. ``max_order``: highest order to try.
    Raises IdentificationError if an output has no noise at all, or outputs are the same.
    """
    kept = [residuals[stretch] for stretch in stretches]
    count = sum(part.shape[0] for part in kept)
    outputs = residuals.shape[1]
    highest = min(
        max_order, max(max(part.shape[0] for part in kept) - 1, 0), count // (SAMPLES_A_COEFFICIENT * outputs)
    )
    lags = _autocovariances(kept, highest, count)
    scale = np.sqrt(np.diag(lags[0]))
    if not np.all(scale > 0.0) or np.linalg.matrix_rank(lags[0] / np.outer(scale, scale), tol=1e-12) < outputs:
        raise IdentificationError(
            "noise: expected residuals of every output that are not zero and not those of another output; simulated "
            "data without noise have none, add some."
        )
    fits = _whittle(lags)
    penalty = outputs**2 * np.log(count)
    order = int(np.argmin([count * np.linalg.slogdet(s)[1] + p * penalty for p, (_, s) in enumerate(fits)]))
    least = _least_squares(kept, order) if order else None
    tried = (*(() if least is None else (least,)), *reversed(fits[: order + 1]))
    models = (
        NoiseModel(coefficients=frozen_float(coefficients), covariance=frozen_float(covariance))
        for coefficients, covariance in tried
    )
    return next(one for one in models if not one.order or one.can_be_whitened)


def _autocovariances(kept: Sequence[FloatArray], highest: int, count: int) -> FloatArray:
    """Return the mean of ``e_{t+k} e_t^T`` within stretches, over all samples: such lags are those of stable noise."""
    outputs = kept[0].shape[1]
    lags = np.zeros((highest + 1, outputs, outputs))
    for part in kept:
        for lag in range(min(highest, part.shape[0] - 1) + 1):
            lags[lag] += part[lag:].T @ part[: part.shape[0] - lag]
    return lags / count


def _whittle(lags: FloatArray) -> list[tuple[FloatArray, FloatArray]]:
    """Return coefficients and innovation covariance of every order from 0 on."""
    outputs = lags.shape[1]
    forward = backward = np.zeros((0, outputs, outputs))
    ahead = behind = lags[0]
    fits = [(forward, ahead)]
    for order in range(1, lags.shape[0]):
        gap = lags[order] - (forward @ lags[order - 1 : 0 : -1]).sum(axis=0)
        last, first = gap @ np.linalg.inv(behind), gap.T @ np.linalg.inv(ahead)
        old = forward
        forward = np.concatenate([forward - last @ backward[::-1], last[None]])
        backward = np.concatenate([backward - first @ old[::-1], first[None]])
        ahead, behind = ahead - last @ gap.T, behind - first @ gap
        ahead, behind = 0.5 * (ahead + ahead.T), 0.5 * (behind + behind.T)
        fits.append((forward, ahead))
    return fits


def _least_squares(kept: Sequence[FloatArray], order: int) -> tuple[FloatArray, FloatArray] | None:
    """Return coefficients and innovation covariance by least squares; None where that is no stable noise."""
    outputs = kept[0].shape[1]
    size = order * outputs
    product, cross, square = np.zeros((size, size)), np.zeros((size, outputs)), np.zeros((outputs, outputs))
    count = 0
    for part in kept:
        if part.shape[0] <= order:
            continue
        past = np.concatenate([part[order - k : part.shape[0] - k] for k in range(1, order + 1)], axis=1)
        now = part[order:]
        product, cross, square, count = (
            product + past.T @ past,
            cross + past.T @ now,
            square + now.T @ now,
            count + len(now),
        )
    if count <= 2 * size:
        return None
    try:
        table = np.linalg.solve(product, cross)
    except np.linalg.LinAlgError:
        return None
    covariance = (square - table.T @ cross) / (count - size)
    coefficients = table.reshape(order, outputs, outputs).swapaxes(1, 2)
    if np.abs(np.linalg.eigvals(_companion(coefficients))).max() > LARGEST_POLE:
        return None
    return coefficients, 0.5 * (covariance + covariance.T)


def _companion(coefficients: FloatArray) -> FloatArray:
    """Return the matrix that leads from ``order`` samples, the latest first, to the next."""
    order, outputs, _ = coefficients.shape
    size = order * outputs
    matrix = np.zeros((size, size))
    matrix[:outputs] = coefficients.swapaxes(0, 1).reshape(outputs, size)
    matrix[outputs:, : size - outputs] = np.eye(size - outputs)
    return matrix
