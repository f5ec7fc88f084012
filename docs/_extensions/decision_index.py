"""The index of the decisions: by room, what holds today, from the head of each file in docs/decisions/.

A head is three paragraphs below the title: what the decision does to others and they to it, its rooms, the first of
them the one where it is listed, and what holds. Who changes a decision with a later one rewrites what the older holds,
and says so there: ``**Holds, with 56, 62.**``.
"""

import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from room_diagram import ROOT, in_order

FOLDER = ROOT / "docs" / "decisions"
LINK = re.compile(r"\[decision (\d+)\]\((\d{4}-[\w-]+\.md)\)")
PAIRS = {"Changes": "Changed by", "Replaces": "Replaced by", "Changed by": "Changes", "Replaced by": "Replaces"}
"""What a decision does to another, and what that one says of it."""
LINKS = rf"{LINK.pattern}(?:, {LINK.pattern})*\."
STATUS = re.compile(rf"(?:Accepted, \w+ \d{{4}}\.|Replaced by {LINKS})(?: (?:Follows|{'|'.join(PAIRS)}) {LINKS})*")
NO_ROOMS = {"house": "The house", "docs": "These pages"}
"""What belongs to no room, with its heading."""


@dataclass(frozen=True)
class Decision:
    """The head of one file."""

    path: Path
    number: int
    title: str
    status: str
    """What it does to others and they to it, on one line."""
    rooms: tuple[str, ...]
    """Rooms and leaf modules; it is listed under the first."""
    holds_with: tuple[int, ...]
    """Later decisions that what holds takes in."""
    holds: str
    """What holds today; nothing of a decision that was replaced."""

    def touched(self, verb: str) -> tuple[int, ...]:
        """Return the numbers of the decisions to which a verb of the status belongs."""
        found = re.search(rf"(?:^|\. ){verb} ({LINKS})", self.status)
        return tuple(int(number) for number, _ in LINK.findall(found[1])) if found else ()


def head(path: Path) -> Decision:
    """Return the head of a file.

    Raises
    ------
    ValueError
        If it has another form.
    """
    title, status, rooms, holds, *_ = (
        " ".join(part.split()) for part in path.read_text(encoding="utf-8").split("\n\n", 5)
    )
    named = re.fullmatch(r"# (\d+)\. (.+)", title)
    if not named or not STATUS.fullmatch(status) or not re.fullmatch(r"\*\*Rooms\.\*\* `\w+`(, `\w+`)*", rooms):
        raise ValueError(f"{path.name}: expected '# N. Title', 'Accepted, Month Year. ...' and '**Rooms.** `room`'")
    stated = re.fullmatch(r"\*\*Holds(?:, with ([\d, ]+))?\.\*\* (.+)", holds)
    if bool(stated) == status.startswith("Replaced by"):
        raise ValueError(f"{path.name}: expected '**Holds.** ...' below the rooms, unless another took its place")
    return Decision(
        path=path,
        number=int(named[1]),
        title=named[2],
        status=status,
        rooms=tuple(re.findall(r"`(\w+)`", rooms)),
        holds_with=tuple(map(int, (stated[1] or "").split(", "))) if stated and stated[1] else (),
        holds=stated[2] if stated else "",
    )


@cache
def decisions() -> tuple[Decision, ...]:
    """Return the heads of all files, by number."""
    return tuple(head(path) for path in sorted(FOLDER.glob("*.md")))


def index() -> str:
    """Return the decisions that hold, under the rooms in the order of the data."""
    order = [*NO_ROOMS, *in_order()]
    parts = []
    for room in order:
        own = [one for one in decisions() if one.rooms[0] == room and one.holds]
        more = [one for one in decisions() if room in one.rooms[1:] and one.holds]
        if own or more:
            parts.append(f"## {NO_ROOMS.get(room, room)}")
        if own:
            rows = [f"| {_link(one)} | {one.title} | {one.holds} |" for one in own]
            parts.append("\n".join(["| | decision | what holds today |", "|---|---|---|", *rows]))
        if more:
            parts.append(f"{'Also' if own else 'See'} {', '.join(map(_link, more))}.")
    return "\n\n".join(parts)


def _link(one: Decision) -> str:
    return f"[{one.number}](decisions/{one.path.name})"
