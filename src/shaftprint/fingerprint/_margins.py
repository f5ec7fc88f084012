"""Stability margins with their standard deviations."""

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.fingerprint._fingerprint import Quantity
from shaftprint.identify import Identification
from shaftprint.models import margins

# Share of a standard deviation by which a parameter is moved to see how a margin follows.
NUDGE = 0.01


def margin_quantities(identification: Identification) -> tuple[Quantity, ...]:
    """Return gain, phase and delay margin with standard deviations to first order; nothing without feedback."""
    if identification.margins is None:
        return ()
    middle = _numbers(identification, identification.values)
    free = identification.structure.free
    std = np.sqrt(np.diag(identification.covariance))
    slopes = np.zeros((len(free), middle.size))
    for i, parameter in enumerate(free):
        width = NUDGE * std[i]
        if not np.isfinite(width) or width == 0.0:
            continue
        place = identification.structure.names.index(parameter.name)
        ahead, behind = identification.values.copy(), identification.values.copy()
        ahead[place] += width
        behind[place] -= width
        slopes[i] = (_numbers(identification, ahead) - _numbers(identification, behind)) / (2.0 * width)
    finite = np.isfinite(std)
    variance = np.einsum(
        "im,ij,jm->m", slopes[finite], identification.covariance[np.ix_(finite, finite)], slopes[finite]
    )
    meanings = (
        ("gain margin", "-", "factor on the loop gain that makes the line hunt"),
        ("phase margin", "deg", "smallest phase reserve over all crossovers"),
        ("delay margin", "s", "extra delay in the loop that makes the line hunt"),
    )
    return tuple(
        Quantity(name=name, unit=unit, value=float(value), std=float(spread), meaning=meaning)
        for (name, unit, meaning), value, spread in zip(meanings, middle, np.sqrt(variance), strict=True)
        if np.isfinite(value)
    )


def _numbers(identification: Identification, values: FloatArray) -> FloatArray:
    found = margins(identification.structure, values)
    return np.array([found.gain_margin, np.degrees(found.phase_margin_rad), found.delay_margin_s])
