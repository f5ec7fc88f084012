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

from shaftprint.propeller._four_quadrants import Bollard, FourQuadrantCurve, ThrustAndTorque, four_quadrants
from shaftprint.propeller._ka4_70 import ka4_70_in_19a
from shaftprint.propeller._open_water import OpenWaterCurve, OpenWaterPoint
from shaftprint.propeller._polynomial import Polynomial
from shaftprint.propeller._steady_sailing import SteadySailing, sail_steadily
from shaftprint.propeller._wageningen_b import wageningen_b

__all__ = [
    "Bollard",
    "FourQuadrantCurve",
    "OpenWaterCurve",
    "OpenWaterPoint",
    "Polynomial",
    "SteadySailing",
    "ThrustAndTorque",
    "four_quadrants",
    "ka4_70_in_19a",
    "sail_steadily",
    "wageningen_b",
]
