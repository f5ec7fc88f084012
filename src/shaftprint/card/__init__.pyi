from ._card import Card
from ._disagreements import disagreements
from ._write import write_vessel

__all__ = ["Card", "disagreements", "write_vessel"]
