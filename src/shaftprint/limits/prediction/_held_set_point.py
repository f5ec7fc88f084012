"""A set point that reaches the governor in messages: each jump waits for the next one.

Between two messages the governor holds the last set point. Of sines that is seen as a delay of half a cycle and, where
they are fast, as a smaller amplitude: both are those of the mean of the set point over one cycle ``T``. A jump comes
late by another part of the cycle each time, evenly spread over it. With ``d`` the delay of a jump behind ``t_sp``, that
of the sines, known to ``s``, and ``m`` what jumps and sines may differ by in all::

    p(d | T, m) = (Phi((d - m + T / 2) / s) - Phi((d - m - T / 2) / s)) / T

The phase of the messages at a jump counts as drawn by chance, since no clock of a bus is stable enough to predict it
after a minute. ``T`` is uniform in its logarithm, the invariant prior of a width, and ``m`` normal about zero.
"""

from dataclasses import dataclass, replace

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray, frozen_float
from shaftprint.distributions import normal_cdf
from shaftprint.limits.prediction._governor_test import GovernorTest
from shaftprint.limits.prediction._prediction_error import PredictionError

# Cycles that are looked for [s]: below, no delay is known so well; above, steps would be seen in the recorded speed.
SHORTEST_S, LONGEST_S, CYCLES = 2e-3, 0.25, 160
MEANS = 121
# Deviation of a delay that the recorded jump and a model that is not exact leave [s].
LEAST_STD_S = 1e-3
# Fewer jumps than this whose delays are known to this [s] do not tell a cycle: those of a slow set point are not.
FEWEST, KNOWN_S = 4, 0.03
# The torque answers a jump within this time [s], which must be in use.
ANSWERS_S = 0.4
TRIED_S = 2e-3
LONGEST_MOVE_S = 0.04
# Deviation of the delay of all jumps from that of the sines which a model that is not exact leaves [s].
LEAST_MEAN_STD_S = 3e-3
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
    def best_cycle_s(self) -> float:
        """The cycle that explains the delays best [s]."""
        return float(self.cycle_s[int(np.argmax(self.log_likelihood))])

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
    term: PredictionError, values: FloatArray, test: GovernorTest, information: FloatArray
) -> Messages | None:
    """Return the delays of the jumps, to first order from those of a test, and the cycles that explain them.

    ``term``, ``values``: likelihood and parameters of a governor, on the record of the test. ``test``: the test, with
    the jumps as late as they were thought to be. ``information``: one over the prior deviation of each free parameter,
    shape (free,). Returns None where too few jumps are seen, or the simulation runs away.
    """
    rows, now = term.rows(values), term.innovations(values)
    if rows is None or now is None:
        return None
    changes = _change_by_jump(term, values, test)
    columns = now.filtered(-changes) / term.scale
    precision = np.einsum("ij,ij->i", columns, columns)
    std = np.hypot(1.0 / np.sqrt(np.maximum(precision, 1e-12)), LEAST_STD_S)
    seen = _answered(term, test) & (std < KNOWN_S)
    if np.count_nonzero(seen) < FEWEST:
        return None
    free = rows.shape[0] - 1
    slopes = np.concatenate([rows[1:], columns[seen]])
    normal = slopes @ slopes.T
    normal[np.diag_indices(free)] += information**2
    covariance = np.linalg.pinv(normal, hermitian=True)
    step = -covariance @ (slopes @ rows[0])
    moved = test.late_s.copy()
    moved[seen] += np.clip(step[free:], -LONGEST_MOVE_S, LONGEST_MOVE_S)
    weight = precision[seen] / np.sum(precision[seen])
    mean_variance = weight @ covariance[free:, free:] @ weight - 1.0 / np.sum(precision[seen])
    mean_std = float(np.hypot(np.sqrt(max(mean_variance, 0.0)), LEAST_MEAN_STD_S))
    return explained(moved, np.where(seen, std, np.inf), mean_std)


def explained(late_s: FloatArray, std_s: FloatArray, mean_std_s: float) -> Messages:
    """Return which cycles explain delays of jumps.

    ``late_s``, ``std_s``: delays behind the sines and their deviations [s]; those of an infinite one do not count,
    shape (jumps,). ``mean_std_s``: deviation that all have in common [s].
    """
    seen = np.isfinite(std_s)
    late, std = late_s[seen], std_s[seen]
    cycle = np.geomspace(SHORTEST_S, LONGEST_S, CYCLES)
    mean = mean_std_s * np.linspace(-4.0, 4.0, MEANS)
    prior = -0.5 * (mean / mean_std_s) ** 2
    off = late[:, None, None] - mean[None, None, :]
    half = 0.5 * cycle[None, :, None]
    within = normal_cdf((off + half) / std[:, None, None]) - normal_cdf((off - half) / std[:, None, None])
    sharpest = std[:, None, None] * np.sqrt(2.0 * np.pi)
    logs = prior + np.sum(np.log(np.maximum(within * sharpest / cycle[None, :, None], SMALLEST)), axis=0)
    at_best = logs.max(axis=1)
    marginal = at_best + np.log(np.sum(np.exp(logs - at_best[:, None]), axis=1))
    density = np.exp(marginal - marginal.max())
    alike = (late[:, None] - mean) / std[:, None]
    return Messages(
        late_s=frozen_float(np.where(seen, late_s, 0.0)),
        std_s=frozen_float(std_s),
        cycle_s=frozen_float(cycle),
        log_likelihood=frozen_float(at_best),
        one_delay=float(np.max(prior - 0.5 * np.sum(alike**2, axis=0))),
        density=frozen_float(density / density.sum()),
    )


def _answered(term: PredictionError, test: GovernorTest) -> BoolArray:
    """Return whether the answer to each jump is in use, shape (jumps,)."""
    time, used = term.record.time_s, term.record.used
    answers = [(time >= jump.at_s) & (time < jump.at_s + ANSWERS_S) for jump in test.jumps]
    return np.array([bool(where.any() and used[where].all()) for where in answers], dtype=np.bool_)


def _change_by_jump(term: PredictionError, values: FloatArray, test: GovernorTest) -> FloatArray:
    """Return the change of the predicted torque with the delay of each jump [1/s], shape (jumps, samples)."""
    drive_hz = term.record.drive_rate_hz
    later = replace(test, late_s=frozen_float(test.late_s + TRIED_S)).record(drive_hz=drive_hz)
    before = term.predicted(values)
    change = (replace(term, record=later).predicted(values) - before) / TRIED_S
    begins = np.array([jump.at_s for jump in test.jumps])
    ends = np.append(begins[1:], np.inf)
    time = term.record.time_s
    inside = (time >= begins[:, None]) & (time < ends[:, None])
    return np.where(inside, change[None, :], 0.0)
