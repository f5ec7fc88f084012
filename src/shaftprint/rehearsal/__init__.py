"""A planned test sailed before it is sailed: raw recordings of a simulated tug that is as the ship is assumed.

=================== ======= ==========================================================================================
quantity            unit    meaning and sign
=================== ======= ==========================================================================================
truth               as is   parameters and combinations of the simulated ship, normalised at the first working point
limited share       -       part of the time of a leg for which a limit of the simulated engine acted
=================== ======= ==========================================================================================

The tug shares no physics with the models that are identified from it, so that what a plan overlooks shows.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
