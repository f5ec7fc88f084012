"""The store in a database: where it is, its tables, what is read from them and put into them.

It needs SQLAlchemy; the room asks for it when a store is opened, and not before.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
