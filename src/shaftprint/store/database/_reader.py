"""What is read from a store, all at one instant."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import sqlalchemy as sa

from shaftprint.errors import StoreError
from shaftprint.store._nouns import Event, HistoryEntry, Line, LineSummary, Ship, StoredFingerprint, StoredNumber
from shaftprint.store.database._rows import (
    TRIAL_COLUMNS,
    WITHDRAWN,
    event_of_row,
    fingerprint_of_row,
    number_of_row,
    quantity_of_row,
    ship_of_row,
)
from shaftprint.store.database._tables import DOCUMENT, EVENT, FINGERPRINT, LINE, QUANTITY, SHIP, TRIAL, VALUE

_AT_A_TIME = 100
_EARLIER = FINGERPRINT.alias("earlier")
_LATER = FINGERPRINT.alias("later")
# a truth value as the driver gives it: thousands of rows a history would each be taken through a conversion
_VALUE_COLUMNS = (VALUE.c.value, VALUE.c.std, VALUE.c.low, VALUE.c.high, sa.type_coerce(VALUE.c.trusted, sa.Integer))


@dataclass(frozen=True, kw_only=True, slots=True)
class ShipRow:
    """A ship with its number in this database."""

    id: int
    """Its number here."""
    ship: Ship
    """The ship."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Reader:
    """A connection that sees a store as it is at one instant."""

    connection: sa.Connection
    """The connection."""

    def ships(self, *, imo_number: int | None = None, name: str | None = None) -> list[ShipRow]:
        """Return all ships, or those of a number or a name, by IMO number and name."""
        query = sa.select(SHIP.c.id, SHIP.c.imo, SHIP.c.name, SHIP.c.class_of)
        if imo_number is not None:
            query = query.where(SHIP.c.imo == imo_number)
        if name is not None:
            query = query.where(SHIP.c.name == name)
        rows = self.connection.execute(query).all()
        found = [ShipRow(id=row.id, ship=ship_of_row(row)) for row in rows]
        # here, for databases put letters in different orders
        return sorted(found, key=lambda one: (one.ship.imo_number or 0, one.ship.name))

    def lines(self, ships: Sequence[ShipRow]) -> dict[int, Line]:
        """Return the lines of ships by their number here, in the order of the ships."""
        ship_of = {one.id: one.ship for one in ships}
        query = sa.select(LINE.c.id, LINE.c.ship_id, LINE.c.position)
        if len(ships) == 1:
            query = query.where(LINE.c.ship_id == ships[0].id)
        rows = [row for row in self.connection.execute(query).all() if row.ship_id in ship_of]
        order = {one.id: place for place, one in enumerate(ships)}
        rows.sort(key=lambda row: (order[row.ship_id], row.position))
        return {row.id: Line(ship=ship_of[row.ship_id], position=row.position) for row in rows}

    def fingerprints(self, lines: Mapping[int, Line], *, superseded: bool) -> dict[int, StoredFingerprint]:
        """Return the fingerprints of lines by their number here, in the order of time.

        ``lines``: the lines. ``superseded``: whether those come too whose place another one has taken.
        """
        query = (
            sa.select(
                FINGERPRINT,
                *TRIAL_COLUMNS,
                TRIAL.c.line_id,
                _EARLIER.c.sha256.label("supersedes_sha256"),
                _LATER.c.id.label("successor"),
            )
            .join(TRIAL, TRIAL.c.id == FINGERPRINT.c.trial_id)
            .outerjoin(_EARLIER, _EARLIER.c.id == FINGERPRINT.c.supersedes)
            .outerjoin(_LATER, _LATER.c.supersedes == FINGERPRINT.c.id)
            .where(TRIAL.c.line_id.in_(list(lines)))
            .order_by(TRIAL.c.tested_at, TRIAL.c.id, FINGERPRINT.c.made_at, FINGERPRINT.c.id)
        )
        if not superseded:
            query = query.where(_LATER.c.id.is_(None))
        rows = self.connection.execute(query).all()
        return {row.id: fingerprint_of_row(row, lines[row.line_id]) for row in rows}

    def entries(
        self, lines: Mapping[int, Line], *, number: str | None = None, superseded: bool = False
    ) -> list[HistoryEntry]:
        """Return the tests of lines with their numbers, in the order of time.

        ``lines``: the lines. ``number``: name of the number that is wanted; None for all. ``superseded``: whether those
        come too whose place another one has taken.
        """
        found = self.fingerprints(lines, superseded=superseded)
        quantities = self._quantities(number)
        query = (
            sa.select(VALUE.c.fingerprint_id, VALUE.c.quantity_id, *_VALUE_COLUMNS)
            .where(
                VALUE.c.fingerprint_id.in_(
                    sa.select(FINGERPRINT.c.id)
                    .join(TRIAL, TRIAL.c.id == FINGERPRINT.c.trial_id)
                    .where(TRIAL.c.line_id.in_(list(lines)))
                )
            )
            .order_by(VALUE.c.fingerprint_id, VALUE.c.quantity_id)
        )
        if number is not None:
            query = query.where(VALUE.c.quantity_id.in_(list(quantities)))
        numbers: dict[int, list[StoredNumber]] = {one: [] for one in found}
        for fingerprint_id, quantity_id, *row in self.connection.execute(query).all():
            if fingerprint_id in numbers:
                numbers[fingerprint_id].append(number_of_row(quantities.get(quantity_id), row))
        return [HistoryEntry(fingerprint=one, numbers=tuple(numbers[key])) for key, one in found.items()]

    def events(self, lines: Mapping[int, Line]) -> list[Event]:
        """Return what was done to lines, in the order of time; what was withdrawn too, with the reason."""
        query = sa.select(EVENT).where(EVENT.c.line_id.in_(list(lines))).order_by(EVENT.c.at, EVENT.c.kind)
        rows = self.connection.execute(query).all()
        why = {
            (row.line_id, row.at, row.kind.removeprefix(WITHDRAWN)): row.note
            for row in rows
            if str(row.kind).startswith(WITHDRAWN)
        }
        return [
            event_of_row(row, lines[row.line_id], withdrawn=why.get((row.line_id, row.at, row.kind)))
            for row in rows
            if not str(row.kind).startswith(WITHDRAWN)
        ]

    def summaries(self, *, number: str | None = None) -> list[LineSummary]:
        """Return every line with its newest test, and a number of that test by its name."""
        lines = self.lines(self.ships())
        counting = sa.select(TRIAL.c.line_id, sa.func.count()).group_by(TRIAL.c.line_id)
        counts: dict[int, int] = {row[0]: row[1] for row in self.connection.execute(counting).all()}
        tests = {row.line_id: row for row in self.connection.execute(_newest()).all()}
        numbers = {} if number is None else self._newest_number(number)
        return [
            LineSummary(
                line=line,
                tests=counts.get(key, 0),
                tested_at=row.tested_at if (row := tests.get(key)) is not None else None,
                trustworthy=None if row is None else bool(row.trustworthy),
                number=numbers.get(key),
            )
            for key, line in lines.items()
        ]

    def _newest_number(self, name: str) -> dict[int, StoredNumber]:
        """Return a number of the newest test of every line; of several kinds of that name the first that was kept."""
        quantities = self._quantities(name)
        query = _newest().join(VALUE, VALUE.c.fingerprint_id == FINGERPRINT.c.id)
        query = query.where(VALUE.c.quantity_id.in_(list(quantities)))
        query = query.with_only_columns(LINE.c.id, VALUE.c.quantity_id, *_VALUE_COLUMNS).order_by(VALUE.c.quantity_id)
        found: dict[int, StoredNumber] = {}
        for row in self.connection.execute(query).all():
            found.setdefault(row[0], number_of_row(quantities.get(row[1]), row[2:]))
        return found

    def _quantities(self, name: str | None) -> dict[int, tuple[str, str, str]]:
        """Return kind, name and unit of quantities by their number: of all, or of those of a name.

        They are looked up by themselves: joined, some planners would read every value for them.
        """
        query = sa.select(QUANTITY.c.id, QUANTITY.c.kind, QUANTITY.c.name, QUANTITY.c.unit)
        if name is not None:
            query = query.where(QUANTITY.c.name == name)
        return {row.id: quantity_of_row(row) for row in self.connection.execute(query).all()}

    def stated(self, fingerprints: Sequence[int]) -> dict[int, str]:
        """Return what was stated by hand of fingerprints, as JSON."""
        query = sa.select(FINGERPRINT.c.id, FINGERPRINT.c.stated).where(FINGERPRINT.c.id.in_(fingerprints))
        return {row[0]: row[1] for row in self.connection.execute(query)}

    def count(self) -> int:
        """Return how many fingerprints there are, whatever they belong to."""
        return self.connection.execute(sa.select(sa.func.count()).select_from(FINGERPRINT)).scalar_one()

    def numbers(self, fingerprints: Sequence[int]) -> Iterator[list[StoredNumber] | None]:
        """Give the numbers of each fingerprint in their order, not all at once; None for those that are damaged."""
        quantities = self._quantities(None)
        for begin in range(0, len(fingerprints), _AT_A_TIME):
            some = fingerprints[begin : begin + _AT_A_TIME]
            query = sa.select(VALUE.c.fingerprint_id, VALUE.c.quantity_id, *_VALUE_COLUMNS)
            rows: dict[int, list[Any]] = {key: [] for key in some}
            for fingerprint_id, quantity_id, *row in self.connection.execute(
                query.where(VALUE.c.fingerprint_id.in_(some))
            ):
                rows[fingerprint_id].append((quantities.get(quantity_id), row))
            yield from (_numbers_of_rows(rows[key]) for key in some)

    def documents(self, fingerprints: Sequence[int]) -> Iterator[tuple[int, Any]]:
        """Give the compressed documents of fingerprints in their order, not all at once."""
        for begin in range(0, len(fingerprints), _AT_A_TIME):
            some = fingerprints[begin : begin + _AT_A_TIME]
            query = sa.select(DOCUMENT.c.fingerprint_id, DOCUMENT.c.content).where(DOCUMENT.c.fingerprint_id.in_(some))
            found = {row[0]: row[1] for row in self.connection.execute(query)}
            yield from ((key, found.get(key)) for key in some)

    def document(self, sha256: str) -> Any:
        """Return the compressed document with a SHA-256; None where there is none."""
        query = (
            sa.select(DOCUMENT.c.content)
            .join(FINGERPRINT, FINGERPRINT.c.id == DOCUMENT.c.fingerprint_id)
            .where(FINGERPRINT.c.sha256 == sha256)
        )
        return self.connection.execute(query).scalar()


def _numbers_of_rows(rows: Sequence[Any]) -> list[StoredNumber] | None:
    try:
        return [number_of_row(quantity, row) for quantity, row in rows]
    except StoreError:
        return None


def _newest() -> sa.Select[Any]:
    """Return the query for the newest test of every line: one look into an index for each, and no sorting of all."""
    newest = (
        sa.select(FINGERPRINT.c.id)
        .join(TRIAL, TRIAL.c.id == FINGERPRINT.c.trial_id)
        .where(TRIAL.c.line_id == LINE.c.id)
        .where(~sa.exists().where(_LATER.c.supersedes == FINGERPRINT.c.id))
        .order_by(TRIAL.c.tested_at.desc(), TRIAL.c.id.desc())
        .limit(1)
        .correlate(LINE)
        .scalar_subquery()
    )
    rows = LINE.join(FINGERPRINT, FINGERPRINT.c.id == newest).join(TRIAL, TRIAL.c.id == FINGERPRINT.c.trial_id)
    return sa.select(LINE.c.id.label("line_id"), TRIAL.c.tested_at, FINGERPRINT.c.trustworthy).select_from(rows)
