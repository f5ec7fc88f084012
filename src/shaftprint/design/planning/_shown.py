"""Whether the gauge shows what a plan asks for, but for so few samples that nobody misses them."""

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.design.motion._gauge import share_cut_off
from shaftprint.design.motion._motion import motion
from shaftprint.design.plan._plan import Plan
from shaftprint.design.planning._finish import SHARE_HELD
from shaftprint.design.search._uses import Uses, samples_of_period

CRESTS = (0.8, 0.9, 1.0, 1.1, 1.2, 1.3)
"""How many times the ripple is kept free at crests, tried one after the other; one in 10,000 passes the last."""

# Share of the samples of a test that may be expected to be cut off: for the assumed ship, and for nearly all that are
# possible, whose recordings identify refuses with more.
_USUAL, _MOST = 3e-4, 1e-3
# Samples a period of the fastest line.
_SAMPLES = 16


def is_shown(plan: Plan, table: FloatArray) -> bool:
    """Return whether at most 3 in 10,000 samples of a test are expected beyond full scale, and 1 in 1000 for others.

    ``table``: possible ships, the assumed one first, shape (rows, parameters).
    """
    cut_off = np.zeros(len(table))
    for number, leg in enumerate(plan.legs):
        cut_off += leg.duration_s / plan.duration_s * _cut_off(plan, number, table)
    return bool(cut_off[0] <= _USUAL and np.quantile(cut_off, SHARE_HELD) <= _MOST)


def _cut_off(plan: Plan, number: int, table: FloatArray) -> FloatArray:
    """Return the share of a leg's samples that is cut off for each ship, shape (rows,)."""
    leg = plan.legs[number]
    responses = motion(plan.structures[number], table, 2.0 * np.pi * leg.frequency_hz)
    ships, signals, lines = responses.shape
    samples = samples_of_period(leg.harmonics[-1], _SAMPLES)
    uses = Uses(transfer=responses.reshape(-1, lines), harmonics=leg.harmonics, samples=samples, draws=ships)
    deviations = uses.in_time(leg.amplitudes).reshape(ships, signals, samples)
    return np.array([share_cut_off(plan.limits, leg.speed_share, one) for one in deviations])
