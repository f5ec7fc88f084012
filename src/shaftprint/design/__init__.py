"""The shortest test: multisines that tell most of a ship's propulsion line within the limits of ship and engine.

=================== ======= ==========================================================================================
quantity            unit    meaning and sign
=================== ======= ==========================================================================================
speed share         -       mean speed of a leg over that of the first working point
amplitudes ``c_k``  -       complex amplitudes of the set point over the leg's mean speed:
                            ``Re sum_k c_k exp(j 2 pi h_k t / T)``
use                 -       peak over what a limit leaves at the working point, the margin for noise taken off
brake torque        N m     of the engine, positive when it drives; down to the negative of the motoring torque
=================== ======= ==========================================================================================

A plan is made of what is assumed of the ship (``AssumedShip``), what is wanted (``Wish``), what ship and engine allow
(``Limits``) and the noise. Its accuracy is that of ``predict_joint_accuracy``, and a prediction until it is rehearsed.

Folders: ``inputs`` is what a plan is made of, ``motion`` what a leg does to the ship. ``search`` finds the strongest
lines, ``planning`` makes a ``plan`` of them. A ``planned_test`` is a plan that is ready to be sailed, ``standing`` how
far it has come. ``files`` keep it, ``views`` show it. ``operation`` is where a test, planned or sailed, leaves limits.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
