"""Ka4-70 in nozzle 19A: four blades of Kaplan type, blade area ratio 0.70, accelerating nozzle."""

from shaftprint.propeller._open_water import OpenWaterCurve
from shaftprint.propeller._polynomial import polynomial

# (power of P/D, power of J, coefficient)
_THRUST = (
    (0, 0, 0.030550),
    (0, 1, -0.148687),
    (0, 3, -0.391137),
    (1, 1, -0.432612),
    (2, 0, 0.667657),
    (2, 2, 0.285076),
    (3, 0, -0.172529),
    (6, 1, -0.017283),
)
_NOZZLE_THRUST = (
    (0, 0, 0.076594),
    (0, 1, 0.075223),
    (0, 2, -0.061881),
    (0, 3, -0.138094),
    (0, 5, -0.370620),
    (0, 6, 0.323447),
    (1, 0, -0.271337),
    (1, 1, -0.687921),
    (1, 2, 0.225189),
    (1, 6, -0.081101),
    (2, 0, 0.666028),
    (2, 2, 0.734285),
    (3, 0, -0.202467),
    (3, 2, -0.542490),
    (3, 6, -0.016149),
    (4, 3, 0.099819),
    (5, 1, 0.030084),
    (6, 2, -0.001876),
)
_TORQUE = (
    (0, 0, 0.006735),
    (0, 2, -0.016306),
    (0, 4, -0.007244),
    (1, 2, -0.024012),
    (2, 2, 0.005193),
    (3, 0, 0.046605),
    (4, 0, -0.007366),
    (6, 0, -0.001730),
    (6, 1, -0.000337),
    (6, 2, 0.000861),
)


def ka4_70_in_19a() -> OpenWaterCurve:
    """Return the curves of Ka4-70 in nozzle 19A, ``P/D`` from 0.6 to 1.4.

    Polynomials of M.W.C. Oosterveld, Wake adapted ducted propellers (NSMB publication 345, 1970), as in G. Kuiper, The
    Wageningen Propeller Series (MARIN publication 92-001, 1992).
    """
    return OpenWaterCurve(
        name="Ka4-70 in nozzle 19A",
        thrust=polynomial(_THRUST),
        nozzle_thrust=polynomial(_NOZZLE_THRUST),
        torque=polynomial(_TORQUE),
        lowest_pitch_ratio=0.6,
        highest_pitch_ratio=1.4,
    )
