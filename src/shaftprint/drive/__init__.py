"""The drive file: what was measured of a line that is no ship's, and what is known of it.

=================== ========= ========================================================================================
quantity            unit      meaning
=================== ========= ========================================================================================
input, output       stated    whole values, not deviations, each in the unit that the file states
time                s         of the recording
parameter           stated    in the unit of the structure's parameter
=================== ========= ========================================================================================
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
