"""The fingerprint of a propulsion line: parameters, physical values, margins and conditions, as a JSON record.

=================== =========== ==================================================================================
quantity            unit        meaning
=================== =========== ==================================================================================
``I_dn``, ``I_up``  kg m2       inertia downstream and upstream of the torque gauge, at the propeller shaft
``K_Q``             -           torque coefficient of the propeller, mean of the test
gain margin         -           factor on the loop gain that reaches instability
phase margin        deg         smallest over all crossovers
delay margin        s           smallest extra delay in the loop that reaches instability
gauge zero share    %           zero offset of the torque gauge over the working-point torque without it; positive
                                where it shows too much
=================== =========== ==================================================================================
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
