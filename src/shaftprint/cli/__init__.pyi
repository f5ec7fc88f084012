from ._main import shaftprint

__all__ = [
    "shaftprint",
]
