"""A set point that reaches the governor in messages: each jump waits for the next one.

Between two messages the governor holds the last set point. Half a cycle is a delay like any other and is in ``t_sp``.
What shows the cycle are the jumps: each comes late by another part of it, evenly spread over one cycle ``T``. With
``d`` the delay of a jump behind the recording, known to ``s``, and ``m`` the mean of all::

    p(d | T, m) = (Phi((d - m + T / 2) / s) - Phi((d - m - T / 2) / s)) / T

The phase of the messages at a jump counts as drawn by chance, since no clock of a bus is stable enough to foretell it
after a minute. A uniform ``m`` and a ``T`` uniform in its logarithm make the interval of ``T`` exact where the delays
are known well, because both are the invariant priors of place and width.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.special import ndtr

from shaftprint.arrays import BoolArray, FloatArray, frozen_float
from shaftprint.limits._governor_test import GovernorTest
from shaftprint.limits._prediction_error import PredictionError

# Cycles that are looked for [s]: below, no delay is known so well; above, steps would be seen in the recorded speed.
SHORTEST_S, LONGEST_S, CYCLES = 2e-3, 0.25, 160
MEANS = 240
# Deviation of a delay that the recorded jump and a model that is not exact leave [s].
LEAST_STD_S = 1e-3
# Fewer jumps than this do not tell a cycle; the torque answers a jump within this time [s], which must be in use.
FEWEST, ANSWERS_S = 4, 0.4
TRIED_S = 2e-3
LONGEST_MOVE_S = 0.04
SMALLEST = 1e-300


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Messages:
    """By how much each jump of the set point comes late, and which cycles explain it."""

    late_s: FloatArray
    """Delay of each jump behind the recording and ``t_sp`` [s], shape (jumps,)."""
    std_s: FloatArray
    """Its standard deviation [s]; infinite where the jump is not seen, shape (jumps,)."""
    cycle_s: FloatArray
    """Cycles [s], shape (cycles,)."""
    log_likelihood: FloatArray
    """Of each cycle, the mean delay at its best, over that of a delay for each jump, shape (cycles,)."""
    one_delay: float
    """The same of one delay for all jumps."""
    density: FloatArray
    """Probability of each cycle, shape (cycles,)."""

    @property
    def gain(self) -> float:
        """Fall of minus twice the log-likelihood from one delay for all jumps to the best cycle."""
        return 2.0 * (float(self.log_likelihood.max()) - self.one_delay)

    @property
    def cost(self) -> float:
        """Rise of minus twice the log-likelihood from a free delay for each jump to the best cycle."""
        return -2.0 * float(self.log_likelihood.max())

    def quantile(self, share: float) -> float:
        """Return the cycle that is longer than the true one with a probability [s]."""
        return float(np.interp(share, np.cumsum(self.density), self.cycle_s))

    def excluded_beyond(self, cost: float) -> float | None:
        """Return the cycle from which on every longer one costs so much [s]; None where there is none."""
        best = max(float(self.log_likelihood.max()), self.one_delay)
        allowed = np.flatnonzero(2.0 * (self.log_likelihood - best) > -cost)
        last = int(allowed[-1]) if allowed.size else -1
        return None if last + 1 >= self.cycle_s.size else float(self.cycle_s[last + 1])


def messages_of(
    term: PredictionError, own: FloatArray, test: GovernorTest, late_s: FloatArray, known: FloatArray
) -> Messages | None:
    """Return the delays of the jumps, to first order from given ones, and the cycles that explain them.

    Parameters
    ----------
    term, own
        Likelihood and parameters of a governor, on the record with the jumps that late.
    test
        The test as recorded.
    late_s
        Delays to begin with [s], shape (jumps,).
    known
        One over the prior deviation of each free parameter, shape (free,).

    Returns
    -------
    None where too few jumps are seen, or the simulation runs away.
    """
    rows, now = term.rows(own), term.innovations(own)
    if rows is None or now is None:
        return None
    changes = _change_by_jump(term, own, test, late_s)
    columns = now.filtered(-changes) / term.scale
    precision = np.einsum("ij,ij->i", columns, columns)
    std = np.hypot(1.0 / np.sqrt(np.maximum(precision, 1e-12)), LEAST_STD_S)
    seen = _seen(term, test)
    if np.count_nonzero(seen) < FEWEST:
        return None
    free = rows.shape[0] - 1
    slopes = np.concatenate([rows[1:], columns[seen]])
    normal = slopes @ slopes.T
    normal[np.diag_indices(free)] += known**2
    step = -np.linalg.pinv(normal, hermitian=True) @ (slopes @ rows[0])
    moved = late_s.copy()
    moved[seen] += np.clip(step[free:], -LONGEST_MOVE_S, LONGEST_MOVE_S)
    return explained(moved, np.where(seen, std, np.inf))


def explained(late_s: FloatArray, std_s: FloatArray) -> Messages:
    """Return which cycles explain delays of jumps [s]; those of infinite deviation do not count."""
    seen = np.isfinite(std_s)
    late, std = late_s[seen], std_s[seen]
    cycle = np.geomspace(SHORTEST_S, LONGEST_S, CYCLES)
    mean = np.linspace(late.min() - 0.5 * LONGEST_S, late.max() + 0.5 * LONGEST_S, MEANS)
    mean = np.concatenate([mean, np.linspace(late.min(), late.max(), MEANS)])
    mean.sort()
    off = late[:, None, None] - mean[None, None, :]
    half = 0.5 * cycle[None, :, None]
    within = ndtr((off + half) / std[:, None, None]) - ndtr((off - half) / std[:, None, None])
    sharpest = std[:, None, None] * np.sqrt(2.0 * np.pi)
    logs = np.sum(np.log(np.maximum(within * sharpest / cycle[None, :, None], SMALLEST)), axis=0)
    at_best = logs.max(axis=1)
    marginal = at_best + np.log(np.trapezoid(np.exp(logs - at_best[:, None]), mean, axis=1))
    density = np.exp(marginal - marginal.max())
    alike = (late - np.sum(late / std**2) / np.sum(1.0 / std**2)) / std
    return Messages(
        late_s=frozen_float(np.where(seen, late_s, float(np.mean(late)))),
        std_s=frozen_float(std_s),
        cycle_s=frozen_float(cycle),
        log_likelihood=frozen_float(at_best),
        one_delay=-0.5 * float(np.sum(alike**2)),
        density=frozen_float(density / density.sum()),
    )


def _seen(term: PredictionError, test: GovernorTest) -> BoolArray:
    """Return whether the answer to each jump is in use, shape (jumps,)."""
    time, used = term.record.time_s, term.record.used
    answers = [(time >= jump.at_s) & (time < jump.at_s + ANSWERS_S) for jump in test.jumps]
    return np.array([bool(where.any() and used[where].all()) for where in answers], dtype=np.bool_)


def _change_by_jump(term: PredictionError, own: FloatArray, test: GovernorTest, late_s: FloatArray) -> FloatArray:
    """Return the change of the predicted torque with the delay of each jump [1/s], shape (jumps, samples)."""
    drive_hz = term.record.drive_rate_hz
    later = test.with_late_jumps(late_s + TRIED_S).record(drive_hz=drive_hz)
    before = term.predicted(own)
    change = (replace(term, record=later).predicted(own) - before) / TRIED_S
    begins = np.array([jump.at_s for jump in test.jumps])
    ends = np.append(begins[1:], np.inf)
    time = term.record.time_s
    inside = (time >= begins[:, None]) & (time < ends[:, None])
    return np.where(inside, change[None, :], 0.0)
