from ._card import Card
from ._disagreements import disagreements

__all__ = [
    "Card",
    "disagreements",
]
