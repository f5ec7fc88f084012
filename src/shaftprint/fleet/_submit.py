"""Recordings are put into the ledger: each under the SHA-256 of all that its fingerprint depends on."""

import hashlib
import json
from collections.abc import Sequence
from datetime import datetime
from importlib.resources import files
from pathlib import Path
from typing import Literal

from shaftprint import __version__
from shaftprint.arguments import refusing_none
from shaftprint.campaign._campaign import load_campaign
from shaftprint.catalogue._shipped import shipped_structure
from shaftprint.errors import SettingsError, StoreError
from shaftprint.fleet._arguments import JobArguments
from shaftprint.settings import settings_content
from shaftprint.store._hashes import file_hashes
from shaftprint.store._job import Job, JobRequest
from shaftprint.store._ledger import enqueue
from shaftprint.store._store import Store
from shaftprint.vessel._vessel import load_vessel
from shaftprint.zones import possible

KIND = "identify"


@refusing_none(StoreError)
def submit(store: Store, recordings: Sequence[JobArguments], *, now: datetime) -> tuple[Job, ...]:
    """Ask for the fingerprints of recordings, and return the job of each; what was asked for before is not done again.

    Parameters
    ----------
    store
        The store whose ledger takes the jobs.
    recordings
        What is to be identified.
    now
        The present time, with its zone.

    Raises
    ------
    StructureError
        If there is no such structure.
    SettingsError
        If a vessel or campaign file cannot be used; then nothing is asked for.
    RecordingError
        If a recording cannot be read; likewise.
    """
    for one in recordings:
        _expect_possible(one, now)
    for name in {one.structure for one in recordings if one.structure is not None}:
        shipped_structure(name)
    vessels = {name: _vessel_sha256(name) for name in {one.vessel for one in recordings}}
    campaigns = {name: _campaign_sha256(name) for name in {one.campaign for one in recordings}}
    hashes = file_hashes(store, [Path(one.recording) for one in recordings], now=now)
    with_hashes = [
        one.model_copy(
            update={"sha256": {"recording": sha256, "vessel": vessels[one.vessel], "campaign": campaigns[one.campaign]}}
        )
        for one, sha256 in zip(recordings, hashes, strict=True)
    ]
    return enqueue(store, [request_of(one) for one in with_hashes])


def _expect_possible(arguments: JobArguments, now: datetime) -> None:
    """Refuse a time here that the store would refuse when all is calculated."""
    stated = arguments.conditions.tested_at
    try:
        if stated is not None:
            possible(stated, now=now)
    except ValueError as error:
        raise SettingsError(f"{arguments.recording}: tested_at: {error}.") from None


def request_of(arguments: JobArguments) -> JobRequest:
    """Return the job of a recording whose hashes are known."""
    settings = arguments.settings()
    depends_on = {"kind": KIND, "sha256": arguments.sha256, "settings": settings, "version": __version__}
    key = hashlib.sha256(json.dumps(depends_on, sort_keys=True).encode()).hexdigest()
    files_of_it = {name: getattr(arguments, name) for name in ("recording", "vessel", "campaign", "sha256")}
    return JobRequest(key=key, kind=KIND, args=settings | files_of_it, version=__version__)


def _vessel_sha256(name: str) -> str:
    load_vessel(name)
    return _sha256("vessel", name)


def _campaign_sha256(name: str) -> str:
    load_campaign(name)
    return _sha256("campaign", name)


def _sha256(kind: Literal["vessel", "campaign"], name: str) -> str:
    content = settings_content(name, shipped=files(f"shaftprint.{kind}") / "shipped")
    return hashlib.sha256(content).hexdigest()
