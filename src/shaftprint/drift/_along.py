"""How far apart two sets of numbers are along given directions: generalised least squares, arithmetic alone.

With the difference ``d``, its covariance ``C`` and a direction ``u`` the size of the change is

    size = u^T C^-1 d / (u^T C^-1 u),    variance = 1 / (u^T C^-1 u)

(Gauss-Markov). ``z``, the size over its deviation, is standard normal where nothing changed, and half its square is
what the logarithm of the likelihood gains by a change along ``u``.

Directions are alike, so that the largest of ``K`` scores passes a limit less often than ``K`` times in as many cases as
one of them: a bound takes off how often two are beyond it together, summed over a tree of pairs (K. J. Worsley, "An
improved Bonferroni inequality and applications", Biometrika 69, 1982, equation 2).
"""

from dataclasses import dataclass
from functools import cache

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.distributions import chi_square_tail, normal_cdf

# Of the integral over the tail of one score: beyond eight deviations past the limit there is nothing.
_NODES, _TAIL, _LEAST_SPREAD = 64, 8.0, 1e-12


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Whitened:
    """A difference and directions in coordinates in which the noise is white and of unit variance."""

    difference: FloatArray
    """Shape (numbers,)."""
    directions: FloatArray
    """Shape (numbers, directions)."""

    def cosines(self, chosen: tuple[int, ...] = (), asked: tuple[int, ...] | None = None) -> FloatArray:
        """Return the cosine of the angle between each two directions, which is the correlation of their scores.

        At 1 a test of this kind cannot tell them apart.

        ``chosen``: directions beside which a further change is asked for. ``asked``: which directions; all when not
        given. Shape (asked, asked).
        """
        left = self._left(chosen)[:, list(range(self.directions.shape[1]) if asked is None else asked)]
        unit = left / np.linalg.norm(left, axis=0)
        cosines: FloatArray = unit.T @ unit
        return cosines

    def sizes(self, chosen: tuple[int, ...]) -> tuple[FloatArray, FloatArray]:
        """Return size and standard deviation of changes along some of the directions together, shape (chosen,) each."""
        columns = self.directions[:, list(chosen)]
        covariance = np.linalg.inv(columns.T @ columns)
        return covariance @ (columns.T @ self.difference), np.sqrt(np.diag(covariance))

    def scores(self, chosen: tuple[int, ...] = ()) -> FloatArray:
        """Return ``z`` of a further change along each direction, beside those that are chosen; shape (directions,).

        Zero for what is chosen, and for what cannot be told from it.
        """
        left = self._left(chosen)
        length = np.linalg.norm(left, axis=0)
        # what is left of a direction that lies in the others is rounding
        told = length > 1e-6 * np.linalg.norm(self.directions, axis=0)
        return np.where(told, left.T @ self.difference / np.where(told, length, 1.0), 0.0)

    def rest_p_value(self, chosen: tuple[int, ...] = ()) -> float:
        """Return the probability that chance leaves that much or more beside changes along the chosen directions."""
        basis = np.linalg.qr(self.directions[:, list(chosen)])[0]
        rest = self.difference - basis @ (basis.T @ self.difference)
        freedom = self.difference.size - len(chosen)
        return chi_square_tail(float(rest @ rest), freedom) if freedom else 1.0

    def _left(self, chosen: tuple[int, ...]) -> FloatArray:
        """Return what each direction has beside the chosen ones, shape (numbers, directions)."""
        basis = np.linalg.qr(self.directions[:, list(chosen)])[0]
        left: FloatArray = self.directions - basis @ (basis.T @ self.directions)
        return left


def whitened(difference: FloatArray, covariance: FloatArray, directions: FloatArray) -> Whitened:
    """Return a difference and directions with the covariance taken out.

    ``difference``: shape (numbers,). ``covariance``: covariance of the difference, positive definite, shape (numbers,
    numbers). ``directions``: shape (numbers, directions). Raises numpy.linalg.LinAlgError if the covariance is not
    positive definite.
    """
    # numbers of different units: factor the correlation
    scale = np.sqrt(np.diag(covariance))
    if not np.all(np.isfinite(covariance)) or not np.all(scale > 0.0):
        raise np.linalg.LinAlgError("expected finite numbers and positive variances")
    factor = np.linalg.cholesky(covariance / scale[:, None] / scale)
    columns = np.column_stack([difference, directions])
    columns /= scale[:, None]
    solved = np.linalg.solve(factor, columns)
    return Whitened(difference=solved[:, 0], directions=solved[:, 1:])


def p_value_of_largest(score: float, cosines: FloatArray) -> float:
    """Return how probable it is at most that chance makes the largest of several ``|z|`` that large or larger.

    ``score``: the largest ``z``. ``cosines``: correlation of the ``z``, shape (directions, directions).
    """
    limit = abs(score)
    single = 2.0 * float(normal_cdf(-limit))
    # the directions most alike take most from the sum: the largest tree through all of them (Prim)
    alike = np.abs(cosines)
    joined, out = [0], list(range(1, len(alike)))
    links = []
    while out:
        link, nearest = max((alike[at, joined].max(), at) for at in out)
        links.append(link)
        joined.append(nearest)
        out.remove(nearest)
    both = _both_beyond(limit, np.array(links)) if links else np.zeros(0)
    return min(max(len(alike) * single - float(both.sum()), single), 1.0)


@cache
def _gauss() -> tuple[FloatArray, FloatArray]:
    """Return nodes and weights of the rule of Gauss and Legendre, which take longer to find than to use."""
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    return frozen_float(nodes), frozen_float(weights)


def _both_beyond(limit: float, correlation: FloatArray) -> FloatArray:
    """Return the probability that two standard normal numbers are both beyond a limit in size, shape (pairs,)."""
    nodes, weights = _gauss()
    x = limit + 0.5 * _TAIL * (nodes + 1.0)
    density = np.exp(-0.5 * x**2) / np.sqrt(2.0 * np.pi) * 0.5 * _TAIL * weights
    spread = np.sqrt(np.maximum(1.0 - correlation**2, _LEAST_SPREAD))[:, None]
    mean = correlation[:, None] * x
    beyond = normal_cdf((mean - limit) / spread) + normal_cdf((-mean - limit) / spread)
    probability: FloatArray = 2.0 * (beyond @ density)
    return probability
