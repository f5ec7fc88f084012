"""The step response of a linear structure with exact delays, with its derivatives.

The inverse Laplace transform along ``Re s = a`` by the trapezoidal rule (Dubner and Abate, Numerical inversion of
Laplace transforms by relating them to the finite Fourier cosine transform, 1968; Crump, Numerical inversion of Laplace
transforms using a Fourier series approximation, 1976, eq. 7)::

    y(t) = exp(a t) / T (F(a) / 2 + sum Re(F(a + j k pi / T) exp(j k pi t / T))),    F = H / s.

It is linear in ``F``, so that the derivatives of the response to the parameters give those of the step response. The
upper half of the sum fades out, so that a jump does not ring; it is drawn out over the resolution instead.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from shaftprint.arrays import FloatArray
from shaftprint.errors import StructureError
from shaftprint.models._structure import Structure

TERMS = 4096
# Waves of all terms at all times would take 40 MB.
_TERMS_AT_ONCE = 512
# What the period that the sum has, and the signal not, may add.
ALIAS = 1e-9


def step_response(
    structure: Structure, values: ArrayLike, time_s: ArrayLike, wanted: Sequence[str] = ()
) -> tuple[FloatArray, FloatArray]:
    """Return what every output does after a step of 1 at an input, with its derivatives.

    Parameters
    ----------
    values
        Parameter values, shape (parameters,).
    time_s
        Time after the step [s], shape (times,). What changes faster than a thousandth of the longest is drawn out.
    wanted
        Names of the parameters whose derivatives are wanted.

    Returns
    -------
        Response, shape (channels, times), with one input the channels are the outputs; derivatives, shape (wanted,
        channels, times).

    Raises
    ------
    StructureError
        If no time is positive, or one is negative.
    """
    time = np.atleast_1d(np.asarray(time_s, dtype=np.float64))
    longest = float(time.max(initial=0.0))
    if not longest > 0.0 or np.any(time < 0.0):
        raise StructureError(f"step response of {structure.name}: expected times from 0 s on, one of them positive.")
    half_period = 2.0 * longest
    shift = -np.log(ALIAS) / (2.0 * half_period)
    order = np.arange(TERMS)
    s = shift + 1j * order * np.pi / half_period
    fade = np.where(order < TERMS / 2, 1.0, np.sin(np.pi * order / TERMS) ** 2)
    fade[0] = 0.5
    stacked = structure.stacked(values, s, tuple(wanted)) * (fade / s)
    sums = np.zeros((*stacked.shape[:-1], time.size))
    for first in range(0, TERMS, _TERMS_AT_ONCE):
        terms = slice(first, first + _TERMS_AT_ONCE)
        waves = np.exp(1j * np.outer(order[terms] * np.pi / half_period, time))
        sums += (stacked[..., terms] @ waves).real
    sums *= np.exp(shift * time) / half_period
    responses = np.where(time > 0.0, sums, 0.0)
    return responses[0], responses[1:]
