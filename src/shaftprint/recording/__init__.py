"""Raw logger files, untouched: channels with their own clocks, read in chunks.

===================== ======== ====================================================================
quantity              unit     meaning
===================== ======== ====================================================================
counts                1        what the logger stored, int16 or float64
value                 ``unit`` ``counts * scale + offset``, in the unit that the file gives
time                  s        ``start_s + sample / rate_hz`` on the channel's own clock; of messages as the file has it
rate                  Hz       samples a second of one channel
===================== ======== ====================================================================

Files are opened read-only. Values that are not numbers are passed on as they are.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
