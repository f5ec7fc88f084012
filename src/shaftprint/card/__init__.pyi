from ._disagreements import disagreements

__all__ = [
    "disagreements",
]
