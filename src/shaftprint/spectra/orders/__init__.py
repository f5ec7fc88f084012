"""Orders of engine, shaft and propeller in the torque: found by the angle of the shaft, and taken out."""

from shaftprint.spectra.orders._gears import with_measured_gears
from shaftprint.spectra.orders._line_orders import LineOrders
from shaftprint.spectra.orders._order_fit import OrderFit, fit_orders
from shaftprint.spectra.orders._order_waves import OrderBand, order_bands, order_waves, turns_of, with_speed

__all__ = [
    "LineOrders",
    "OrderBand",
    "OrderFit",
    "fit_orders",
    "order_bands",
    "order_waves",
    "turns_of",
    "with_measured_gears",
    "with_speed",
]
