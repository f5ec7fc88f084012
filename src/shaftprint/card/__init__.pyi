from ._card import Card
from ._disagreement import Disagreement
from ._disagreements import disagreements

__all__ = [
    "Card",
    "Disagreement",
    "disagreements",
]
