"""Which names MATLAB accepts for variables."""

import re
from collections.abc import Iterable
from pathlib import Path

from shaftprint.errors import RecordingError

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,57}")
"""A MATLAB name has at most 63 characters, of which ``_unit`` takes five."""

_TAKEN = ("sample_rate_hz", "start_s", "time", "t", "fs")


def expect_matlab_names(path: Path, names: Iterable[str]) -> None:
    """Refuse names that MATLAB or the reader would not take as those of channels.

    Raises RecordingError if a name cannot be a MATLAB variable or means the clock.
    """
    for name in names:
        if not _NAME.fullmatch(name) or name in _TAKEN:
            raise RecordingError(
                f'{path}: expected a channel name that MATLAB takes (letter, then letters, digits, "_"; '
                f'not {", ".join(_TAKEN)}), found "{name}".'
            )
