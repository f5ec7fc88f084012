"""The first page: every line that somebody sees, with a word for each, those that need somebody first."""

from dataclasses import dataclass
from typing import Any, Final
from urllib.parse import quote

from shaftprint.store._overview import LineNow
from shaftprint.web._asked import Asked, Shown, line_address, line_key
from shaftprint.web._standing import WORDS, Look, Standing, standing_of

MOST_ROWS: Final = 100
"""Lines on one page."""
MOST_IN_FILE: Final = 5_000
"""Lines in one file."""


async def ships(asked: Asked) -> Shown:
    """Return the ships with a word for each."""
    return await asked.read(_ships, asked)


@dataclass(frozen=True, kw_only=True, slots=True)
class _Row:
    line: LineNow
    standing: Standing


def _ships(asked: Asked) -> Shown:
    rows = rows_of(asked)
    counts = _counts(rows)
    kind, sought = asked.query("kind"), asked.query("q").strip()
    chosen = [row for row in rows if (not kind or _is_of(row, kind)) and _matches(row.line, sought)]
    # a file of the table has all of them
    most = MOST_IN_FILE if asked.query("as") else MOST_ROWS
    pages = max(1, -(-len(chosen) // most))
    page = min(max(1, int(text) if (text := asked.query("page", "1")).isdecimal() and len(text) < 7 else 1), pages)
    shown = chosen[(page - 1) * most : page * most]
    return Shown(
        template="ships.html.j2",
        title="Ships",
        data={
            "headline": headline_of(rows),
            "lines": [content_of(row) for row in shown],
            "counts": {word: count for word, count in counts.items() if count},
            "found": len(chosen),
            "page": page,
            "pages": pages,
        },
        drawn={
            "kind": kind,
            "q": sought,
            "all": len(rows),
            "look": look_of(rows),
            "links": {
                "previous": _link(kind, sought, page - 1) if page > 1 else "",
                "next": _link(kind, sought, page + 1) if page < pages else "",
            },
        },
    )


def rows_of(asked: Asked) -> list[_Row]:
    """Return the lines that somebody sees, each with how it stands.

    Those that need somebody come first, among them the clearest change, then the newest test.
    """
    found, now = asked.service.kept.summaries(), asked.service.now()
    overdue = asked.service.serving.overdue_days
    rows = [
        _Row(
            line=one,
            standing=standing_of(
                one, found.get(line_key(one.line.ship, one.line.position)), now=now, overdue_days=overdue
            ),
        )
        for one in asked.service.lines.now()
        if asked.person.sees(one.line.ship)
    ]
    return sorted(
        rows,
        key=lambda row: (
            WORDS.index(row.standing.kind),
            -row.standing.clearness,
            -(row.line.tested_at or now).timestamp(),
        ),
    )


def _counts(rows: list[_Row]) -> dict[str, int]:
    return {word: sum(_is_of(row, word) for row in rows) for word in WORDS}


def _is_of(row: _Row, word: str) -> bool:
    """Return whether a line stands so: a test that is overdue is told beside what else is said."""
    return row.standing.kind == word or (word == "test overdue" and row.standing.overdue)


def look_of(rows: list[_Row]) -> Look:
    """Return how a page sets what is said of all lines together."""
    counts = _counts(rows)
    if counts["not trustworthy"]:
        return "bad"
    if counts["changed"] or counts["test overdue"]:
        return "look"
    return "fine" if counts["unchanged"] else "open"


def headline_of(rows: list[_Row]) -> str:
    """Return how all lines stand, in one sentence."""
    counts, lines = _counts(rows), len(rows)
    if not lines:
        return "No ship is here yet"
    said = {
        "changed": "changed",
        "not trustworthy": "without a trustworthy newest test",
        "test overdue": "with a test overdue",
        "worn as expected": "worn as expected",
        "being judged": "being judged",
    }
    parts = [f"{counts[word]} {words}" for word, words in said.items() if counts[word]]
    if not counts["changed"] and not counts["not trustworthy"] and not counts["test overdue"]:
        parts = [f"{counts['unchanged']} unchanged", *parts] if parts and counts["unchanged"] else parts
    if not parts:
        open_ones = lines - counts["unchanged"]
        return f"{counts['unchanged']} of {_lines(lines)} unchanged" + (f", {open_ones} not known" if open_ones else "")
    return f"{_lines(lines)}: " + ", ".join(parts)


def _lines(count: int) -> str:
    return f"{count} shaft line" + ("" if count == 1 else "s")


def _matches(line: LineNow, sought: str) -> bool:
    ship = line.line.ship
    words = f"{ship.name} {ship.imo_number or ''} {ship.class_name or ''} {line.line.position}".lower()
    return all(part in words for part in sought.lower().split())


def content_of(row: _Row) -> dict[str, Any]:
    """Return a line and how it stands, for JSON."""
    ship, line, standing = row.line.line.ship, row.line, row.standing
    return {
        "ship": ship.name,
        "imo": ship.imo_number,
        "class": ship.class_name,
        "line": line.line.position,
        "address": line_address(line.line, line.ship_id),
        "kind": standing.kind,
        "word": standing.word,
        "look": standing.look,
        "note": standing.note,
        "overdue": standing.overdue,
        "tests": line.tests,
        "tested_at": None if line.tested_at is None else line.tested_at.isoformat(),
    }


def _link(kind: str, sought: str, page: int) -> str:
    return f"/?kind={quote(kind)}&q={quote(sought)}&page={page}"
