"""What a noun is in a notebook: a few lines of text, a small table, and data with labels for pandas and xarray.

A noun that a user handles derives from ``Shown`` and says in ``summary`` what matters of it; text and table follow
from that. One that holds data says in ``labelled`` which; both packages get the same names, units and meanings.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
