"""A drive behind a digital output: what a sampled record sees of it."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.models._expression import Dual, Expression, Polynomials, Walk

# Images of the sampling that are summed on either side; the rest follows from how they fall.
IMAGES = 16
# Pairs of images fall with an even power of their number; a higher one than this no longer counts.
LARGEST_POWER = 12


@dataclass(frozen=True, slots=True, eq=False)
class Held(Expression):
    """The response from samples to samples of a drive whose input is held between them.

    ``(1 - exp(-s T)) / T  sum over k of G(s + j k w_s) / (s + j k w_s)`` with ``w_s = 2 pi / T`` (Astrom and
    Wittenmark, Computer-Controlled Systems, 1997, section 7.7): the response of the drive, its hold, and the images of
    both that the sampler folds back. The term ``k = 0`` alone, ``exp(-s T / 2) sinc``, is too coarse for a precise
    measurement where the response falls as slowly as that of a motor's current.
    """

    of: Expression
    """The drive in continuous time, its response falling towards high frequencies."""
    period_s: float
    """Time between two samples ``T`` [s]."""

    def evaluate(self, walk: Walk) -> Dual:
        """Return the sum of the images and its derivatives."""
        number = np.arange(-IMAGES, IMAGES + 1)
        images = walk.s[:, None] + 2j * np.pi / self.period_s * number
        values = {
            name: value if value.shape[-1] == 1 else np.repeat(value, number.size, axis=-1)
            for name, value in walk.values.items()
        }
        inner = Walk(images.ravel(), values, walk.wanted)
        response, gradient = inner.dual(self.of)
        hold = np.asarray(
            (1.0 - np.exp(-walk.s * self.period_s))[:, None] / (images * self.period_s), dtype=np.complex128
        )
        terms = self._shaped(response, hold)
        weights = _weights(terms)
        return np.sum(terms * weights, axis=-1), {
            name: np.sum(self._shaped(slope, hold) * weights, axis=-1) for name, slope in gradient.items()
        }

    def children(self) -> tuple[Expression, ...]:
        """Return the drive."""
        return (self.of,)

    def polynomials(self, values: Mapping[str, float]) -> Polynomials | None:
        """Return None: the response is rational in ``exp(s T)``, not in ``s``."""
        return None

    @staticmethod
    def _shaped(response: ComplexArray, hold: ComplexArray) -> ComplexArray:
        """Return a response at all images times the hold, shape (..., frequencies, images)."""
        return np.asarray(response.reshape(*response.shape[:-1], *hold.shape) * hold)


def _weights(terms: ComplexArray) -> FloatArray:
    """Return the weights with which the summed images stand for all of them, shape (images,).

    Images ``k`` and ``-k`` together fall like ``a / k^q + b / k^(q + 2)``, ``q`` even; from those at half way and at
    the end the sum of all further ones follows.
    """
    pairs = np.abs(terms + terms[..., ::-1]).reshape(-1, terms.shape[-1]).max(axis=0)
    weights = np.ones(terms.shape[-1])
    half, end = pairs[IMAGES + IMAGES // 2], pairs[-1]
    if not 0.0 < end < half:
        return weights
    q = 2 * round(float(np.log2(half / end)) / 2.0)
    if not 2 <= q <= LARGEST_POWER:
        return weights
    k = np.array([IMAGES / 2.0, float(IMAGES)])
    system = np.array([k**-q, k ** -(q + 2)])
    more = np.linalg.solve(system, np.array([_tail(q), _tail(q + 2)]))
    for extra, image in zip(more, (IMAGES // 2, IMAGES), strict=True):
        weights[IMAGES + image] += extra
        weights[IMAGES - image] += extra
    return weights


def _tail(power: int) -> float:
    """Return the sum of ``k^-power`` over all ``k`` beyond the last image (Euler and Maclaurin)."""
    first = IMAGES + 1.0
    return first ** (1 - power) / (power - 1) + 0.5 * first**-power + power / 12.0 * first ** (-power - 1)
