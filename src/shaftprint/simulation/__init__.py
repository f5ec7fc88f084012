"""Structures in time: simulation with exact delays and limits, steady running, linearisation.

Everything follows from the equations that the blocks of a structure state; compiled once and kept on disk. A ship that
is stopped by its clutches has its equations from the catalogue and its numbers from the vessel file.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
