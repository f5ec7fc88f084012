"""A simulated tug with known truth that writes raw logger files.

It shares no physics with the models that are identified: a sign error cannot live in both.

============================ ========== ==========================================================================
quantity                     unit       meaning and sign
============================ ========== ==========================================================================
``n_s``, ``n_e``             rev/s      speed of propeller shaft and engine, positive ahead, ``n_e = i n_s``
``M_s``                      N m        torque at the gauge, positive when the engine drives the propeller
``T``                        N m        torque of an elastic coupling, positive as ``M_s``
``M_b``                      N m        brake torque at the engine flange, negative when the engine is motored
``M_m``                      N m        torque of an electric machine on the gearbox at the propeller shaft, negative
                                        when it is taken out
``X``                        1          fuel rack above zero-torque running; 1 gives rated torque at rated speed
``U``                        V          set-point voltage; more negative asks for more speed
``t_d``, ``t_sp``            s          delays inside the loop and before it
``u``                        rev/s      slipstream velocity, as the shaft speed to which it belongs in steady running
``v``                        m/s        speed of the ship through the water, positive ahead; 0 at the quay
inertias                     kg m2      referred to the propeller shaft, split at the gauge
============================ ========== ==========================================================================
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
