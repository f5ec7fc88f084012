"""What a fit of a simulated recording must find: the truth as the measured working point normalises it."""

from shaftprint.signals import Signals
from shaftprint.tug import Truth


def as_measured(truth: Truth, signals: Signals) -> dict[str, float]:
    """Return the true parameters of ``GAUGE-CLOSED``, normalised as the signals are.

    Torque is divided by the measured torque, speed by the measured speed, and the set point by the measured line: with
    these, not the true ones, deviations are divided.
    """
    point, true = signals.working_point, truth.normalised
    torque = truth.shaft_torque_nm / point.shaft_torque_nm
    both = torque * point.engine_speed_rev_s * 60.0 / truth.engine_speed_rpm
    line = signals.calibration.slope_rev_s_per_v * signals.dc_scale * 60.0
    return {
        **{name: both * true[name] for name in ("K_p", "K_i", "tau_dn", "tau_up", "g")},
        **{name: true[name] for name in ("t_d", "omega_n", "zeta", "k_q", "t_sp")},
        "c_set": truth.set_point_slope_rpm_per_v / line,
        "t_gauge": 0.0,
    }
