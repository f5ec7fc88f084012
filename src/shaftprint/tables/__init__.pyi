from ._fingerprint import parameter_table, physical_table
from ._plain import Column, Symbol, Table, numbers, texts

__all__ = [
    "Column",
    "Symbol",
    "Table",
    "numbers",
    "parameter_table",
    "physical_table",
    "texts",
]
