"""The line from set-point voltage to engine speed, through the steady levels (thesis eq. 3.2)."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.errors import SignalError
from shaftprint.signals._signals import SetPointCalibration

if TYPE_CHECKING:
    from shaftprint.signals._steady import SteadyStretch

# Stretches whose voltages are this near to each other, as a share of the range, are one level.
_SAME_LEVEL = 0.02
_SAME_LEVEL_V = 0.05
_LEAST_RELATIVE_STD = 1e-5


def calibrate(stretches: "tuple[SteadyStretch, ...]", *, weighted: bool, channel: str) -> SetPointCalibration:
    """Return the line through the steady levels by least squares, with its covariance.

    The covariance is enlarged where the levels scatter about the line more than their standard
    deviations say.

    Parameters
    ----------
    stretches
        Where set point and speed stand still.
    weighted
        Whether each level counts by its standard deviation; the thesis counts all the same.
    channel
        Name of the set-point channel, for messages.

    Raises
    ------
    SignalError
        If there are fewer than two levels.
    """
    volts, speed, deviation = _levels(stretches)
    if volts.size < 2:
        found = ", ".join(f"{level:.3f} V" for level in volts) or "none"
        raise SignalError(
            f"channel {channel}: expected at least two steady levels of the set point to find its "
            f"line, found {found}; record a staircase with two or more levels of at least 30 s."
        )
    used = deviation if weighted else np.ones(volts.size)
    design = np.column_stack([volts, np.ones(volts.size)]) / used[:, np.newaxis]
    (slope, intercept), *_ = np.linalg.lstsq(design, speed / used, rcond=None)
    covariance = np.linalg.inv(design.T @ design)
    misfit = float(np.sum(((slope * volts + intercept - speed) / used) ** 2))
    if volts.size > 2:
        ratio = misfit / (volts.size - 2)
        covariance *= max(ratio, 1.0) if weighted else ratio
    elif not weighted:
        covariance *= float(np.mean(deviation**2))
    return SetPointCalibration(
        slope_rev_s_per_v=float(slope),
        intercept_rev_s=float(intercept),
        covariance=frozen_float(covariance),
        level_v=frozen_float(volts),
        level_rev_s=frozen_float(speed),
        level_std_rev_s=frozen_float(deviation),
    )


def _levels(stretches: "tuple[SteadyStretch, ...]") -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return voltage, speed and standard deviation of the speed of each level, ascending."""
    if not stretches:
        return np.empty(0), np.empty(0), np.empty(0)
    ordered = sorted(stretches, key=lambda stretch: stretch.set_point_v)
    volts = np.array([stretch.set_point_v for stretch in ordered])
    speed = np.array([stretch.speed_rev_s for stretch in ordered])
    deviation = np.array([stretch.speed_std_rev_s for stretch in ordered])
    duration = np.array([stretch.duration_s for stretch in ordered])
    apart = max(_SAME_LEVEL * float(np.ptp(volts)), _SAME_LEVEL_V)
    borders = np.flatnonzero(np.diff(volts) > apart) + 1
    found = []
    for group in np.split(np.arange(volts.size), borders):
        weight = duration[group] / duration[group].sum()
        mean = float(weight @ speed[group])
        spread = float(np.sqrt(np.sum((weight * deviation[group]) ** 2)))
        if group.size > 1:
            between = float(weight @ (speed[group] - mean) ** 2) / (group.size - 1)
            spread = max(spread, float(np.sqrt(between)))
        found.append((float(weight @ volts[group]), mean, max(spread, _LEAST_RELATIVE_STD * mean)))
    level_v, level_rev_s, level_std = np.array(found).T
    return level_v, level_rev_s, level_std
