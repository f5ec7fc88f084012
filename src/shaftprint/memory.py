"""Memory that a step has freed, given back to the system."""

import ctypes
import sys


def give_back_memory() -> None:
    """Give freed memory back, where the C library keeps it: after a long recording it keeps a third of what was used.

    On systems with another C library than that of GNU nothing happens; they give it back by themselves.
    """
    if not sys.platform.startswith("linux"):
        return
    trim = getattr(ctypes.CDLL(None), "malloc_trim", None)
    if trim is not None:
        trim(0)
