"""Orders of the shaft taken out of the torque in the window of a sine."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray
from shaftprint.spectra.lines._line_fit import LineFit, WindowSamples
from shaftprint.spectra.lines._noise import residual_spectrum
from shaftprint.spectra.lines._signal_to_noise import NEIGHBOUR_BINS
from shaftprint.spectra.lines._sine_fit import WholePeriodSine
from shaftprint.spectra.orders._gears import with_measured_gears
from shaftprint.spectra.orders._line_orders import LineOrders
from shaftprint.spectra.orders._order_fit import fit_orders
from shaftprint.spectra.orders._order_waves import OrderBand, order_bands, order_waves

if TYPE_CHECKING:
    from shaftprint.signals._orders import TrackedOrder

# Bins beyond a band in which its order is looked for as well: a steady order stands in one or two bins.
_BESIDE_BINS = 10
_TORQUE = "M_s"


def without_orders(
    samples: WindowSamples, orders: "Sequence[TrackedOrder]", references: Mapping[str, float], *, speed: str
) -> tuple[WindowSamples, LineOrders | None]:
    """Take the orders that reach a line out of the torque of its window.

    ``samples``: channels of the window, over the working point. ``orders``: orders of the shaft line. ``references``:
    value of each channel at the working point; speeds in rev/s. ``speed``: name of the speed with whose square the load
    goes. Returns the window, and what the orders cost the line; the same window and None where no order reaches it.
    """
    speeds = _speeds(samples, orders, references)
    every = order_bands(orders, speeds, rate_hz=samples.rate_hz)
    bands = tuple(band for band in every if _reaches(band, samples))
    if not bands:
        return samples, None
    load = samples.of(speed) ** 2
    alone = _fit(samples, samples.of(_TORQUE)[np.newaxis])
    torque = residual_spectrum(alone)[0]
    chosen = _bins_of(bands, samples, torque.size, len(alone.amplitude))
    bands = with_measured_gears(
        bands,
        speeds,
        load,
        torque,
        chosen,
        rate_hz=samples.rate_hz,
        transform=lambda waves: residual_spectrum(_fit(samples, waves)),
    )
    waves = order_waves(bands, speeds, load, rate_hz=samples.rate_hz)
    fit = _fit(samples, waves)
    found = fit_orders(torque, residual_spectrum(fit), chosen)
    values = samples.values.copy()
    values[samples.channels.index(_TORQUE)] -= found.coefficient @ waves
    cost = LineOrders(
        variance=found.variance_at(fit.amplitude[0]),
        taken=found.taken,
        words=words_at(bands, samples.window.frequency_hz, _BESIDE_BINS / samples.window.duration_s),
    )
    return replace(samples, values=values), cost


def left_in_remark(samples: WindowSamples, orders: "Sequence[TrackedOrder]", references: Mapping[str, float]) -> str:
    """Return a remark where a line stands on an order that was left in; empty where it stands on none.

    ``samples``, ``orders``, ``references``: as those of `without_orders`.
    """
    speeds = _speeds(samples, orders, references)
    frequency, bin_hz = samples.window.frequency_hz, 1.0 / samples.window.duration_s
    bands = order_bands(orders, speeds, rate_hz=samples.rate_hz)
    on = [band.words for band in bands if band.reaches(frequency - bin_hz, frequency + bin_hz)]
    return f"stands on {', '.join(on)}, which was left in the torque" if on else ""


def _fit(samples: WindowSamples, values: FloatArray) -> LineFit:
    """Return the sine of a window in other values."""
    return WholePeriodSine().fit(replace(samples, channels=(), values=values))


def _speeds(
    samples: WindowSamples, orders: "Sequence[TrackedOrder]", references: Mapping[str, float]
) -> dict[str, FloatArray]:
    return {order.speed: samples.of(order.speed) * references[order.speed] for order in orders}


def words_at(bands: Sequence[OrderBand], frequency_hz: float, reach_hz: float) -> str:
    """Return the orders that stand at a frequency in words, or all where none does."""
    near = [band for band in bands if band.reaches(frequency_hz - reach_hz, frequency_hz + reach_hz)]
    return ", ".join(band.words for band in near or bands)


def _reaches(band: OrderBand, samples: WindowSamples) -> bool:
    """Whether an order or its first sideband of the sine itself comes near enough to be noise of the line."""
    window = samples.window
    reach_hz = window.frequency_hz + NEIGHBOUR_BINS / window.duration_s
    return band.reaches(window.frequency_hz - reach_hz, window.frequency_hz + reach_hz)


def _bins_of(bands: Sequence[OrderBand], samples: WindowSamples, count: int, harmonics: int) -> BoolArray:
    """Return in which bins of a window the orders are found: their bands, without the line and its harmonics."""
    window = samples.window
    chosen = np.zeros(count, dtype=np.bool_)
    for band in bands:
        lowest, highest = (round(edge * window.duration_s) for edge in (band.lowest_hz, band.highest_hz))
        chosen[max(lowest - _BESIDE_BINS, 1) : highest + _BESIDE_BINS + 1] = True
    chosen[window.periods * np.arange(1, harmonics + 1)] = False
    return chosen
