"""Which limits governor and engine have: levels, rates and widths with 95 % intervals, and what may be trusted.

=================== ========= ==========================================================================
quantity            unit      meaning and sign
=================== ========= ==========================================================================
speed ``n``         -         deviation over ``n_0``; the set point alike
torque ``M_b``      -         of the engine, deviation over ``M_b0 = M_s0 / (i eta)``
``m_max``           -         highest torque over ``M_b0`` at the speed of the working point
``m_min``           -         lowest brake torque over ``M_b0``: negative, the engine is motored
``T_aw``            s         time in which the governor's integrator is led back at a limit
``r_x``             1/s       fastest change of the fuel rack over ``X_0``
``r_s``             1/s       fastest change of the set point over ``n_0``
``d_e``             -         speed error over ``n_0`` within which the governor does nothing
``a_0``             -         torque without boost over full-load torque
``tau_tc``          s         time in which the boost follows the torque
``T_set``           s         time from one message with the set point to the next
``q_rpm``           rpm       step of a quantised set point
=================== ========= ==========================================================================
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
