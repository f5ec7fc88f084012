"""The linear response of a ship with two lines around their working points."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike
from tests.tug.linearised import linearised_response

from shaftprint.arrays import ComplexArray
from shaftprint.tug._shared_water import SharedWater
from shaftprint.tug._tug import Tug
from shaftprint.vessel import Vessel


def linearised_both(
    tugs: Sequence[Tug], vessels: Sequence[Vessel], frequency_hz: ArrayLike, *, water: SharedWater
) -> ComplexArray:
    """Return the responses from both set points to speed and torque of both lines, with the exact delays.

    Each line alone answers its set point, and a load; the load is the wash of the other.

    Parameters
    ----------
    tugs, vessels
        The truth and the installation, port first.
    frequency_hz
        Frequencies [Hz], shape (lines,).
    water
        What both propellers share.

    Returns
    -------
    response
        Of ``n`` and ``M_s`` of port, then of starboard, from the set point of port and of starboard [-], normalised at
        the working points, shape (4, 2, lines).
    """
    frequency = np.asarray(frequency_hz, dtype=np.float64)
    s = 2j * np.pi * frequency
    wash = np.exp(-s * water.wash_delay_s) / (water.wash_lag_s * s + 1.0)
    shares = water.port_share, water.starboard_share
    asked = [linearised_response(tug, ship, frequency)[:, 0] for tug, ship in zip(tugs, vessels, strict=True)]
    loaded = [
        linearised_response(tug, ship, frequency, input="load")[:, 0] for tug, ship in zip(tugs, vessels, strict=True)
    ]
    speeds = np.empty((2, 2, frequency.size), dtype=np.complex128)
    for at in range(frequency.size):
        # n_i + l_i c_i W n_j = g_i u_i
        system = np.eye(2, dtype=np.complex128)
        for one, other in ((0, 1), (1, 0)):
            system[one, other] = loaded[one][0, at] * shares[one] * wash[at]
        speeds[:, :, at] = np.linalg.solve(system, np.diag([line[0, at] for line in asked]))
    response = np.empty((4, 2, frequency.size), dtype=np.complex128)
    for one, other in ((0, 1), (1, 0)):
        load = -shares[one] * wash * speeds[other]
        response[2 * one] = speeds[one]
        response[2 * one + 1] = loaded[one][1] * load
        response[2 * one + 1, one] += asked[one][1]
    return response
