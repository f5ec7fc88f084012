from ._continue import standing_after
from ._rehearse import rehearse_on_tug

__all__ = [
    "rehearse_on_tug",
    "standing_after",
]
