"""Orders as waves over time: sine and cosine of the angle of a shaft, as large as the load of the propeller.

The angle is the integral of the speed of a pick-up. However the speed swings, the wave of an order turns with it, so
that what looks like noise over a wide band is two numbers: the cosine and the sine part of the order over the load
(order tracking by angle: Fyfe and Munck, "Analysis of computed order tracking", Mechanical Systems and Signal
Processing 11 (1997); here by least squares, without resampling).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray

if TYPE_CHECKING:
    from shaftprint.signals._orders import TrackedOrder

# The grid of the signals is flat up to here, as a share of its rate; an order above is neither needed nor whole.
_HIGHEST_SHARE_OF_RATE = 0.2


@dataclass(frozen=True, kw_only=True, slots=True)
class OrderBand:
    """Where one order stands in a window."""

    order: "TrackedOrder"
    """The order."""
    lowest_hz: float
    """Frequency at the lowest speed of the window [Hz]."""
    highest_hz: float
    """Frequency at the highest speed of the window [Hz]."""

    def reaches(self, lowest_hz: float, highest_hz: float) -> bool:
        """Return whether some of a range of frequencies is in the band."""
        return self.lowest_hz <= highest_hz and self.highest_hz >= lowest_hz

    @property
    def words(self) -> str:
        """Name and frequencies."""
        if f"{self.lowest_hz:.2f}" == f"{self.highest_hz:.2f}":
            return f"{self.order.name} ({self.lowest_hz:.2f} Hz)"
        return f"{self.order.name} ({self.lowest_hz:.2f} to {self.highest_hz:.2f} Hz)"


def order_bands(
    orders: "Sequence[TrackedOrder]", speeds_rev_s: Mapping[str, FloatArray], *, rate_hz: float
) -> tuple[OrderBand, ...]:
    """Return where the orders stand in a window that the grid shows, lowest first.

    ``orders``: those of the vessel. ``speeds_rev_s``: engine speed of every pick-up in the window by its name [rev/s],
    each of shape (samples,). ``rate_hz``: rate of the grid [Hz].
    """
    limits = {name: (float(speed.min()), float(speed.max())) for name, speed in speeds_rev_s.items()}
    bands = [
        OrderBand(
            order=order,
            lowest_hz=order.per_turn * limits[order.speed][0],
            highest_hz=order.per_turn * limits[order.speed][1],
        )
        for order in orders
    ]
    return tuple(band for band in bands if band.highest_hz <= _HIGHEST_SHARE_OF_RATE * rate_hz)


def order_waves(
    bands: Sequence[OrderBand], speeds_rev_s: Mapping[str, FloatArray], load: FloatArray, *, rate_hz: float
) -> FloatArray:
    """Return cosine and sine of each order over time, as large as the load, shape (2 orders, samples).

    ``bands``: orders that are wanted. ``speeds_rev_s``: engine speed of every pick-up by its name [rev/s], each of
    shape (samples,). ``load``: propeller load over that at the working point, shape (samples,). ``rate_hz``: rate of
    the samples [Hz].
    """
    waves = np.empty((2 * len(bands), load.size))
    for place, band in enumerate(bands):
        speed = speeds_rev_s[band.order.speed]
        angle = 2.0 * np.pi * band.order.per_turn * turns_of(speed, rate_hz)
        waves[2 * place], waves[2 * place + 1] = load * np.cos(angle), load * np.sin(angle)
    return waves


def turns_of(speed_rev_s: FloatArray, rate_hz: float) -> FloatArray:
    """Return the turns of a shaft since the first sample [rev], shape of its speed [rev/s].

    ``speed_rev_s``: speed, shape (samples,). ``rate_hz``: rate of the samples [Hz].
    """
    # trapezoids: their errors cancel from pulse to pulse
    turns: FloatArray = (np.cumsum(speed_rev_s) - 0.5 * (speed_rev_s + speed_rev_s[0])) / rate_hz
    return turns


def with_speed(waves: FloatArray, bands: Sequence[OrderBand], speeds_rev_s: Mapping[str, FloatArray]) -> FloatArray:
    """Return waves of orders, and after them what they are times the deviation of the speed from its mean.

    An order whose size and phase change with the speed is the sum of both: one whose torque comes late, since the
    angle is then that of a moment before; one near a torsional mode; one that does not go with the load alone.

    ``waves``: cosine and sine of each order, shape (2 orders, samples). ``bands``: the orders. ``speeds_rev_s``: engine
    speed of every pick-up by its name [rev/s], each of shape (samples,). Returns waves, shape (4 orders, samples).
    """
    swing = {name: speed / speed.mean() - 1.0 for name, speed in speeds_rev_s.items()}
    of_waves = np.repeat([swing[band.order.speed] for band in bands], 2, axis=0)
    return np.concatenate([waves, waves * of_waves])
