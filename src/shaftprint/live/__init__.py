"""A live test: the program plays the test through a counterpart on board, watches it, judges it and stops it.

======================== ========= ===============================================================================
quantity                 unit      meaning
======================== ========= ===============================================================================
source time              s         clock of the counterpart, which stamps its blocks; any zero
received                 s         clock of this computer when a block was there
set point                V         as campaigns have it
counter                  -         of blocks, one more each; what is missing between two was lost
heartbeat                -         a number that the program raises, and that the counterpart gives back
======================== ========= ===============================================================================

The program never replaces the lever. No protocol fails safe: where its client dies, it holds the last set point. So
the counterpart must go back to the lever by itself when the heartbeat stays away, and nothing is armed before that was
seen to happen. The heartbeat is sent by the loop that judges blocks, so that it stops when nobody judges.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
