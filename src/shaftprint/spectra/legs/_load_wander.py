"""The torque of a leg as a linear line of shafts would show it: without the square of the speed and its own wander.

The propeller takes ``(1 + w) u^2`` of the torque, with the speed ``u = 1 + n`` and a load that wanders by ``w``. What
the wander adds at slow frequencies, ``w`` itself, is noise like any other. What it makes of the lines,
``w (u^2 - 1)``, is not: it changes the height of all strong lines together, as the load at the moment when the speed
swings most is another than the mean, and no covariance of single lines knows of that. In tests of five minutes the
exponent of the propeller torque had errors one and a half times as large as stated. ``w`` follows from speed and
torque, ``1 + w = (M_s - tau_dn s n - z) / (c u^2)``, as far as it is above the noise of the gauge; inertia, zero and
delay of the gauge are those that the lines show. Without these ``w`` would follow the square of the speed.
"""

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray, IntArray
from shaftprint.normalisation import mean_load, propeller_torque

# The load of a propeller at the quay wanders in tens of seconds, and with the surge against the mooring, 0.1 to 0.2 Hz.
# Up to 1 Hz noise of the gauge passes for wander: errors of k_q in five minutes were 1.3 times as large as stated.
_FASTEST_WANDER_HZ = 0.3
# Beside this band the torque has the noise of its gauge, which is no wander.
_GAUGE_NOISE_HZ = (0.5, 1.0)
_SMOOTHED_BINS = 9
NO_LINES: IntArray = np.empty(0, dtype=np.int64)
"""Nothing but the speed is moved."""


def linear_torque(
    speed: FloatArray, torque: FloatArray, lines: IntArray, period_s: float, *, beside: IntArray = NO_LINES
) -> FloatArray:
    """Return the torque without the square of the speed and what a wander of the load makes of the lines.

    ``speed``, ``torque``: over the working point, shape (periods, samples a period). ``lines``: harmonics of the period
    at which the set point of the speed has lines, ascending, shape (lines,). ``period_s``: length of a period [s].
    ``beside``: harmonics at which something else is moved, such as the pitch, which changes the load on purpose.
    """
    square = speed**2
    wander = load_wander(speed, torque, lines, period_s, beside=beside)
    linear: FloatArray = torque - (speed - 1.0) ** 2 - wander * (square - 1.0)
    return linear


def load_wander(
    speed: FloatArray, torque: FloatArray, lines: IntArray, period_s: float, *, beside: IntArray = NO_LINES
) -> FloatArray:
    """Return by how much the load of the propeller differs from its mean over the leg [-], shape of ``speed``.

    Each Fourier coefficient is weighted with the share of it that is no noise of the gauge (Wiener filter). At the
    lines there is none: what would be wander there is the deviation of the lines from the nominal exponent.
    """
    periods = len(speed)
    square = (speed**2).ravel()
    hertz = np.fft.rfftfreq(speed.size, period_s / speed.shape[1])
    of_propeller, slope = propeller_torque(
        speed.ravel(), torque.ravel(), harmonics=lines.tolist(), periods=periods, period_s=period_s
    )
    # the torque is 1 at the mean load: what the slope lacks of that is what the zero adds to it
    zero = (1.0 - slope) / mean_load(np.ones_like(square), square, duration_s=periods * period_s)
    load = np.fft.rfft((of_propeller - zero) / (slope * square))
    kept = np.zeros_like(load)
    moved = np.concatenate([lines, beside])
    bins = np.setdiff1d(np.arange(1, np.searchsorted(hertz, _GAUGE_NOISE_HZ[1])), periods * moved)
    above = hertz[bins] >= _GAUGE_NOISE_HZ[0]
    if above.any():
        share = _share(np.abs(load[bins]) ** 2, above)
        wandering = hertz[bins] < _FASTEST_WANDER_HZ
        kept[bins[wandering]] = (share * load[bins])[wandering]
    wander: FloatArray = np.fft.irfft(kept, speed.size).reshape(speed.shape)
    return wander


def _share(power: FloatArray, noise: BoolArray) -> FloatArray:
    """Return the share of the power of each bin, smoothed, that is above the mean of the bins of noise."""
    width = np.ones(min(_SMOOTHED_BINS, power.size))
    smooth = np.convolve(power, width, "same") / np.convolve(np.ones(power.size), width, "same")
    share: FloatArray = np.clip(1.0 - power[noise].mean() / smooth, 0.0, 1.0)
    return share
