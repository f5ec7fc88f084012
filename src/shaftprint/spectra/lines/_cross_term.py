"""What the second harmonic of the speed adds to the line of the torque."""

import numpy as np

from shaftprint.arrays import ComplexArray


def without_cross_term(
    amplitude: ComplexArray,
    noise: ComplexArray,
    *,
    harmonic: complex,
    variance: float,
    load: float,
    speed: int,
    torque: int,
) -> tuple[ComplexArray, ComplexArray]:
    """Take out of the torque's line what a quadratic propeller makes of the line and its second harmonic.

    A propeller that takes ``load (1 + n)^2`` sees ``n = Re(a e^jx + b e^2jx)``; its square holds
    ``Re(conj(a) b e^jx)``, so the torque's line is larger than that of the linear propeller by ``load conj(a) b``. At
    the peak of a closed loop that is 0.05 % of the line, as much as its noise.

    ``amplitude``: amplitudes over the working point, those of speed and torque among them, shape (channels,).
    ``noise``: covariance ``E[a a^H]`` of their noise, shape (channels, channels). ``harmonic``: complex amplitude ``b``
    of the second harmonic of the speed; not a number where it was not fitted. ``variance``: noise variance ``E|b|^2``
    of the harmonic. ``load``: propeller load of the window over that at the working point. ``speed``, ``torque``:
    places of the two among the channels. Returns amplitudes and noise covariance; unchanged where the harmonic was not
    fitted.
    """
    if not np.isfinite(harmonic):
        return amplitude, noise
    cleaned, spread = amplitude.copy(), noise.copy()
    cleaned[torque] -= load * np.conj(amplitude[speed]) * harmonic
    spread[torque, torque] += (load * np.abs(amplitude[speed])) ** 2 * variance
    return cleaned, spread
