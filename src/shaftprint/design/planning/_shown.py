"""Whether the gauge shows what a plan asks for, but for so few samples that nobody misses them."""

import numpy as np

from shaftprint.design.motion import motion, share_cut_off
from shaftprint.design.plan import Plan
from shaftprint.design.search import Uses

CRESTS = (1.0, 1.1, 1.2, 1.3)
"""How many times the ripple is kept free at crests, tried one after the other; one in 10,000 passes the last."""

# Expected share of the samples of a test that are cut off; identify refuses a recording with more than 1e-3.
_MOST_CUT_OFF = 3e-4
# Samples a period of the fastest line.
_SAMPLES = 16


def is_shown(plan: Plan) -> bool:
    """Return whether at most 3 in 10,000 samples of a test are expected beyond full scale, for the assumed ship."""
    cut_off_s = sum(leg.duration_s * _cut_off(plan, number) for number, leg in enumerate(plan.legs))
    return cut_off_s <= _MOST_CUT_OFF * plan.duration_s


def _cut_off(plan: Plan, number: int) -> float:
    leg = plan.legs[number]
    responses = motion(plan.structures[number], plan.ship.values[None, :], 2.0 * np.pi * leg.frequency_hz)[0]
    samples = 2 ** int(np.ceil(np.log2(_SAMPLES * leg.harmonics[-1])))
    signals = Uses(transfer=responses, harmonics=leg.harmonics, samples=samples, draws=1).in_time(leg.amplitudes)
    return share_cut_off(plan.limits, leg.speed_share, signals)
