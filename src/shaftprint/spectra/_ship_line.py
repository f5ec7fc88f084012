"""What a speed log shows of a line."""

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from shaftprint.signals import ShipSpeedSignal

# Nearer to half the rate of the log a sine and its alias are hard to tell apart.
_HIGHEST_SHARE_OF_RATE = 0.45


def shows(log: "ShipSpeedSignal", frequency_hz: float) -> bool:
    """Return whether a log gives values often enough for a frequency [Hz]."""
    return frequency_hz <= _HIGHEST_SHARE_OF_RATE / log.cycle_s


def log_gain(log: "ShipSpeedSignal", frequency_hz: float) -> complex:
    """Return what straight lines between values, or holding them, make of a sine of amplitude 1.

    ``sinc^2`` of the periods in a straight line; ``sinc`` and half the hold late where values are held.

    Parameters
    ----------
    log
        The signal.
    frequency_hz
        Frequency of the sine [Hz].
    """
    held = frequency_hz * log.hold_s
    return complex(np.sinc(frequency_hz * log.join_s) ** 2 * np.sinc(held) * np.exp(-1j * np.pi * held))
