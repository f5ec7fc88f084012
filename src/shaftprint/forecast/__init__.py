"""What a ship will do and a test will find, before it is made: simulations, predictions, what is known for a plan.

=================== ======= ==========================================================================================
quantity            unit    meaning and sign
=================== ======= ==========================================================================================
inputs, outputs     as is   deviations over their values at the working point, as the structure has them
standard deviation  as is   of the parameters' covariance alone: without noise, weather or load
slope               rpm/V   change of the engine speed for one volt, negative where a lower voltage asks for more speed
=================== ======= ==========================================================================================

The verbs are what ``simulate``, ``predict``, ``plan`` and ``continue`` call.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
