"""Engine and propeller beyond small signals, in deviations from the working point as equations of signals.

Speeds, torques and rack are over their values at the working point: ``n`` stands for ``n / n_0 - 1``.
"""

from shaftprint.models.equations._flow import Flow
from shaftprint.models.equations._formula import Formula, Number, as_formula, table
from shaftprint.models.equations._limits import first_order_lag


def quadratic_propeller(speed: Formula, slope: Number) -> Formula:
    """Return the torque of a propeller at the quay, ``k_q ((1 + n) |1 + n| - 1) / 2``.

    ``Q = rho n |n| D^5 K_Q`` with ``J = 0`` (thesis eqs 2.9, 2.12), normalised; of small signals ``k_q n``, where
    ``k_q`` is 2 as long as gauge and inflow are right.
    """
    turned = 1.0 + speed
    return 0.5 * as_formula(slope) * (turned * abs(turned) - 1.0)


def full_load(speed: Formula, highest: Number, curve: "tuple[tuple[float, float], ...]") -> Formula:
    """Return the highest brake torque at a speed, ``m_max c(n) - 1``.

    Parameters
    ----------
    highest
        Torque limit at the working-point speed over the brake torque there.
    curve
        Corner points of speed deviation and limit over that at the working-point speed; empty for a flat one.
    """
    shape: Number = table(speed, curve) if curve else 1.0
    return as_formula(highest) * shape - 1.0


def boosted(
    flow: Flow, torque: Formula, highest: Formula, *, at_rest: Number, unboosted: Number, lag_s: Number
) -> Formula:
    """Return the highest torque for which there is air: the smoke limit of a turbocharged engine.

    ``m_max(n) (a + (1 - a) b) - 1`` with the boost ``b`` late behind the torque, ``tau_tc db/dt = (1 + M_b) / m_max(n)
    - b``: steady running is never limited, a fast rise is. First-order turbocharger lag and a limit that follows the
    boost are the common reduced form (Guzzella and Onder, Introduction to Modeling and Control of Internal Combustion
    Engine Systems, 2010, sections 2.5 and 2.6).

    Parameters
    ----------
    torque
        Brake torque, a deviation.
    highest
        Highest brake torque with full boost, a deviation.
    at_rest
        Highest brake torque over that of the working point, ``m_max(0)``.
    unboosted
        Share ``a`` of it that is given without boost; 0.45 to 0.6 for turbocharged engines of this size.
    lag_s
        Turbocharger lag [s]: 0.5 to 2 s at truck size, 3 to 10 s for medium speed.
    """
    full = 1.0 + highest
    share, steady = as_formula(unboosted), 1.0 / as_formula(at_rest)
    boost = steady + first_order_lag(flow, (1.0 + torque) / full - steady, lag_s, "boost")
    return full * (share + (1.0 - share) * boost) - 1.0


def firing_delay(speed: Formula, cylinders: int, working_point_rev_s: float) -> Formula:
    """Return the mean delay [s] from rack to torque of a four-stroke engine at a speed.

    Half a firing interval, ``1 / (Z n_e)``, until the next cylinder is due, and a quarter of a revolution for
    combustion and expansion, ``1 / (4 n_e)``: 21 ms for six cylinders at 1183.8 rpm. It scales with ``1 / n``.

    Parameters
    ----------
    speed
        Deviation of the engine speed.
    cylinders
        Number of cylinders ``Z``.
    working_point_rev_s
        Engine speed of the working point [rev/s].
    """
    at_working_point = (1.0 / cylinders + 0.25) / working_point_rev_s
    return at_working_point / (1.0 + speed)
