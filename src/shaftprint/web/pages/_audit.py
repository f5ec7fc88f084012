"""Who did what: for owners, as far as it is about their ships, of one kind where that is asked for."""

from typing import Any, Final

from shaftprint.store._nouns import Ship
from shaftprint.web._asked import Asked, Shown

MOST: Final = 200
REFUSED: Final = "refused sign-ins"
KINDS: Final = (
    "signed in",
    "signed out",
    "uploaded",
    "asked for a job",
    "tried a job again",
    "asked for a report",
    "noted an event",
    "withdrew an event",
    "gave an IMO number",
    REFUSED,
)
"""Kinds of deeds that may be asked for; without one all are shown but what was refused."""
_MOST_LOOKED_AT: Final = 100_000


async def audit(asked: Asked) -> Shown:
    """Return the newest deeds."""
    kind = asked.query("kind") if asked.query("kind") in KINDS else ""
    deeds = await asked.read(_deeds, asked, kind)
    data = {"deeds": deeds, "kind": kind}
    return Shown(template="audit.html.j2", title="Who did what", data=data, drawn={"kinds": KINDS})


def _deeds(asked: Asked, kind: str) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = []
    for place, one in enumerate(asked.service.audit.newest(refusals=kind == REFUSED)):
        if len(found) == MOST or place == _MOST_LOOKED_AT:
            break
        if kind in ("", REFUSED, one.get("deed")) and _may_see(asked, one):
            found.append(one)
    return found


def _may_see(asked: Asked, deed: dict[str, Any]) -> bool:
    if asked.person.sees_all or deed.get("person") == asked.person.name:
        return True
    name, imo = deed.get("ship"), deed.get("imo")
    if not isinstance(name, str):
        return False
    return asked.person.sees(Ship(name=name, imo_number=imo if isinstance(imo, int) else None))
