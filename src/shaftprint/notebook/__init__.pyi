from ._library import library
from ._public_names import closest_names

__all__ = [
    "closest_names",
    "library",
]
