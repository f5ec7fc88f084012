"""What the inputs explain whatever the model: finite impulse responses of the residuals.

Residuals of a structure that is missing something still follow the input. What a long finite impulse response from the
input explains of them is no noise: the noise model is taken from the rest, so that it does not depend on the structure,
and its size is a test of the structure (Ljung, System Identification: Theory for the User, second edition, section
16.6). It asks linear questions: what a limit of engine or governor leaves is explained by no linear response, is taken
for noise, and passes. Responses from the cube of the input did not find a torque limit that moved ``k_q`` by twenty of
its standard deviations (p = 0.15); looking for limits is the task of ``limits``.
"""

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.time_domain._record import Record

# Length of the impulse responses [s], and the most lags, evenly spread, that they have.
MEMORY_S, MOST_LAGS = 3.0, 60
# Directions in which the inputs move less than this share of the largest are not excited: a sine has two.
EXCITED = 1e-3
# What lies along directions is no more than noise up to so many times what noise gives there on average.
BY_CHANCE = 1.5


def delayed_inputs(record: Record, *, most: int = MOST_LAGS, longest_s: float = MEMORY_S) -> FloatArray:
    """Return the inputs at every lag, shape (inputs * lags, samples); before its beginning an input was constant.

    ``most``: most lags, no more than usual, evenly spread. ``longest_s``: the longest of them [s].
    """
    lags = np.unique(np.rint(np.linspace(0, longest_s * record.rate_hz, min(most, MOST_LAGS))).astype(int))
    rows = []
    for values in record.inputs.values():
        padded = np.concatenate([np.full(lags[-1], values[0]), values])
        rows += [padded[lags[-1] - lag : padded.size - lag] for lag in lags]
    moves = np.array(rows)
    return np.asarray(moves - moves.mean(axis=1, keepdims=True))


def excited(record: Record) -> FloatArray:
    """Return an orthonormal basis of what the delayed inputs do in the used samples, shape (rank, samples)."""
    rows = delayed_inputs(record) * record.used
    # eigenvalues of the products are the squared sizes: exact enough here, and found in a fraction of the time
    squares, turn = np.linalg.eigh(rows @ rows.T)
    kept = squares > EXCITED**2 * squares[-1]
    return np.asarray((turn[:, kept] / np.sqrt(squares[kept])).T @ rows)


def noise_of(residuals: FloatArray, record: Record) -> FloatArray:
    """Return residuals without what the inputs explain beyond noise, shape (samples, outputs)."""
    used, basis = record.used, excited(record)[:, record.used]
    noise = np.zeros(residuals.shape)
    for output, of_output in enumerate(residuals[used].T):
        noise[used, output] = filled(of_output, of_output - basis.T @ (basis @ of_output), basis)
    return noise


def filled(residuals: FloatArray, unexplained: FloatArray, basis: FloatArray) -> FloatArray:
    """Return what directions leave of residuals with noise along them, as much as others have on average.

    With none there, the noise of a short record would seem to have a gap at the frequencies of its inputs, and a right
    structure would be refused. What the residuals have there stays where it is no more than noise; where it is more,
    signs at random stand for it, which have no colour of their own.

    ``residuals``, ``unexplained``: shape (samples,). ``basis``: orthonormal directions, shape (directions, samples).
    """
    level = float(unexplained @ unexplained) / max(residuals.size - len(basis), 1)
    explained = residuals - unexplained
    if float(explained @ explained) <= BY_CHANCE * level * len(basis):
        return residuals
    signs = np.random.default_rng(0).choice([-1.0, 1.0], size=len(basis))
    return np.asarray(unexplained + np.sqrt(level) * (signs @ basis))
