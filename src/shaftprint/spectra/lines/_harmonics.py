"""Second and third harmonic of the outputs: evidence of nonlinearity."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.spectra.lines._line_measurement import HARMONIC_ORDERS

if TYPE_CHECKING:
    from shaftprint.spectra.lines._line_measurement import LineMeasurement


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Harmonics:
    """Amplitudes of harmonics 2 and 3 of speed and torque, over the working point.

    Values are not a number where a harmonic was not fitted: above half the rate of the grid, and with the two
    bin-picking methods.
    """

    lines: tuple[str, ...]
    """Names of the lines."""
    outputs: tuple[str, ...]
    """Names of the outputs, ``("n", "M_s")``."""
    orders: tuple[int, ...]
    """Orders of the harmonics, ``(2, 3)``."""
    fundamental: FloatArray
    """Amplitude of the line itself [-], shape (lines, outputs)."""
    amplitude: FloatArray
    """Amplitude of each harmonic [-], shape (lines, outputs, orders)."""
    standard_deviation: FloatArray
    """Standard deviation of the real and of the imaginary part of each harmonic [-], shape (lines, outputs, orders)."""
    expected_second_torque: FloatArray
    """Second harmonic of the torque of a quadratic propeller at the measured speed amplitude ``a``, ``a^2 / 2`` [-],
    shape (lines,). From ``(1 + a cos x)^2``; the governor adds its own share above its bandwidth."""

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for name in ("fundamental", "amplitude", "standard_deviation", "expected_second_torque"):
            object.__setattr__(self, name, frozen_float(getattr(self, name)))


def collect_harmonics(measurements: Sequence["LineMeasurement"], *, speed: str) -> Harmonics:
    """Collect the harmonics of one speed channel and the torque.

    ``measurements``: one entry a line. ``speed``: name of its channel. Returns the harmonics of all
    lines.
    """
    chosen = [(line, line.places(speed, "M_s")) for line in measurements]
    amplitude = np.stack([np.abs(line.harmonic[:, places]).T for line, places in chosen])
    variance = np.stack([line.harmonic_variance[:, places].T for line, places in chosen])
    fundamental = np.stack([np.abs(line.amplitude[places]) for line, places in chosen])
    return Harmonics(
        lines=tuple(line.window.line for line in measurements),
        outputs=("n", "M_s"),
        orders=HARMONIC_ORDERS,
        fundamental=fundamental,
        amplitude=amplitude,
        standard_deviation=np.sqrt(0.5 * variance),
        expected_second_torque=0.5 * fundamental[:, 0] ** 2,
    )
