"""Every kind of excitation, as one type."""

from typing import TypeAlias

from shaftprint.campaign._binary_sequence import BinarySequence
from shaftprint.campaign._excitations import Chirp, Sine, Staircase
from shaftprint.campaign._multisine import Multisine

# Times of a file have twelve decimals, and a stop is a sum of them.
ROUNDING_S = 1e-9

Excitation: TypeAlias = Sine | Multisine | BinarySequence | Chirp | Staircase
