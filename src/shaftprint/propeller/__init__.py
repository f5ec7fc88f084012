"""Propellers in open water: thrust and torque over advance and pitch, their slopes, and a ship in steady running.

===================== ======= ===============================================================================
quantity              unit    meaning and sign
===================== ======= ===============================================================================
``J``                 -       advance ratio ``v_a / (n D)``, 0 at bollard pull
``theta``             -       pitch ratio ``P/D``
``K_T``               -       ``T / (rho n^2 D^4)``, propeller and nozzle together, positive ahead
``K_TN``              -       the nozzle's part of ``K_T``
``K_Q``               -       ``Q / (rho n^2 D^5)``, positive when the shaft drives the propeller
``a``, ``b``          -       ``d ln K_T / d ln J``, ``d ln K_Q / d ln J``; not above 0
``p``, ``q``          -       ``d ln K_T / d ln theta``, ``d ln K_Q / d ln theta``; above 0
``w``                 -       wake fraction: the propeller sees ``v_a = v (1 - w)``
``t``                 -       thrust deduction: ``T (1 - t)`` of the thrust pulls the ship
``tau_u``             s       ``m v / R``: time in which the resistance takes all way off the ship
``beta``              rad     advance angle ``atan2(v_a, 0.7 pi n D)``, ``pi`` astern at bollard pull
``C_T*``, ``C_Q*``    -       thrust and torque over ``rho/2 V^2 pi/4 D^2`` and that times ``D``, positive ahead
===================== ======= ===============================================================================

``OpenWaterCurve`` holds in the first quadrant, ship and propeller ahead; ``FourQuadrantCurve`` in all four.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
