"""Which nonlinearity a line shows beyond its quadratic propeller: torque limit, rate limits, deadband, turbocharger.

=================== ========= ==========================================================================
quantity            unit      meaning and sign
=================== ========= ==========================================================================
speed ``n``         -         deviation over ``n_0``; the set point alike
torque ``m``        -         of the engine over ``M_b0 = M_s0 / (i eta)``: 1 at the working point;
                              ``M_s / M_s0 + tau_up dn/dt``
``m_max``           -         highest torque at the speed of the working point
``m_min``           -         torque of the motored engine, positive
``r_x``             1/s       fastest change of the fuel rack over ``X_0``
``r_s``             1/s       fastest change of the set point over ``n_0``
``d_e``             -         speed error over ``n_0`` within which the governor does nothing, half of the band
``q``               -         step of a quantised set point over ``n_0``
``air``             -         torque without boost over the full-load torque
``tau_tc``          s         time in which the boost follows the torque
``T_aw``            s         time constant with which the integrator is emptied at a limit
statistic           -         fall of minus twice the log-likelihood
=================== ========= ==========================================================================
"""

from shaftprint.nonlinearity._detect import FALSE_ALARM, detect
from shaftprint.nonlinearity._harmonic_evidence import HarmonicEvidence
from shaftprint.nonlinearity._level_evidence import LevelEvidence
from shaftprint.nonlinearity._limit_evidence import LimitEvidence
from shaftprint.nonlinearity._nonlinearities import Estimate, Finding, Nonlinearities, Suspicion
from shaftprint.nonlinearity._step_evidence import NUMBERS, StepEvidence
from shaftprint.nonlinearity._suspects import Kind

__all__ = [
    "FALSE_ALARM",
    "NUMBERS",
    "Estimate",
    "Finding",
    "HarmonicEvidence",
    "Kind",
    "LevelEvidence",
    "LimitEvidence",
    "Nonlinearities",
    "StepEvidence",
    "Suspicion",
    "detect",
]
