"""Printed coefficients of propellers, as files beside this one: a comment in each says what a row is and where from."""

from functools import cache
from typing import Any

from shaftprint.files import shipped_table


@cache
def coefficients(name: str) -> dict[str, Any]:
    """Return the tables of a file of the folder ``coefficients``, by their names."""
    return shipped_table("shaftprint.propeller", f"coefficients/{name}.toml")
