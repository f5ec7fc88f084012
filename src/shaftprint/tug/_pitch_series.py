"""Torque at zero advance over the pitch of the simulated propellers, from the series that were measured in tanks."""

import math

from shaftprint.errors import SettingsError
from shaftprint.vessel._vessel import Vessel

# Ka4-70 in nozzle 19A (M.W.C. Oosterveld, Wake adapted ducted propellers, 1970): the terms of K_Q without J, (power of
# P/D, coefficient). The tests hold both series against the room of propellers.
_KA4_70 = ((0, 0.006735), (3, 0.046605), (4, -0.007366), (6, -0.001730))

# Wageningen B (M.W.C. Oosterveld and P. van Oossanen, Further computer-analyzed data of the Wageningen B-screw series,
# 1975): the terms of K_Q without J, (power of P/D, power of A_E/A_0, power of Z, coefficient).
_WAGENINGEN_B = (
    (0, 0, 0, 0.00379368),
    (2, 0, 0, 0.00344778),
    (1, 1, 0, -0.0408811),
    (2, 1, 0, 0.188561),
    (1, 0, 1, 0.00513696),
    (2, 1, 1, -0.0269403),
    (3, 1, 0, 0.0161886),
    (0, 2, 0, 0.015896),
    (1, 2, 0, -0.0502782),
    (3, 2, 0, -0.0397722),
    (6, 2, 0, -0.00350024),
    (6, 0, 1, -0.000313912),
    (6, 1, 1, -0.00142121),
    (2, 2, 1, 0.0126803),
    (6, 2, 1, 0.00334268),
    (2, 1, 2, 0.00155334),
    (6, 1, 2, 0.000302683),
    (0, 2, 2, -0.0001843),
    (3, 2, 2, -0.000425399),
    (6, 2, 2, -0.0004659),
)
_IN_NOZZLE = ("ka4", "nozzle", "19a")


def torque_over_pitch(vessel: Vessel) -> tuple[float, ...]:
    """Return ``K_Q`` at zero advance of the series that a vessel file names: coefficients of powers of ``P/D``.

    Raises SettingsError if it names no series, or an open propeller without its area ratio.
    """
    propeller = vessel.propeller
    name = (propeller.series or "").lower()
    powers = [0.0] * 7
    if any(word in name for word in _IN_NOZZLE):
        for power, coefficient in _KA4_70:
            powers[power] += coefficient
        return tuple(powers)
    if not name or propeller.area_ratio is None:
        raise SettingsError(
            f"vessel {vessel.name}: expected propeller.series and propeller.area_ratio, from which the simulated ship "
            f"takes its torque over the pitch, found {propeller.series or 'no series'} and "
            f"{'no area ratio' if propeller.area_ratio is None else propeller.area_ratio}; name them."
        )
    for power, of_area, of_blades, coefficient in _WAGENINGEN_B:
        powers[power] += coefficient * propeller.area_ratio**of_area * float(propeller.blades) ** of_blades
    return tuple(powers)


def steepened(powers: tuple[float, ...], pitch_ratio: float, factor: float) -> tuple[float, ...]:
    """Return a curve whose change from its value at one pitch is a factor as large: another propeller than the series.

    ``powers``: coefficients of the powers of ``P/D``. ``pitch_ratio``: pitch at which it stays. ``factor``: how much
    steeper it is.
    """
    stays = (1.0 - factor) * math.fsum(c * pitch_ratio**k for k, c in enumerate(powers))
    return (factor * powers[0] + stays, *(factor * c for c in powers[1:]))
