"""The installation: engine, gearbox, propeller, inertias and sensors, from a TOML file.

===================== ============ ==============================================================
quantity              unit         meaning
===================== ============ ==============================================================
rated power           kW           brake power of one engine at rated speed
engine speed          rpm          crankshaft
gear ratio ``i``      1            engine speed over propeller-shaft speed, greater than 0
shaft torque ``M_s``  N m          on the propeller shaft at the gauge, positive when the engine
                                   drives the propeller
inertia               kg m2        of a row on its own shaft; the sums are referred to the
                                   propeller shaft (engine-side rows times ``i`` squared)
stiffness, damping    N m/rad,     of a link between two rows, at the speed of the shaft of those rows
                      N m s/rad
``psi``               1            energy that an elastic link loses in a cycle over its largest elastic energy
``K_Q``               1            effective torque coefficient at zero advance,
                                   ``Q / (rho n^2 D^5)``
order                 1            periods in one turn of a shaft
fuel rack ``X``       1            1 gives rated torque at rated speed; 100 % on the CAN bus
resistance ``R``      N            of the ship at a speed through the water, against the way ahead
===================== ============ ==============================================================

The torque gauge sits on the propeller shaft: *upstream* of it is what lies towards the engine,
*downstream* what lies towards the propeller.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
