from ._main import main, shaftprint

__all__ = [
    "main",
    "shaftprint",
]
