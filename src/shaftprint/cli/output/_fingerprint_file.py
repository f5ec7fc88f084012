"""The fingerprint that a user names, by its file or by the folder of results with it."""

from __future__ import annotations

import hashlib
import re
from pathlib import Path

from shaftprint.errors import FingerprintError
from shaftprint.late import late

with late():
    from shaftprint.fingerprint._fingerprint import Fingerprint
    from shaftprint.fingerprint._json_file import read_fingerprint


FINGERPRINT = "fingerprint.json"
REPORT = "index.html"

_HEAD_BYTES = 4096
_STATED = re.compile(rb'<meta name="fingerprint-sha256" content="([0-9a-f]{64})">')


def fingerprint_file(place: Path) -> Path:
    """Return the file of a fingerprint that is named by itself or by its folder."""
    return place / FINGERPRINT if place.is_dir() else place


def fingerprint_at(place: Path) -> Fingerprint:
    """Return the fingerprint of a file, or of the folder with it.

    Raises FingerprintError if there is none, or the page in the folder shows another one.
    """
    if not place.is_dir():
        return read_fingerprint(place)
    fingerprint = read_fingerprint(place / FINGERPRINT)
    if not _is_shown(place):
        # new results may have come in between
        fingerprint = read_fingerprint(place / FINGERPRINT)
        if not _is_shown(place):
            raise FingerprintError(
                f"{place}: expected a page that shows the fingerprint beside it, found {REPORT} of another one than "
                f"{FINGERPRINT}; identify once more, or name the file {place / FINGERPRINT} itself."
            )
    return fingerprint


def _is_shown(folder: Path) -> bool:
    """Return whether the page of a folder shows its fingerprint; so does one that does not say what it shows."""
    page = folder / REPORT
    if not page.is_file():
        return True
    with page.open("rb") as file:
        stated = _STATED.search(file.read(_HEAD_BYTES))
    if stated is None:
        return True
    return stated.group(1).decode() == hashlib.sha256((folder / FINGERPRINT).read_bytes()).hexdigest()
