"""Words, symbols and tables as HTML with the look that all pages share: what the report and the server write with.

Whatever a template is given is escaped by ``environment`` and nowhere else.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
