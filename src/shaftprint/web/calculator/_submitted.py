"""A job is asked for: the settings are read, and the ship of which they speak is the one that was given."""

import os
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from shaftprint.errors import ServerError
from shaftprint.fleet._arguments import job_arguments
from shaftprint.fleet._submit import submit
from shaftprint.store._store import open_store
from shaftprint.vessel._vessel import load_vessel


def submitted(
    recording: str,
    vessel: str,
    campaign: str,
    structure: str | None,
    ship: str,
    imo: int | None,
    line: str,
    facts: dict[str, Any],
) -> dict[str, Any]:
    """Put a recording into the ledger, and return its job.

    ``recording``: path of the recording. ``vessel``, ``campaign``: paths, or names of files that come with the program.
    ``structure``: name of a structure that comes with the program; that of vessel and campaign where there is none.
    ``ship``, ``imo``, ``line``: which line it is of. ``facts``: when, where and in what water it was tested. Raises
    ServerError if the vessel file speaks of another ship or line: its fingerprint would be kept there.
    """
    stated = _stated(vessel, ship, imo, line)
    # a path begins a file, a name one of those that come with the program
    files = [Path(one) if "/" in one or os.sep in one else one for one in (vessel, campaign)]
    facts = stated | facts | {"only": {"ship": ship, "imo": imo, "line": line}}
    arguments = job_arguments(recording, files[0], files[1], named="the form", structure=structure, **facts)
    with open_store(os.environ["SHAFTPRINT_STORE"]) as store:
        (job,) = submit(store, [arguments], now=datetime.now(UTC))
    return {"job": job.id, "args": dict(job.args)}


def _stated(vessel: str, ship: str, imo: int | None, line: str) -> dict[str, Any]:
    said = load_vessel(vessel).ship
    if said is None:
        return {"ship": ship, "imo": imo, "line": line}
    is_same = said.imo_number == imo if said.imo_number is not None else said.name == ship
    if not is_same or said.line != line:
        raise ServerError(
            f"vessel file: expected that of {ship}, {line}, found that of {said.name}, {said.line}; choose the file of "
            "this line, or this line's page."
        )
    # what the file says itself need not be stated, and a ship may have another name by now
    return {"ship": None, "imo": imo, "line": None}
