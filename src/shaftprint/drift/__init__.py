"""Whether a ship has changed between tests, and what has changed: arithmetic on fingerprints, no database.

================ ====== ==========================================================================================
quantity         unit   meaning
================ ====== ==========================================================================================
``size``         -, s   change of a cause: a share of what it moves, negative where it has become less; of delays a time
``score``        -      size over its standard deviation
``odds``         -      likelihood of the difference under the best cause over that under another
================ ====== ==========================================================================================
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
