"""The line of shafts as masses and springs: modes, forced response, time, two masses; and inertia by calculation.

===================== ============ ====================================================================================
quantity              unit         meaning and sign
===================== ============ ====================================================================================
inertia               kg m2        referred to the propeller shaft: masses on the engine shaft times ``i^2``
stiffness, damping    N m/rad,     of a link, referred to the propeller shaft: links on the engine shaft times ``i^2``
                      N m s/rad
``psi``               1            energy that a link loses in a cycle over its largest elastic energy; the stiffness is
                                   ``k (1 + j psi / (2 pi))``
torque on a mass      N m          referred to the propeller shaft: on the engine shaft times ``i``; positive when it
                                   drives
speed of a mass       rad/s        referred to the propeller shaft: of the engine shaft over ``i``; deviation
torque of a link      N m          at the propeller shaft; positive when its engine side drives its propeller side
``tau``               s            inertia time ``2 pi I n_s0 / M_s0``
===================== ============ ====================================================================================

A gear mesh joins two masses into one body, as does every rigid link. A *body* has the name of its largest mass.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
