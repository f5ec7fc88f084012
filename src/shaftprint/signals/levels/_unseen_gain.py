"""What of a change of the gauge's gain a test may hold without showing it.

Between two legs the gain of the gauge cannot be told from the load, and within one a load that wanders hides a change
of some per cent. So a gauge that seems steady may not be: with the odds of a change before the test, the evidence for
each course against none (Bayes factors with a normal prior of the size) gives those after it, and sizes that are still
possible. Of a sound gauge with a calm load that leaves a tenth of a per cent, of a quick wander a per cent and more.
"""

from collections.abc import Sequence

import numpy as np

from shaftprint.arrays import FloatArray

# One gauge in five changes its gain within a test, by some per cent; a step, a drift and a warm-up as often as another.
_ODDS, _SIZE = 0.25, 0.05


def unseen_gains(
    means: FloatArray, kinds: Sequence[str], *, size: FloatArray, power: FloatArray, twice: FloatArray
) -> FloatArray:
    """Return by how much the gain of each leg may be off the mean of all, for one standard deviation, shape (legs,).

    Signs say which legs are off together. ``means``: mean of each course in each leg, shape (legs, courses). ``kinds``:
    what each course is. ``size``, ``power``: size of each that explains the recording best, and one over its variance,
    shape (courses,). ``twice``: twice the gain in log-likelihood over no change, shape (courses,).
    """
    if len(means) < 2:
        return np.zeros(len(means))
    alike = np.array([kinds.count(kind) * len(set(kinds)) for kind in kinds])
    # that of the best size, less what a size so far out and so well told costs
    known = power + _SIZE**-2.0
    evidence = np.exp(0.5 * np.minimum(twice - size**2 * power / (known * _SIZE**2), 100.0)) / np.sqrt(
        power * _SIZE**2 + 1.0
    )
    odds = _ODDS * evidence / alike
    square = odds / (1.0 + odds.sum()) * ((size * power / known) ** 2 + 1.0 / known)
    apart = means - means.mean(axis=0)
    variances, directions = np.linalg.eigh(apart * square @ apart.T)
    return np.asarray(np.sqrt(max(variances[-1], 0.0)) * directions[:, -1])
