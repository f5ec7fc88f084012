"""Wageningen B-screw series: open propellers of two to seven blades."""

from shaftprint.errors import PropellerError
from shaftprint.propeller._coefficients import coefficients
from shaftprint.propeller._open_water import OpenWaterCurve
from shaftprint.propeller._polynomial import polynomial

# Blades: lowest and highest expanded blade area ratio among the models that were tested.
_TESTED_AREA_RATIO = {
    2: (0.30, 0.38),
    3: (0.35, 0.80),
    4: (0.40, 1.00),
    5: (0.45, 1.05),
    6: (0.50, 0.80),
    7: (0.55, 0.85),
}


def wageningen_b(*, blades: int, area_ratio: float) -> OpenWaterCurve:
    """Return the curves of a propeller of the B series, ``P/D`` from 0.5 to 1.4, at a Reynolds number of 2e6.

    Polynomials of M.W.C. Oosterveld and P. van Oossanen, Further computer-analyzed data of the Wageningen B-screw
    series (International Shipbuilding Progress 22, 1975, 251-262), also in M.M. Bernitsas, D. Ray and P. Kinley, K_T,
    K_Q and efficiency curves for the Wageningen B-series propellers (University of Michigan, report 237, 1981). The
    correction to higher Reynolds numbers, a few per cent of ``K_Q``, is left out.

    Parameters
    ----------
    blades
        Number of blades ``Z``, 2 to 7.
    area_ratio
        Expanded blade area over disc area ``A_E/A_0``, within what was tested for that number of blades.

    Raises
    ------
    PropellerError
        If no such propeller was tested.
    """
    if blades not in _TESTED_AREA_RATIO:
        raise PropellerError(f"Wageningen B: expected from 2 to 7 blades, found {blades}; the series has no others.")
    lowest, highest = _TESTED_AREA_RATIO[blades]
    if not lowest <= area_ratio <= highest:
        raise PropellerError(
            f"Wageningen B: expected a blade area ratio A_E/A_0 from {lowest:g} to {highest:g} for {blades} blades, "
            f"found {area_ratio:g}; the series was not tested there."
        )
    table = coefficients("wageningen-b")
    thrust, torque = (
        tuple((t, s, c * area_ratio**u * blades**v) for s, t, u, v, c in table[name]) for name in ("thrust", "torque")
    )
    return OpenWaterCurve(
        name=f"Wageningen B{blades}-{100.0 * area_ratio:.0f}",
        thrust=polynomial(thrust),
        nozzle_thrust=None,
        torque=polynomial(torque),
        lowest_pitch_ratio=0.5,
        highest_pitch_ratio=1.4,
    )
