"""What the server keeps beside the store: findings that need not be calculated twice, uploads, and what is being made.

Nothing in it is the only copy of a result, but for the list of uploads, and the file of each lies beside it.
"""

import json
import sqlite3
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final, Literal, Self, TypeAlias

from shaftprint.errors import ServerError
from shaftprint.files import private_file

MakingState: TypeAlias = Literal["waiting", "done", "refused"]
MOST_CLASSES: Final = 500
"""Classes of which the answer is kept: the same one as people see it who see other ships of it counts anew."""
_TABLES: Final = """
create table if not exists finding(line text primary key, state text not null, summary text not null, content text not null);
create table if not exists class_finding(lines text primary key, state text not null, content text not null);
create table if not exists upload(id text primary key, imo integer, ship text not null, line text not null,
  name text not null, size integer not null, sha256 text not null, person text not null, at text not null);
create table if not exists making(key text primary key, kind text not null, args text not null, state text not null,
  sentence text not null);
create table if not exists job(id integer primary key, imo integer, ship text not null, line text not null,
  name text not null, person text not null, at text not null, args text not null);
create table if not exists told(line text not null, way text not null, mark text not null, at text not null,
  primary key(line, way));
create table if not exists ended(session text primary key, at text not null);
"""  # noqa: E501
_JOBS: Final = "select id, imo, ship, line, name, person, at, args from job"


@dataclass(frozen=True, kw_only=True, slots=True)
class Upload:
    """A file that somebody has uploaded for a line."""

    id: str
    """What it is called in an address."""
    imo: int | None
    """IMO number of the ship."""
    ship: str
    """Name of the ship."""
    line: str
    """Shaft line."""
    name: str
    """Name of the file."""
    size: int
    """Its bytes."""
    sha256: str
    """Its SHA-256."""
    person: str
    """Who uploaded it."""
    at: str
    """When, in UTC."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Making:
    """Something that a process of the server makes of a user's file: a look at a recording, a report."""

    key: str
    """What it is known by."""
    kind: str
    """What is made."""
    args: dict[str, Any]
    """Of what."""
    state: MakingState
    """Where it stands."""
    sentence: str
    """Why it was refused."""


@dataclass(frozen=True, kw_only=True, slots=True)
class KeptJob:
    """For which line a job of the ledger was asked, and by whom."""

    id: int
    """Number of the job."""
    imo: int | None
    """IMO number of the ship."""
    ship: str
    """Name of the ship."""
    line: str
    """Shaft line."""
    name: str
    """Name of the recording."""
    person: str
    """Who asked for it."""
    at: str
    """When, in UTC."""
    args: dict[str, Any]
    """What it works on."""


@dataclass(slots=True)
class Kept:
    """The server's own file."""

    path: Path
    """Where it is."""
    _connection: sqlite3.Connection
    _lock: threading.Lock = field(default_factory=threading.Lock)

    @classmethod
    def at(cls, path: Path) -> Self:
        """Return the file, made where it is not there.

        Raises ServerError if it cannot be used.
        """
        try:
            # sessions that were ended stand in it; what lies beside it is as private as it is
            connection = sqlite3.connect(
                private_file(path), check_same_thread=False, isolation_level=None, timeout=30.0
            )
            connection.execute("pragma journal_mode=wal")
            connection.executescript(_TABLES)
        except (sqlite3.Error, OSError) as fault:
            raise ServerError(f"{path}: the server's own file cannot be used: {fault}; move it away.") from None
        return cls(path=path, _connection=connection)

    def close(self) -> None:
        """Close the file."""
        self._connection.close()

    @contextmanager
    def _rows(self, query: str, *values: object) -> Iterator[list[Any]]:
        with self._lock:
            rows = self._connection.execute(query, values).fetchall()
        yield rows

    def _write(self, query: str, *values: object) -> None:
        with self._lock:
            self._connection.execute(query, values)

    def summaries(self) -> dict[str, tuple[str, dict[str, Any]]]:
        """Return what a list shows of each line: the state of its records then, and what was found."""
        with self._rows("select line, state, summary from finding") as rows:
            return {line: (state, json.loads(summary)) for line, state, summary in rows}

    def finding(self, line: str) -> tuple[str, dict[str, Any]] | None:
        """Return all that was found of a line, and the state of its records then."""
        with self._rows("select state, content from finding where line = ?", line) as rows:
            return (rows[0][0], json.loads(rows[0][1])) if rows else None

    def put_finding(self, line: str, state: str, summary: dict[str, Any], content: dict[str, Any]) -> None:
        """Keep what was found of a line."""
        row = (line, state, json.dumps(summary), json.dumps(content))
        self._write("insert or replace into finding values(?, ?, ?, ?)", *row)

    def class_finding(self, lines: str, state: str) -> dict[str, Any] | None:
        """Return what some lines said about each other in the state in which they are; None where that is not kept."""
        with self._rows("select content from class_finding where lines = ? and state = ?", lines, state) as rows:
            return json.loads(rows[0][0]) if rows else None

    def put_class_finding(self, lines: str, state: str, content: dict[str, Any]) -> None:
        """Keep what some lines said about each other; what was found before of as many others is forgotten."""
        self._write("insert or replace into class_finding values(?, ?, ?)", lines, state, json.dumps(content))
        last = "select rowid from class_finding order by rowid desc limit ?"
        self._write(f"delete from class_finding where rowid not in ({last})", MOST_CLASSES)  # noqa: S608

    def uploads(self) -> tuple[Upload, ...]:
        """Return all uploads, the newest first."""
        with self._rows(
            "select id, imo, ship, line, name, size, sha256, person, at from upload order by at desc"
        ) as rows:
            names = Upload.__slots__
            return tuple(Upload(**dict(zip(names, row, strict=True))) for row in rows)

    def upload(self, number: str) -> Upload | None:
        """Return an upload; None where there is none."""
        return next((one for one in self.uploads() if one.id == number), None)

    def put_upload(self, one: Upload) -> None:
        """Keep that a file was uploaded."""
        row = [getattr(one, name) for name in Upload.__slots__]
        self._write("insert into upload values(?, ?, ?, ?, ?, ?, ?, ?, ?)", *row)

    def jobs(self) -> dict[int, KeptJob]:
        """Return what is known of the jobs that were asked for here, by their numbers."""
        with self._rows(_JOBS) as rows:
            return {row[0]: _job(row) for row in rows}

    def job(self, number: int) -> KeptJob | None:
        """Return what is known of a job; None where it was not asked for here."""
        with self._rows(f"{_JOBS} where id = ?", number) as rows:
            return _job(rows[0]) if rows else None

    def put_job(self, one: KeptJob) -> None:
        """Keep for which line a job was asked, and who asked for it last."""
        row = [one.id, one.imo, one.ship, one.line, one.name, one.person, one.at, json.dumps(one.args)]
        self._write("insert or replace into job values(?, ?, ?, ?, ?, ?, ?, ?)", *row)

    def give_number(self, ship: str, imo: int) -> None:
        """Let uploads and jobs of a ship that had no IMO number be of the ship that has one now."""
        for table in ("upload", "job"):
            self._write(f"update {table} set imo = ? where imo is null and ship = ?", imo, ship)  # noqa: S608

    def makings(self, state: MakingState) -> tuple[Making, ...]:
        """Return what is in a state, in the order in which it was asked for."""
        with self._rows("select * from making where state = ? order by rowid", state) as rows:
            return tuple(_making(row) for row in rows)

    def making(self, key: str) -> Making | None:
        """Return where something that is made stands; None where nobody asked for it."""
        with self._rows("select * from making where key = ?", key) as rows:
            return _making(rows[0]) if rows else None

    def put_making(self, one: Making) -> None:
        """Keep where something that is made stands."""
        row = (one.key, one.kind, json.dumps(one.args), one.state, one.sentence)
        self._write("insert or replace into making values(?, ?, ?, ?, ?)", *row)

    def told(self, way: str) -> dict[str, str]:
        """Return which change of each line was told in a way, by the line."""
        with self._rows("select line, mark from told where way = ?", way) as rows:
            return dict(rows)

    def put_told(self, line: str, way: str, mark: str, at: str) -> None:
        """Keep that a change of a line was told."""
        self._write("insert or replace into told values(?, ?, ?, ?)", line, way, mark, at)

    def forget_told(self, line: str, way: str) -> None:
        """Forget what was told of a line: it is not changed any more."""
        self._write("delete from told where line = ? and way = ?", line, way)

    def ended(self) -> dict[str, None]:
        """Return the sessions that were ended."""
        with self._rows("select session from ended") as rows:
            return dict.fromkeys(row[0] for row in rows)

    def put_ended(self, session: str, at: str, *, forget_before: str) -> None:
        """Keep that a session was ended; those that are too old by themselves are forgotten."""
        self._write("insert or replace into ended values(?, ?)", session, at)
        self._write("delete from ended where at < ?", forget_before)


def _job(row: Any) -> KeptJob:
    return KeptJob(**dict(zip(KeptJob.__slots__, (*row[:-1], json.loads(row[-1])), strict=True)))


def _making(row: Any) -> Making:
    key, kind, args, state, sentence = row
    return Making(key=key, kind=kind, args=json.loads(args), state=state, sentence=sentence)
