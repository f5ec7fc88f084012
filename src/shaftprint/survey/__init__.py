"""One recording with its vessel and campaign, and everything that is identified from it.

What ``shaftprint identify`` does, as a verb: ``run`` gives a ``Survey``, from which reports, tables and files are made.
The single steps are verbs too: ``measure``, ``fit``, ``survey_of``. Numbers in a survey have the units and signs of the
rooms that they come from.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
