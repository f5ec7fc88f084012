"""The states in which a record begins, where they are estimated with the parameters.

For given parameters ``theta`` the states ``x`` are the least-squares solution ``x(theta)`` of the whitened record, with
offset and drift beside them. With the effects ``E`` of the states and the slopes ``J`` of the outputs, whitened and
without offset and drift, their covariance is ``(E E^T)^-1 + D C D^T`` with ``D = -(E E^T)^-1 E J^T`` and the covariance
``C`` of the parameters (Golub and Pereyra, The differentiation of pseudo-inverses and nonlinear least squares problems
whose variables separate, 1973).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray
from shaftprint.identify.fit._estimate import Estimate
from shaftprint.identify.fit._pseudo_inverse import PseudoInverse
from shaftprint.models._structure import Structure
from shaftprint.simulation._equilibrium import state_names
from shaftprint.time_domain._nuisance import left_of
from shaftprint.time_domain._record import Record

# Most steps towards initial states, and the share of what they leave of a record below which what one does is nothing:
# the first is exact where the outputs depend on them linearly, and what the last leaves is projected out with them.
STATE_STEPS, SMALL_STEP = 8, 1e-4
# The same share for states that began near by: a descent that comes to its end brings them there with it.
NEAR_STEP = 1e-2
# A step that gains less than this share of what was left is the last: where friction holds and lets go what is left is
# rough, and has no end.
WORTH = 1e-3
# A state as large as it is moves the whitened record by no more than this, in standard deviations: it is not seen.
UNSEEN = 1e-3
# Times that a step is halved before none is found to help.
HALVINGS = 8


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class InitialStates:
    """States at the first sample of a record's drive."""

    structure: Structure
    """The structure whose states they are."""
    record: Record
    """The data."""
    own: FloatArray
    """All parameters of the structure, shape (parameters,)."""
    values: FloatArray
    """The states, in the structure's units, shape (states,)."""
    effects: FloatArray
    """What one unit of each adds to the outputs as they are compared, shape (states, samples, outputs)."""

    @property
    def names(self) -> tuple[str, ...]:
        """What the equations of the structure call the states."""
        return state_names(self.structure, self.own)


def best_states(
    simulated: Callable[[FloatArray], FloatArray | None],
    whitened: Callable[[FloatArray], FloatArray],
    *,
    data: FloatArray,
    first: FloatArray,
    near: bool = False,
) -> tuple[FloatArray, FloatArray] | None:
    """Return the states that explain a record best, and the simulation from there; None where the simulation runs away.

    ``simulated``: from states, shape (states,), to outputs, their derivatives to parameters and behind them those to
    the states, shape (1 + parameters + states, samples, outputs); None where the simulation runs away. ``whitened``:
    from rows of outputs, shape (rows, samples, outputs), to whitened ones without offset and drift, shape (rows,
    length). ``data``: measured outputs, whitened and without offset and drift, shape (length,). ``first``: states to
    begin with, shape (states,). ``near``: whether these are near the best ones.
    """
    states, run = first, simulated(first)
    if run is None:
        return None

    def left_by(run: FloatArray) -> FloatArray:
        return np.asarray(data - whitened(run[:1])[0])

    left = left_by(run)
    for _ in range(STATE_STEPS):
        moves = whitened(run[run.shape[0] - states.size :]).T
        change = _fitted(moves, left[:, None], first)[:, 0]
        if np.linalg.norm(moves @ change) <= (NEAR_STEP if near else SMALL_STEP) * np.linalg.norm(left):
            # what it leaves is projected out with the effects
            states = states + change
            break
        nearer = _nearer(simulated, left_by, states=states, change=change, left=left)
        if nearer is None:
            break
        before = left @ left
        states, run, left = nearer
        if before - left @ left < WORTH * before:
            break
    return states, run


def _fitted(moves: FloatArray, left: FloatArray, states: FloatArray) -> FloatArray:
    """Return the changes of states that explain what is left, shape (states, columns).

    A state that shows nothing in the record however large it is, as the bristles of a friction that slides at the
    start, stays where it is: a search that moved it would follow rounding to anywhere, and never come to an end.
    """
    shows = (states == 0.0) | (np.linalg.norm(moves, axis=0) * np.abs(states) > UNSEEN)
    change = np.zeros((states.size, left.shape[1]))
    change[shows] = np.linalg.lstsq(moves[:, shows], left, rcond=1e-9)[0]
    return change


def _nearer(
    simulated: Callable[[FloatArray], FloatArray | None],
    left_by: Callable[[FloatArray], FloatArray],
    *,
    states: FloatArray,
    change: FloatArray,
    left: FloatArray,
) -> tuple[FloatArray, FloatArray, FloatArray] | None:
    """Return states that leave less of a record than before, the simulation from them and what they leave, or None.

    A step that is right for small changes may be far too long where a limit acts, or the loop is hardly damped: it is
    halved until it helps.
    """
    for _ in range(HALVINGS):
        run = simulated(states + change)
        if run is not None:
            still_left = left_by(run)
            if still_left @ still_left < left @ left:
                return states + change, run, still_left
        change = 0.5 * change
    return None


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class KnownStates:
    """The best states at some parameters, from which those at parameters near by follow to first order."""

    cost: float
    """Square sum that is left there."""
    own: FloatArray
    """All parameters of the structure, shape (parameters,)."""
    values: FloatArray
    """The states, shape (states,)."""
    slopes: FloatArray
    """Their derivatives to the free parameters, shape (states, free)."""

    @classmethod
    def of(cls, start: InitialStates, cost: float, effects: FloatArray, slopes: FloatArray) -> Self:
        """Return those of a start from whitened effects and derivatives, shape (states or free, length)."""
        return cls(cost=cost, own=start.own, values=start.values, slopes=-_fitted(effects.T, slopes.T, start.values))

    def at(self, own: FloatArray, free: Sequence[int]) -> FloatArray:
        """Return the states at other parameters to first order, shape (states,)."""
        return np.asarray(self.values + self.slopes @ (own - self.own)[list(free)])


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Spread:
    """How well the weights are known of what is found with each record."""

    covariance: FloatArray
    """Covariance of the weights, shape (weights, weights)."""
    inverse: PseudoInverse
    """That of their information, and the directions that the record says nothing of."""
    unknown: BoolArray
    """Which of them depend on parameters of infinite variance, shape (weights,)."""

    def std(self, share: FloatArray) -> float:
        """Return the standard deviation of a weighted sum, shape (weights,); infinite where the record is silent.

        Parameters of infinite variance, such as those at a bound, are taken to be known.
        """
        silent = np.any(share) and not self.inverse.knows(share)
        return np.inf if silent else float(np.sqrt(share @ self.covariance @ share))


def spread_of(effects: FloatArray, *, slopes: FloatArray | None, covariance: FloatArray | None) -> Spread:
    """Return how well the weights of whitened effects are known, shape (weights, length); see ``state_estimates``."""
    inverse = PseudoInverse.of(effects)
    total, unknown = inverse.inverse.copy(), np.zeros(len(effects), dtype=np.bool_)
    if slopes is not None and covariance is not None:
        change = inverse.inverse @ effects @ slopes.T
        finite = np.isfinite(np.diag(covariance))
        total += change[:, finite] @ covariance[np.ix_(finite, finite)] @ change[:, finite].T
        unknown = np.any(change[:, ~finite] != 0.0, axis=1)
    return Spread(covariance=total, inverse=inverse, unknown=unknown)


def state_estimates(
    start: InitialStates,
    effects: FloatArray,
    drifts: FloatArray,
    *,
    slopes: FloatArray | None = None,
    covariance: FloatArray | None = None,
) -> tuple[Estimate, ...]:
    """Return the states with their standard deviations; infinite where the record does not tell of one.

    ``start``: the states. ``effects``: their whitened effects, shape (states, length). ``drifts``: orthonormal basis of
    whitened offsets and drifts, shape (rank, length). ``slopes``, ``covariance``: whitened derivatives to the free
    parameters, shape (free, length), and the covariance of these, shape (free, free); the parameters are taken to be
    known where they are not given. One of infinite variance leaves the states that depend on it unknown.
    """
    spread = spread_of(left_of(effects, drifts), slopes=slopes, covariance=covariance)
    variance = np.diag(spread.covariance).copy()
    variance[spread.inverse.lost | spread.unknown] = np.inf
    return tuple(
        Estimate(name=name, unit="", value=float(value), std=float(np.sqrt(spread)))
        for name, value, spread in zip(start.names, start.values, variance, strict=True)
    )
