"""What the spline through pulse angles makes of a sine in the speed."""

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from shaftprint.signals import SpeedSignal

# Terms fall with the fourth power: the next one is below 1e-7.
_IMAGES = 40


def pick_up_gain(speed: "SpeedSignal", frequency_hz: float) -> float:
    """Return the factor by which a speed signal shows a sine too small.

    A cubic spline through the shaft angles at the pulses, differentiated, shows a sine of ``x`` periods a pulse with

    ``sinc(x)^4 / sum_k sinc(x + k)^4``

    (Unser, Aldroubi and Eden, "B-spline signal processing: Part I", IEEE Transactions on Signal Processing 41 (1993):
    frequency response of the cardinal cubic spline): 0.996 at a fifth of the pulse rate, 0.963 at three tenths, one
    half at half the pulse rate.

    Parameters
    ----------
    speed
        The speed signal.
    frequency_hz
        Frequency of the sine [Hz].

    Returns
    -------
    The factor, at most 1. It is 1 for a signal that is averaged or held, since that belongs to the model of the
    sensor, and above half the pulse rate, where the signal shows an alias.
    """
    if speed.averaging_s > 0.0 or speed.hold_s > 0.0 or frequency_hz > speed.nyquist_hz:
        return 1.0
    place = frequency_hz / speed.pulse_rate_hz
    images = np.sinc(place + np.arange(-_IMAGES, _IMAGES + 1)) ** 4
    return float(images[_IMAGES] / images.sum())
