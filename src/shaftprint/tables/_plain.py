"""Tables as data; they stand in a leaf, because rooms below this one print with them too."""

from shaftprint.plain_table import Column, Symbol, Table, numbers, texts

__all__ = ["Column", "Symbol", "Table", "numbers", "texts"]
