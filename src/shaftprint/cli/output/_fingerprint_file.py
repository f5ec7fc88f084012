"""The fingerprint that a user names, by its file or by the folder of results with it."""

from __future__ import annotations

import hashlib
import re
from pathlib import Path

from shaftprint.errors import FingerprintError
from shaftprint.late import late

with late():
    from shaftprint.fingerprint._design import expect_fingerprint_of
    from shaftprint.fingerprint._drive_fingerprint import DriveFingerprint
    from shaftprint.fingerprint._fingerprint import Fingerprint
    from shaftprint.fingerprint._json_file import of_a_drive, of_a_ship, read_any_fingerprint
    from shaftprint.fingerprint._line_fingerprint import LineFingerprint
    from shaftprint.vessel._vessel import Vessel


FINGERPRINT = "fingerprint.json"
REPORT = "index.html"

_HEAD_BYTES = 4096
_STATED = re.compile(rb'<meta name="fingerprint-sha256" content="([0-9a-f]{64})">')


def fingerprint_file(place: Path) -> Path:
    """Return the file of a fingerprint that is named by itself or by its folder."""
    return place / FINGERPRINT if place.is_dir() else place


def fingerprint_at(place: Path) -> Fingerprint:
    """Return the fingerprint of a ship of a file, or of the folder with it.

    Raises FingerprintError if there is none, it is of a drive, or the page in the folder shows another one.
    """
    return of_a_ship(any_fingerprint_at(place), named=str(fingerprint_file(place)))


def fingerprint_of(vessel: Vessel, place: Path | None) -> Fingerprint | None:
    """Return the fingerprint of a file or folder, of the ship of a vessel file; None where none is named.

    Raises FingerprintError as ``fingerprint_at`` does, or if it is of a ship of another design.
    """
    if place is None:
        return None
    fingerprint = fingerprint_at(place)
    expect_fingerprint_of(vessel, fingerprint, str(place))
    return fingerprint


def drive_fingerprint_at(place: Path) -> DriveFingerprint:
    """Return the fingerprint of a drive of a file, or of the folder with it.

    Raises FingerprintError if there is none, it is of a ship, or the page in the folder shows another one.
    """
    return of_a_drive(any_fingerprint_at(place), named=str(fingerprint_file(place)))


def any_fingerprint_at(place: Path) -> LineFingerprint:
    """Return the fingerprint of a file, or of the folder with it, of a ship or a drive.

    Raises FingerprintError if there is none, or the page in the folder shows another one.
    """
    fingerprint = read_any_fingerprint(place)
    if place.is_dir() and not _is_shown(place):
        # new results may have come in between
        fingerprint = read_any_fingerprint(place)
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
