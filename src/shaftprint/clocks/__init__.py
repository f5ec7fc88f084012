"""The clocks of several loggers: a straight line between two of them, found from what both have seen.

===================== ======== ====================================================================
quantity              unit     meaning
===================== ======== ====================================================================
offset                s        what the reference clock reads more than the other
drift                 s/s      by how much the reference clock runs faster
===================== ======== ====================================================================

Raw samples are never moved: a channel on another clock gets another start and rate. What was found stands in the
attributes of the merged recording; ``logger_clocks`` reads it.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
