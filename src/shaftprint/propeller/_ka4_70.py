"""Ka4-70 in nozzle 19A: four blades of Kaplan type, blade area ratio 0.70, accelerating nozzle."""

from shaftprint.propeller._coefficients import coefficients
from shaftprint.propeller._open_water import OpenWaterCurve
from shaftprint.propeller._polynomial import polynomial


def ka4_70_in_19a() -> OpenWaterCurve:
    """Return the curves of Ka4-70 in nozzle 19A, ``P/D`` from 0.6 to 1.4.

    Polynomials of M.W.C. Oosterveld, Wake adapted ducted propellers (NSMB publication 345, 1970), as in G. Kuiper, The
    Wageningen Propeller Series (MARIN publication 92-001, 1992).
    """
    table = coefficients("ka4-70-in-19a")
    return OpenWaterCurve(
        name="Ka4-70 in nozzle 19A",
        thrust=polynomial(table["thrust"]),
        nozzle_thrust=polynomial(table["nozzle_thrust"]),
        torque=polynomial(table["torque"]),
        lowest_pitch_ratio=0.6,
        highest_pitch_ratio=1.4,
    )
