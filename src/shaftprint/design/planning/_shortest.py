"""The verb ``shortest``: how long a test has to be for its wishes."""

from collections.abc import Callable

from shaftprint.design.plan._plan import Plan
from shaftprint.errors import DesignError
from shaftprint.units import SECONDS_PER_MINUTE

# The search ends when the worst deviation is so near its wish, or the time is known to this share.
_NEAR = 0.98
_SHARE = 0.02
_MOST_PLANS = 8


def shortest(design: Callable[[float], Plan], *, longest_s: float) -> Plan:
    """Return the shortest plan that meets every wish, as predicted; the longest one where none does.

    The worst deviation over its wish falls with the root of the time in the windows, which gives the next time to try;
    where that leaves the bracket of times known to be too short and long enough, its middle is tried.

    Parameters
    ----------
    design
        The plan of a test of a length [s], such as ``lambda within_s: design_campaign(..., within_s=within_s)``.
    longest_s
        The longest test that may be sailed [s].

    Raises
    ------
    DesignError
        If nothing is wished, or no plan of that length can be made.
    """
    best = design(longest_s)
    if not best.wish.names:
        raise DesignError(
            f"shortest test within {longest_s / SECONDS_PER_MINUTE:g} min: expected a wish, found none; every longer "
            "test knows more."
        )
    too_short_s, latest = 0.0, best
    for _ in range(_MOST_PLANS):
        if max(best.ratios.values()) > _NEAR or best.duration_s - too_short_s < _SHARE * best.duration_s:
            break
        trial_s = (1.0 + 0.5 * _SHARE) * max(latest.seconds_per_wish.values())
        if not too_short_s < trial_s < best.duration_s:
            trial_s = 0.5 * (too_short_s + best.duration_s)
        try:
            latest = design(trial_s)
        except DesignError:
            too_short_s = trial_s
            continue
        if latest.is_enough:
            best = latest
        else:
            too_short_s = trial_s
    return best
