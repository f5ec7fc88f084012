"""Hold an identified model against records that it was not identified from, in numbers instead of by eye.

=================== ======= ==========================================================================================
quantity            unit    meaning
=================== ======= ==========================================================================================
``fit_percent``     %       ``100 (1 - |y - yh| / |y - mean y|)`` of one output (thesis eq. 2.41)
``fit_ceiling``     %       the same for the true model: what the noise allows
error               -       root mean square of what the model misses beyond noise, over that of the motion
delay               s       of the data behind the model; positive where the data come later
overshoot           %       of the height of a step
deviation           -       ``(x - x_0) / x_0`` from the working point
=================== ======= ==========================================================================================
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
