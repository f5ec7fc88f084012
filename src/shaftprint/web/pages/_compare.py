"""Two tests of one line beside each other."""

from starlette.exceptions import HTTPException

from shaftprint.web._asked import Asked, Moved, Shown
from shaftprint.web.pages._fingerprint import fingerprint_of
from shaftprint.zones import utc_text

LONGEST_S = 60.0
_HEADLINES = {
    "changed": ("The ship has changed by more than chance", "look"),
    "unchanged": ("No change is seen", "fine"),
    "cannot be told": ("It cannot be told", "open"),
}


async def compare(asked: Asked) -> Shown | Moved:
    """Return what differs between two tests."""
    first, other = [await asked.read(fingerprint_of, asked, asked.query(name)) for name in ("a", "b")]
    if first.line != other.line:
        raise HTTPException(400, "Expected two tests of one shaft line, found two of different lines.")
    if first.trial.tested_at > other.trial.tested_at:
        first, other = other, first
    names = [utc_text(one.trial.tested_at)[:16] for one in (first, other)]
    if names[0] == names[1]:
        names = [f"{name} {one.sha256[:12]}" for name, one in zip(names, (first, other), strict=True)]
    question = {"kind": "compare", "first": first.sha256, "other": other.sha256, "names": names}
    found = await asked.service.desk.ask(question, longest_s=LONGEST_S)
    headline, look = _HEADLINES[found["word"]]
    if found["not_trustworthy"]:
        headline, look = "These tests cannot be compared: not all of them are trustworthy", "bad"
    line = {"name": first.line.ship.name, "imo": first.line.ship.imo_number}
    data = {"headline": headline, "look": look, "a": first.sha256, "b": other.sha256, "names": names, **found}
    return Shown(
        template="compare.html.j2",
        title=f"{names[1][:10]} against {names[0][:10]}",
        data=data | {"ship": line, "line": first.line.position},
    )
