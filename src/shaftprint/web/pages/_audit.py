"""Who did what: for owners, as far as it is about their ships."""

from typing import Any, Final

from shaftprint.store import Ship
from shaftprint.web._asked import Asked, Shown

MOST: Final = 200


async def audit(asked: Asked) -> Shown:
    """Return the newest deeds."""
    deeds = await asked.read(_deeds, asked)
    return Shown(template="audit.html.j2", title="Who did what", data={"deeds": deeds})


def _deeds(asked: Asked) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = []
    for one in asked.service.audit.newest():
        if len(found) == MOST:
            break
        if _may_see(asked, one):
            found.append(one)
    return found


def _may_see(asked: Asked, deed: dict[str, Any]) -> bool:
    if asked.person.sees_all or deed.get("person") == asked.person.name:
        return True
    name, imo = deed.get("ship"), deed.get("imo")
    if not isinstance(name, str):
        return False
    return asked.person.sees(Ship(name=name, imo_number=imo if isinstance(imo, int) else None))
