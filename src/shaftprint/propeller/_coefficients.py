"""Printed coefficients of propellers, as files beside this one: a comment in each says what a row is and where from."""

import tomllib
from functools import cache
from importlib.resources import files
from typing import Any


@cache
def coefficients(name: str) -> dict[str, Any]:
    """Return the tables of a file of the folder ``coefficients``, by their names."""
    text = files("shaftprint.propeller").joinpath("coefficients", f"{name}.toml").read_text(encoding="utf-8")
    return tomllib.loads(text)
