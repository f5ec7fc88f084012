"""What is asked of the ship: sines, multisines, chirps and staircases of the speed set point, from a TOML file.

===================== ======== ====================================================================
quantity              unit     meaning
===================== ======== ====================================================================
time                  s        since the start of the recording
set point ``U``       V        what is put out to the governor; a lower voltage asks for more speed
                               on the Stan Tug
offset                V        set point outside of every excitation, and the middle of sines and
                               chirps
amplitude             V        half of peak to peak
frequency             Hz       of a test line; never rad/s
===================== ======== ====================================================================

A sine and a chirp start at their phase, ``U = offset + amplitude sin(phase)``, 0 where none is stated. A
staircase jumps.
Every excitation holds in the half-open interval from its start to its stop.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
