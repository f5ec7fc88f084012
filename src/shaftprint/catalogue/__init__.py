"""The structures that come with the package: those of the thesis, the gauge-aware ones, with limits, under way.

The language in which they are written, blocks and structures, is ``models``; symbols and signs are explained there.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
