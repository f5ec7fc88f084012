"""Sidebands that a slowly changing propeller load makes of a line."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray

if TYPE_CHECKING:
    from shaftprint.spectra.lines._noise import ShaftRelation

# Slow bins of the load that are looked for beside the line, and the fewest with which that is worth the noise it takes.
_REACH_BINS = 10
_LEAST_REACH_BINS = 4


def without_modulation(
    spectrum: ComplexArray, torque: FloatArray, relation: "ShaftRelation", *, periods: int
) -> ComplexArray:
    """Take out of the residual what a slowly changing propeller load makes of the line itself.

    A load ``1 + delta(t)`` scales the torque of the sine, so that every slow component of the load comes back on
    both sides of the line. It does not belong to the noise under the line: its mean is the load of the window.
    Bin ``k`` of the torque is seen at ``i + k`` and, conjugated, at ``i - k``, with one complex factor a channel, found
    by least squares; what the factor takes of the noise by chance is given back on average.

    ``spectrum``: Fourier amplitudes of the residual, shape (channels, bins). ``torque``: the torque in the window,
    shape (samples,). ``relation``: how the torque goes with the speed: it stays, where the factors of both take noise
    by chance. ``periods``: number of periods in the window. Returns spectrum without modulation; unchanged where few
    slow bins are free of the neighbours.
    """
    reach = min(_REACH_BINS, (periods - 1) // 2)
    if reach < _LEAST_REACH_BINS or periods + reach >= spectrum.shape[1]:
        return spectrum
    slow = np.fft.rfft(torque)[1 : reach + 1] * (2.0 / torque.size)
    pattern = np.concatenate([slow[::-1].conj(), [0.0], slow])
    neighbours = slice(periods - reach, periods + reach + 1)
    power = max(np.vdot(pattern, pattern).real, np.finfo(np.float64).tiny)
    near = spectrum[:, neighbours].copy()
    turn = relation.turn(np.arange(-reach, reach + 1) / periods)
    near[relation.torque] -= turn * near[relation.speed]
    near = near - (near @ pattern.conj() / power)[:, np.newaxis] * pattern
    near *= np.sqrt(2.0 * reach / (2.0 * reach - 1.0))
    near[relation.torque] += turn * near[relation.speed]
    cleaned = spectrum.copy()
    cleaned[:, neighbours] = near
    return cleaned
