"""Drives on the bench: records of a drive and its file to parameters, verdict and fingerprint, in time.

=================== ========= ========================================================================================
quantity            unit      meaning
=================== ========= ========================================================================================
input, output       structure whole values, not deviations
time                s         of the recording
parameter           stated    in its own unit, with one standard deviation
=================== ========= ========================================================================================
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
