from ._fingerprint import limits, parameter_table, physical_table
from ._plain import Column, Symbol, Table, numbers, texts

__all__ = [
    "Column",
    "Symbol",
    "Table",
    "limits",
    "numbers",
    "parameter_table",
    "physical_table",
    "texts",
]
