"""What a caller may add where a file does not say it."""

from collections.abc import Mapping
from pathlib import Path

from shaftprint.errors import RecordingError


def expect_hints(path: Path, hints: Mapping[str, object], known: Mapping[str, type | tuple[type, ...]]) -> None:
    """Refuse hints that a reader does not know or that are of the wrong type.

    Raises
    ------
    RecordingError
        If a hint is unknown or of the wrong type.
    """
    for name, value in hints.items():
        if name not in known:
            raise RecordingError(f"{path}: expected {_listed(known)} for this format, found the hint {name}.")
        if not isinstance(value, known[name]) or isinstance(value, bool):
            raise RecordingError(f"{path}: the hint {name} cannot be {value!r}.")


def _listed(known: Mapping[str, object]) -> str:
    return f"only the hints {', '.join(known)}" if known else "no hints"
