"""Orders of the shaft taken out of the torque of a leg: over all of its periods and all of its lines at once."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import BoolArray, ComplexArray, FloatArray
from shaftprint.spectra.legs._leg_window import LegWindow
from shaftprint.spectra.lines._window_orders import words_at
from shaftprint.spectra.orders._gears import with_measured_gears
from shaftprint.spectra.orders._line_orders import LineOrders
from shaftprint.spectra.orders._order_fit import OrderFit, fit_orders
from shaftprint.spectra.orders._order_waves import OrderBand, order_bands, order_waves, with_speed

if TYPE_CHECKING:
    from shaftprint.signals._orders import TrackedOrder

# Bins beyond a band in which its order is looked for as well.
_BESIDE_BINS = 10
# A harmonic of the set point of at least this share of the strongest is a line, measured or not.
_LINE_SHARE = 1e-3
_TORQUE = "M_s"


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LegOrders:
    """Orders that were taken out of the torque of a leg."""

    bands: tuple[OrderBand, ...]
    """Where they stand."""
    fit: OrderFit
    """How large they are."""
    waves: ComplexArray
    """Fourier amplitudes of their waves, shape (4 orders, bins)."""
    duration_s: float
    """Length of the window [s]."""

    def at(self, place: int) -> LineOrders:
        """Return what they cost the line at a bin."""
        return LineOrders(
            variance=self.fit.variance_at(self.waves[:, place]),
            taken=self.fit.taken,
            words=words_at(self.bands, place / self.duration_s, _BESIDE_BINS / self.duration_s),
        )


def without_leg_orders(
    window: LegWindow,
    orders: "Sequence[TrackedOrder]",
    speeds_rev_s: Mapping[str, FloatArray],
    *,
    load: FloatArray,
    excitation: str,
) -> tuple[LegWindow, LegOrders | None]:
    """Take the orders that the grid shows out of the torque of a leg.

    ``window``: its whole periods, the torque without the square of the speed and all channels without drift.
    ``orders``: orders of the shaft line. ``speeds_rev_s``: engine speed of each pick-up [rev/s], with its drift, shape
    (periods, samples a period). ``load``: propeller load over that at the working point, shape (periods, samples a
    period). ``excitation``: name of the channel that is moved. Returns the window with what was taken out; the same
    window and None where the grid shows no order.
    """
    state = window.state
    rate_hz = window.values.shape[2] / state.period_s
    speeds = {name: speed.ravel() for name, speed in speeds_rev_s.items()}
    bands = order_bands(orders, speeds, rate_hz=rate_hz)
    if not bands:
        return window, None
    torque = window.channels.index(_TORQUE)
    spectrum = window.spectrum()
    duration_s = state.period_s * state.periods
    chosen = _bins_of(bands, spectrum[window.channels.index(excitation)], state.periods, duration_s)
    bands = with_measured_gears(
        bands, speeds, load.ravel(), spectrum[torque], chosen, rate_hz=rate_hz, transform=_amplitudes
    )
    waves = with_speed(order_waves(bands, speeds, load.ravel(), rate_hz=rate_hz), bands, speeds)
    transformed = _amplitudes(waves)
    fit = fit_orders(spectrum[torque], transformed, chosen)
    values = window.values.copy()
    values[torque] -= (fit.coefficient @ waves).reshape(values[torque].shape)
    found = LegOrders(bands=bands, fit=fit, waves=transformed, duration_s=duration_s)
    return replace(window, values=values), found


def _amplitudes(waves: FloatArray) -> ComplexArray:
    """Return the Fourier amplitudes of waves, shape (waves, bins)."""
    transformed: ComplexArray = np.fft.rfft(waves, axis=1) * (2.0 / waves.shape[1])
    return transformed


def _bins_of(bands: Sequence[OrderBand], moved: ComplexArray, periods: int, duration_s: float) -> BoolArray:
    """Return in which bins the orders are found: their bands, without those at which the set point moves."""
    chosen = np.zeros(moved.size, dtype=np.bool_)
    for band in bands:
        lowest, highest = (round(edge * duration_s) for edge in (band.lowest_hz, band.highest_hz))
        chosen[max(lowest - _BESIDE_BINS, 1) : highest + _BESIDE_BINS + 1] = True
    at_harmonics = np.abs(moved[::periods])
    chosen[::periods] &= at_harmonics < _LINE_SHARE * at_harmonics[1:].max()
    return chosen
