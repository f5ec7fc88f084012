"""Fingerprints in files: JSON, written whole or not at all, read with every wrong field named."""

import hashlib
import json
import re
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from shaftprint.arguments import refusing_none
from shaftprint.errors import FingerprintError, ShaftprintError
from shaftprint.files import read_json, write_bytes
from shaftprint.fingerprint._drive_fingerprint import DRIVE_SCHEMA, DriveFingerprint, is_of_a_drive
from shaftprint.fingerprint._earlier_files import of_earlier_schema, of_later_schema, with_roles
from shaftprint.fingerprint._fingerprint import SCHEMA_VERSION, Fingerprint
from shaftprint.fingerprint._line_fingerprint import LineFingerprint
from shaftprint.publication._publish import complete
from shaftprint.records import faults
from shaftprint.spelling import meant_beside

_SCHEMA_2 = re.compile(r"2\.([0-9]{1,4})")
MINOR = int(SCHEMA_VERSION.partition(".")[2])


def write_fingerprint(fingerprint: LineFingerprint, path: str | Path) -> None:
    """Write a fingerprint, of a ship or a drive, as JSON, whole or not at all; an existing file is replaced.

    Raises
    ------
    FingerprintError
        If the file cannot be written.
    """
    write_bytes(Path(path), fingerprint_document(fingerprint), noun="fingerprint", error=FingerprintError)


def fingerprint_sha256(fingerprint: LineFingerprint) -> str:
    """Return the SHA-256 of the file that ``write_fingerprint`` writes, hexadecimal."""
    return hashlib.sha256(fingerprint_document(fingerprint)).hexdigest()


def fingerprint_document(fingerprint: LineFingerprint) -> bytes:
    """Return the content of the file that ``write_fingerprint`` writes."""
    # bytes, not text: the same on every system
    return (fingerprint.model_dump_json(indent=2) + "\n").encode()


IN_A_FOLDER = "fingerprint.json"
"""Name of the file of a result in its folder."""


@refusing_none(FingerprintError)
def read_fingerprint(path: str | Path) -> Fingerprint:
    """Read the fingerprint of a ship from JSON; what was written comes back equal.

    Parameters
    ----------
    path
        The file, or the folder in which ``identify`` has put it, as commands take it.

    Raises
    ------
    FingerprintError
        If the file is missing, is no fingerprint, is of another schema, or has fields that are wrong; all of them are
        listed.
    PublicationError
        If its folder holds new results that cannot be put in place.
    """
    return of_a_ship(read_any_fingerprint(path), named=str(path))


@refusing_none(FingerprintError)
def read_drive_fingerprint(path: str | Path) -> DriveFingerprint:
    """Read the fingerprint of a drive from JSON; what was written comes back equal.

    Raises
    ------
    FingerprintError
        If the file is missing, is no fingerprint of a drive, or has fields that are wrong; all of them are listed.
    """
    return of_a_drive(read_any_fingerprint(path), named=str(path))


def of_a_drive(fingerprint: LineFingerprint, *, named: str) -> DriveFingerprint:
    """Return the fingerprint of a drive.

    Raises FingerprintError if it is of a ship.
    """
    if not isinstance(fingerprint, DriveFingerprint):
        raise FingerprintError(
            f"{named}: expected the fingerprint of a drive, made with --drive, found that of a ship; leave --drive out."
        )
    return fingerprint


def of_a_ship(fingerprint: LineFingerprint, *, named: str) -> Fingerprint:
    """Return the fingerprint of a ship.

    Raises FingerprintError if it is of a drive.
    """
    if not isinstance(fingerprint, Fingerprint):
        raise FingerprintError(
            f"{named}: expected the fingerprint of a ship, found that of a drive; show, compare, store, drift, "
            "validate --drive and export fmu, modelica, matlab, ssp and osp take it."
        )
    return fingerprint


@refusing_none(FingerprintError)
def read_any_fingerprint(path: str | Path) -> LineFingerprint:
    """Read a fingerprint, of a ship or a drive, from JSON.

    Raises FingerprintError as ``read_fingerprint`` does, and PublicationError.
    """
    json_path = Path(path)
    complete(json_path if json_path.is_dir() else json_path.parent)
    if json_path.is_dir():
        json_path /= IN_A_FOLDER

    def where() -> str:
        return f"name the file, or the folder in which identify or demo has put it.{meant_beside(json_path)}"

    text, content = read_json(json_path, noun="fingerprint", where=where, error=FingerprintError)
    return _fingerprint_of(text, content, named=str(json_path))


@refusing_none(FingerprintError)
def parse_fingerprint(document: bytes, *, named: str) -> LineFingerprint:
    """Read a fingerprint, of a ship or a drive, from the bytes of its file, as ``read_any_fingerprint`` does.

    ``document``: content of the file. ``named``: what it is called in an error, such as the path it came from. Raises
    FingerprintError if it is no fingerprint, is of another schema, or has fields that are wrong; all of them are
    listed.
    """
    try:
        fingerprint = Fingerprint.model_validate_json(document)
        # a document that does not state its schema has the default, and is refused below
        if "schema_version" in fingerprint.model_fields_set:
            return with_roles(fingerprint)
    except (ValidationError, ShaftprintError):
        # of another schema, or wrong: what follows says which
        pass
    try:
        text = document.decode()
        content = json.loads(text)
    except (ValueError, RecursionError) as fault:
        raise FingerprintError(f"{named}: expected a fingerprint in JSON, found something else: {fault}.") from None
    return _fingerprint_of(text, content, named=named)


def _fingerprint_of(text: str, content: Any, *, named: str) -> LineFingerprint:
    """Return the fingerprint of a document, whatever it is of and whatever schema it states."""
    of_drive = is_of_a_drive(content)
    minor = None if of_drive else _minor_of(content, named)
    schema = DRIVE_SCHEMA if of_drive else SCHEMA_VERSION
    try:
        if of_drive:
            return DriveFingerprint.model_validate_json(text)
        if minor is None or minor < MINOR:
            return with_roles(of_earlier_schema(text))
        return with_roles(of_later_schema(text) if minor > MINOR else Fingerprint.model_validate_json(text))
    except ValidationError as error:
        raise FingerprintError(f"{named} is not a fingerprint of schema {schema}: {faults(error)}.") from None
    except ShaftprintError as error:
        # what other rooms ask of their own nouns, such as a prior
        raise FingerprintError(f"{named} is not a fingerprint of schema {schema}: {error}") from None


def _minor_of(content: Any, named: str) -> int | None:
    """Return N of schema 2.N of a document that claims to be a fingerprint; None for schema 1."""
    schema = content.get("schema_version") if isinstance(content, dict) else None
    if schema is None:
        raise FingerprintError(f"{named}: expected a fingerprint, found JSON without a schema_version.")
    second = _SCHEMA_2.fullmatch(schema) if isinstance(schema, str) else None
    if second is None and (type(schema) is not int or schema != 1):
        raise FingerprintError(
            f"{named}: expected a fingerprint of schema 1 or 2, found schema {schema}; read it with the version of "
            "shaftprint that wrote it, or a newer one."
        )
    return None if second is None else int(second[1])
