"""Every kind of excitation, as one type."""

from typing import TypeAlias

from shaftprint.campaign._binary_sequence import BinarySequence
from shaftprint.campaign._excitations import Chirp, Sine, Staircase
from shaftprint.campaign._multisine import Multisine

Excitation: TypeAlias = Sine | Multisine | BinarySequence | Chirp | Staircase
