"""Wageningen B-screw series: open propellers of two to seven blades."""

from shaftprint.errors import PropellerError
from shaftprint.propeller._open_water import OpenWaterCurve
from shaftprint.propeller._polynomial import polynomial

# (power of J, power of P/D, power of A_E/A_0, power of Z, coefficient), 39 and 47 terms.
#
# Copies of the table in circulation differ in single digits. These are the values that most of them share and that keep
# K_Q positive up to the end of the thrust: 0.00110903 for J^3 (P/D)^3 Z (some print 0.0010903), +0.000112451 for
# J^3 (P/D)^2 Z^2 (some print a minus), -0.0000297228 for J^3 (P/D)^6 Z^2 (some print ten times that), -0.00163652 for
# J (P/D)^2 Z^2 of the thrust (some print -0.0016352).
_THRUST = (
    (0, 0, 0, 0, 0.00880496),
    (1, 0, 0, 0, -0.204554),
    (0, 1, 0, 0, 0.166351),
    (0, 2, 0, 0, 0.158114),
    (2, 0, 1, 0, -0.147581),
    (1, 1, 1, 0, -0.481497),
    (0, 2, 1, 0, 0.415437),
    (0, 0, 0, 1, 0.0144043),
    (2, 0, 0, 1, -0.0530054),
    (0, 1, 0, 1, 0.0143481),
    (1, 1, 0, 1, 0.0606826),
    (0, 0, 1, 1, -0.0125894),
    (1, 0, 1, 1, 0.0109689),
    (0, 3, 0, 0, -0.133698),
    (0, 6, 0, 0, 0.00638407),
    (2, 6, 0, 0, -0.00132718),
    (3, 0, 1, 0, 0.168496),
    (0, 0, 2, 0, -0.0507214),
    (2, 0, 2, 0, 0.0854559),
    (3, 0, 2, 0, -0.0504475),
    (1, 6, 2, 0, 0.010465),
    (2, 6, 2, 0, -0.00648272),
    (0, 3, 0, 1, -0.00841728),
    (1, 3, 0, 1, 0.0168424),
    (3, 3, 0, 1, -0.00102296),
    (0, 3, 1, 1, -0.0317791),
    (1, 0, 2, 1, 0.018604),
    (0, 2, 2, 1, -0.00410798),
    (0, 0, 0, 2, -0.000606848),
    (1, 0, 0, 2, -0.0049819),
    (2, 0, 0, 2, 0.0025983),
    (3, 0, 0, 2, -0.000560528),
    (1, 2, 0, 2, -0.00163652),
    (1, 6, 0, 2, -0.000328787),
    (2, 6, 0, 2, 0.000116502),
    (0, 0, 1, 2, 0.000690904),
    (0, 3, 1, 2, 0.00421749),
    (3, 6, 1, 2, 0.0000565229),
    (0, 3, 2, 2, -0.00146564),
)
_TORQUE = (
    (0, 0, 0, 0, 0.00379368),
    (2, 0, 0, 0, 0.00886523),
    (1, 1, 0, 0, -0.032241),
    (0, 2, 0, 0, 0.00344778),
    (0, 1, 1, 0, -0.0408811),
    (1, 1, 1, 0, -0.108009),
    (2, 1, 1, 0, -0.0885381),
    (0, 2, 1, 0, 0.188561),
    (1, 0, 0, 1, -0.00370871),
    (0, 1, 0, 1, 0.00513696),
    (1, 1, 0, 1, 0.0209449),
    (2, 1, 0, 1, 0.00474319),
    (2, 0, 1, 1, -0.00723408),
    (1, 1, 1, 1, 0.00438388),
    (0, 2, 1, 1, -0.0269403),
    (3, 0, 1, 0, 0.0558082),
    (0, 3, 1, 0, 0.0161886),
    (1, 3, 1, 0, 0.00318086),
    (0, 0, 2, 0, 0.015896),
    (1, 0, 2, 0, 0.0471729),
    (3, 0, 2, 0, 0.0196283),
    (0, 1, 2, 0, -0.0502782),
    (3, 1, 2, 0, -0.030055),
    (2, 2, 2, 0, 0.0417122),
    (0, 3, 2, 0, -0.0397722),
    (0, 6, 2, 0, -0.00350024),
    (3, 0, 0, 1, -0.0106854),
    (3, 3, 0, 1, 0.00110903),
    (0, 6, 0, 1, -0.000313912),
    (3, 0, 1, 1, 0.0035985),
    (0, 6, 1, 1, -0.00142121),
    (1, 0, 2, 1, -0.00383637),
    (0, 2, 2, 1, 0.0126803),
    (2, 3, 2, 1, -0.00318278),
    (0, 6, 2, 1, 0.00334268),
    (1, 1, 0, 2, -0.00183491),
    (3, 2, 0, 2, 0.000112451),
    (3, 6, 0, 2, -0.0000297228),
    (1, 0, 1, 2, 0.000269551),
    (2, 0, 1, 2, 0.00083265),
    (0, 2, 1, 2, 0.00155334),
    (0, 6, 1, 2, 0.000302683),
    (0, 0, 2, 2, -0.0001843),
    (0, 3, 2, 2, -0.000425399),
    (3, 3, 2, 2, 0.0000869243),
    (0, 6, 2, 2, -0.0004659),
    (1, 6, 2, 2, 0.0000554194),
)

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
    thrust, torque = (
        tuple((t, s, c * area_ratio**u * blades**v) for s, t, u, v, c in terms) for terms in (_THRUST, _TORQUE)
    )
    return OpenWaterCurve(
        name=f"Wageningen B{blades}-{100.0 * area_ratio:.0f}",
        thrust=polynomial(thrust),
        nozzle_thrust=None,
        torque=polynomial(torque),
        lowest_pitch_ratio=0.5,
        highest_pitch_ratio=1.4,
    )
