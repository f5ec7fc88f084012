from ._settings import ValidationSettings
from ._validate import joined, validate
from ._validation import Validation

__all__ = [
    "Validation",
    "ValidationSettings",
    "joined",
    "validate",
]
