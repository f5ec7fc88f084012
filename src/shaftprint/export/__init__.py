"""The identified model in the user's tool.

=================== ======= =============================================================================
quantity            unit    meaning and sign
=================== ======= =============================================================================
engine speed        rpm     working-point speed times one plus the deviation ``n``; its set point alike
shaft torque        N m     at the gauge, working-point torque times one plus ``M_s``; positive when driving
others              -       deviations, as in ``shaftprint.models``
=================== ======= =============================================================================
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
