"""Grey-box model structures: blocks, their composition, exact delays, exact gradients, stability.

Arithmetic only: no data, no files, no plots.

=============== ======= ==============================================================================================
quantity        unit    meaning and sign
=============== ======= ==============================================================================================
``n``           -       deviation of engine speed over its working-point value; positive faster
``n_set``       -       deviation of the engine-speed set point over the same working-point speed
``e``           -       ``n_set - n``: positive when the engine is too slow
``E_n``         s       integral of ``e``
``M_s``         -       deviation of shaft torque at the gauge over its working-point value; positive when the engine
                        drives the propeller
``X``           -       deviation of the fuel rack over its working-point value; positive for more fuel
``v_s``         -       deviation of the speed of the ship over its working-point value; positive faster ahead
``M_m``         -       deviation of the torque of an electric machine, at the propeller shaft and over ``M_s0``
``theta_set``   -       deviation of the set point of the pitch over its working-point value; positive for more thrust
``s``           rad/s   Laplace variable, ``1j omega`` on the frequency axis
``tau``         s       inertia time ``2 pi I n_s0 / M_s0``, of the inertia that the index names
=============== ======= ==============================================================================================

Feedback is negative: the closed loop of forward ``G`` and back ``H`` is ``G / (1 + G H)``.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
