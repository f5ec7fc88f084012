"""Slow drift of the propeller load from one window to the next."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float

if TYPE_CHECKING:
    from shaftprint.spectra.lines._line_measurement import LineMeasurement


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LoadDrift:
    """How much the propeller load of each window differs from that at the working point.

    At the quay the propeller takes ``M_s = M_s0 (1 + delta) (n / n_0)^2``. Over a window with speed amplitude ``a``
    the mean of the square is ``(mean n / n_0)^2 + a^2 / 2``, so the window's mean torque gives its ``delta``. In values
    normalised with one working point the slope of the propeller torque is then ``k_q (1 + delta)``: a fit takes that
    factor line by line, so that a drift of the load is neither noise nor bias.
    """

    delta: FloatArray
    """Relative load of each window [-], shape (lines,)."""
    standard_deviation: float
    """Scatter of ``delta`` between the windows [-]; 0 for a single window."""

    def __post_init__(self) -> None:
        """Make the array read-only."""
        object.__setattr__(self, "delta", frozen_float(self.delta))


def load_drift(measurements: Sequence["LineMeasurement"], *, speed: str) -> LoadDrift:
    """Find the relative propeller load of each window.

    ``measurements``: one entry a line, normalised with the working point. ``speed``: name of its
    channel. Returns the drift.
    """
    square = np.array(
        [line.of(line.mean, speed) ** 2 + 0.5 * np.abs(line.of(line.amplitude, speed)) ** 2 for line in measurements]
    )
    delta = np.array([line.of(line.mean, "M_s") for line in measurements]) / square - 1.0
    return LoadDrift(
        delta=delta,
        standard_deviation=float(np.std(delta, ddof=1)) if delta.size > 1 else 0.0,
    )
