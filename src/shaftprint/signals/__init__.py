"""From raw channels to speed, torque and set point in physical units on one grid, every repair listed.

===================== ======== ====================================================================
quantity              unit     meaning
===================== ======== ====================================================================
time                  s        of the recording; sample ``k`` of a signal is at
                               ``start_s + k / rate_hz``
speed ``n``           rev/s    of the engine; shaft speeds are multiplied by the gear ratio
set point ``n_set``   rev/s    engine speed that is asked for
shaft torque ``M_s``  N m      at the gauge, positive when the engine drives the propeller, ahead
                               or astern
strip angle           rev      from one reflection strip to the next, of the shaft that carries them
fuel rack ``X``       1        what the governor gives; 1 for rated torque at rated speed, positive
                               for driving torque; on its own clock
deviation             1        ``(x - x_0) / x_0`` from the working point
===================== ======== ====================================================================
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
