"""Stability margins with their standard deviations."""

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray
from shaftprint.fingerprint._fingerprint import Quantity
from shaftprint.identify import Identification
from shaftprint.models import margins

# Share of a standard deviation by which a parameter is moved to see how a margin follows, ...
NUDGE = 0.01
# ... and share of its search width where the test says nothing about it.
NUDGE_UNKNOWN = 1e-4
# A margin that follows such a parameter by less than this share of itself does not depend on it.
UNMOVED = 1e-6


def margin_quantities(identification: Identification) -> tuple[Quantity, ...]:
    """Return gain, phase and delay margin with standard deviations to first order; nothing without feedback.

    A margin that does not exist, because no gain or delay reaches instability, is left out. The standard deviation of
    one that depends on a parameter of which the test says nothing is infinite.
    """
    if identification.margins is None:
        return ()
    middle = _numbers(identification, identification.values)
    there = np.isfinite(middle)
    spread = np.full(middle.size, np.nan)
    spread[there] = _spread(identification, middle[there], there)
    meanings = (
        ("gain margin", "-", "factor on the loop gain that makes the line hunt"),
        ("phase margin", "deg", "smallest phase reserve over all crossovers"),
        ("delay margin", "s", "extra delay in the loop that makes the line hunt"),
    )
    return tuple(
        Quantity(name=name, unit=unit, value=float(middle[i]), std=float(spread[i]), meaning=meaning)
        for i, (name, unit, meaning) in enumerate(meanings)
        if there[i]
    )


def _spread(identification: Identification, middle: FloatArray, there: BoolArray) -> FloatArray:
    """Return the standard deviation of each margin that exists."""
    std = np.sqrt(np.diag(identification.covariance))
    known = np.isfinite(std)
    free = identification.structure.free
    slopes = np.zeros((len(free), middle.size))
    lost = np.zeros(middle.size, dtype=np.bool_)
    for i, parameter in enumerate(free):
        width = NUDGE * std[i] if known[i] else NUDGE_UNKNOWN * (parameter.upper - parameter.lower)
        if width == 0.0:
            continue
        place = identification.structure.names.index(parameter.name)
        ahead, behind = identification.values.copy(), identification.values.copy()
        ahead[place] += width
        behind[place] -= width
        change = _numbers(identification, ahead)[there] - _numbers(identification, behind)[there]
        if known[i]:
            lost |= ~np.isfinite(change)
            slopes[i] = np.where(np.isfinite(change), change, 0.0) / (2.0 * width)
        else:
            lost |= ~(np.abs(change) <= UNMOVED * np.abs(middle))
    covariance = identification.covariance[np.ix_(known, known)]
    variance = np.einsum("im,ij,jm->m", slopes[known], covariance, slopes[known])
    return np.where(lost, np.inf, np.sqrt(variance))


def _numbers(identification: Identification, values: FloatArray) -> FloatArray:
    found = margins(identification.structure, values)
    return np.array([found.gain_margin, np.degrees(found.phase_margin_rad), found.delay_margin_s])
