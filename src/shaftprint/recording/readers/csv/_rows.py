"""Rows of a text file to columns of numbers, block by block: compiled, and slowly where a row needs a look."""

import importlib
from collections import deque
from collections.abc import Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field
from itertools import chain
from pathlib import Path
from typing import IO, TypeAlias

import numpy as np

from shaftprint.arrays import FloatArray, IntArray
from shaftprint.errors import RecordingError
from shaftprint.escape import printable
from shaftprint.recording._spool import Spool
from shaftprint.recording.readers.csv._fields import is_gap, number, split_row
from shaftprint.recording.readers.csv._header import Header
from shaftprint.recording.readers.csv._marks import Marks
from shaftprint.recording.readers.csv._scope_export import END_OF_EXPORT
from shaftprint.recording.readers.csv._stamps import Stamps, is_stamp
from shaftprint.recording.readers.csv._wrong_rows import LONGEST, wrong_rows

LONGEST_LINE = 1_000_000
"""Characters of a line; one that is longer is none of text."""
_BLOCK = 2_000_000
# Shorter files are read sooner than a compiler is loaded.
_SHORT = 2_000_000
_AHEAD = 2
# Fields of a block that may be left to Python, beside half of them all.
_ODD = 1_000
# So many rows of a file may be damaged, and such a share: with times the others keep their places.
_MOST_DAMAGED, _DAMAGED_SHARE = 3, 1e-3
# What is behind the decimal sign is longer in each of so many rows, where a number of the last row is cut off.
_DECIMALS_SEEN, _TAIL = 50, 8_000
_LINE_FEED = ord("\n")
_UTF_8_MARK = b"\xef\xbb\xbf"

_Columns: TypeAlias = dict[int, "FloatArray | list[str]"]


@dataclass(slots=True)
class Unpacked:
    """What the rows of a file were."""

    count: int = 0
    """How many there are."""
    full: int = 0
    """How many there are to the last with a value: a sheet may end in rows of separators alone."""
    stamps: Stamps | None = None
    """Dates or times of day."""
    left_out: dict[str, str] = field(default_factory=dict)
    """Columns that hold words, with the first of them: they are not read to the end."""
    empty: list[str] = field(default_factory=list)
    """Columns without a value in any row."""
    filled: dict[str, int] = field(default_factory=dict)
    """How many rows have a value, by column."""
    remarks: list[str] = field(default_factory=list)
    """What else was left out, a sentence each."""
    titles_again: list[tuple[int, int]] = field(default_factory=list)
    """Line of every head that comes again, and how many rows are before it."""
    date_beside: str = ""
    """The first date beside times that are numbers."""
    invalid: dict[str, IntArray] = field(default_factory=dict)
    """Rows whose value does not count, by column."""


def unpack(path: Path, file: IO[bytes], header: Header, spool: Spool) -> Unpacked:
    """Put every row into the columns of a spool.

    ``path``: the file, for messages. ``file``: its text from the beginning on, in UTF-8 or another encoding that writes
    numbers as ASCII does. ``header``: how it is to be read. ``spool``: takes the columns, in the order of those of the
    header. Raises RecordingError if rows cannot be read, or no column of numbers is left.
    """
    for _ in range(header.lines):
        file.readline(LONGEST_LINE)
    return _Unpacking(path, header, spool).all_of(file)


@dataclass(frozen=True, kw_only=True, slots=True)
class _Block:
    """Lines of a file."""

    line: int
    """Number of the first."""
    text: bytes
    lines: int
    """How many there are."""
    is_end: bool = False
    """Whether it is a last line without an end."""


class _Unpacking:
    """Rows on their way into columns."""

    def __init__(self, path: Path, header: Header, spool: Spool) -> None:
        self.path, self.header, self.spool = path, header, spool
        self.done = Unpacked(stamps=Stamps(path, header) if header.dated else None)
        self.more = [Stamps(path, header, lead=self.done.stamps, places=places) for places in header.more_dates]
        self.done.filled = dict.fromkeys(header.names, 0)
        self.marks = [Marks() for _ in header.places]
        self.mistakes: list[tuple[int, list[str]]] = []
        self.damaged: list[int] = []
        self.nul = 0
        self.tail = b""
        self.is_fast = path.stat().st_size > _SHORT

    def all_of(self, file: IO[bytes]) -> Unpacked:
        """Read the rest of a file."""
        with ThreadPoolExecutor(_AHEAD) as pool:
            ahead: deque[tuple[_Block, Future[_Columns | None] | None]] = deque()
            for block in _blocks(self.path, file, self.header.lines + self.header.first_line):
                self.tail = self.tail if block.is_end else block.text[-_TAIL:]
                parsed = pool.submit(self._fast, block) if self.is_fast and not block.is_end else None
                ahead.append((block, parsed))
                if len(ahead) > _AHEAD:
                    self._take(*ahead.popleft())
            while ahead:
                self._take(*ahead.popleft())
        self.spool.finish()
        self._close()
        return self.done

    def _take(self, block: _Block, parsed: "Future[_Columns | None] | None") -> None:
        columns = None if parsed is None else parsed.result()
        if columns is None:
            columns = self._slow(block)
        # nothing but columns of words
        if not columns:
            return
        header, rows = self.header, len(next(iter(columns.values())))
        if self.done.stamps is not None and rows:
            try:
                seconds = {
                    place: stamps.seconds(columns)
                    for place, stamps in zip(
                        (header.places[header.time_column or 0], *(places[0] for places in header.more_dates)),
                        (self.done.stamps, *self.more),
                        strict=True,
                    )
                }
            except RecordingError:
                if parsed is None or parsed.result() is None:
                    raise
                # a row whose date is none: a second look leaves it out
                self._take(block, None)
                return
            columns.update(seconds)
        if header.fraction is not None:
            time, (place, unit_s) = header.places[header.time_column or 0], header.fraction
            columns[time] = np.asarray(columns[time], dtype=np.float64) + unit_s * np.asarray(
                columns[place], dtype=np.float64
            )
        if header.dates_beside is not None and not self.done.date_beside and rows:
            self.done.date_beside = str(columns[header.dates_beside][0])
        for column, place in enumerate(header.places):
            if header.names[column] in self.done.left_out:
                continue
            values = np.asarray(columns[place], dtype=np.float64)
            if (last := _last_value(values)) is not None:
                self.done.filled[header.names[column]] += int(np.count_nonzero(np.isfinite(values)))
                self.done.full = max(self.done.full, self.done.count + last + 1)
                self.marks[column].take(values)
            self.spool.append_column(column, values)
        self.done.count += rows

    @property
    def _texts(self) -> list[int]:
        """Return the columns of the file that are kept as text."""
        beside = [] if self.header.dates_beside is None else [self.header.dates_beside]
        return [*self.header.stamp_texts, *chain.from_iterable(self.header.more_dates), *beside]

    @property
    def _numbers(self) -> list[int]:
        """Return the columns of the file that are numbers."""
        header = self.header
        names = dict(zip(header.places, header.names, strict=True))
        beside = (header.milliseconds, None if header.fraction is None else header.fraction[0])
        wanted = [*header.places, *(place for place in beside if place is not None)]
        return [place for place in wanted if place not in self._texts and names.get(place) not in self.done.left_out]

    def _fast(self, block: _Block) -> _Columns | None:
        """Return the columns of whole rows; nothing where any row is none."""
        # a compiler is for long files only
        _kernel = importlib.import_module("shaftprint.recording.readers.csv._kernel")
        header, texts, wanted = self.header, self._texts, self._numbers
        if b"\0" in block.text:
            return None
        # quotes that hold a delimiter leave a row with too many fields
        read, most = block.text.replace(b'"', b""), block.lines
        targets = np.full(header.width, _kernel.SKIP)
        targets[texts] = _kernel.AS_TEXT
        targets[wanted] = np.arange(len(wanted))
        numbers = np.empty((len(wanted), most))
        places = np.empty((len(texts) * most, 2), dtype=np.int64)
        odd = np.empty((_ODD + most * len(wanted) // 2, 4), dtype=np.int64)
        rows, kept, strange = _kernel.rows_of(
            np.frombuffer(read, dtype=np.uint8),
            ord(header.delimiter),
            ord(header.decimal),
            header.width,
            _least(header),
            targets,
            numbers,
            places,
            odd,
        )
        if rows < 0:
            return None
        for target, row, begin, end in odd[:strange].tolist():
            value = number(self.header.pointed(read[begin:end].decode("utf-8", "replace").strip()))
            if value is None:
                return None
            numbers[target, row] = value
        fields = [read[begin:end].decode("utf-8", "replace").strip() for begin, end in places[:kept].tolist()]
        in_order = sorted(texts)
        columns: _Columns = {place: fields[at :: len(in_order)] for at, place in enumerate(in_order)}
        return {**columns, **{place: numbers[at, :rows] for at, place in enumerate(wanted)}}

    def _slow(self, block: _Block) -> _Columns | None:
        """Return the columns of the rows that are whole; note the others."""
        header = self.header
        lines: list[int] = []
        rows: list[list[str]] = []
        wrong: list[tuple[int, list[str]]] = []
        plain_text = block.text.decode("utf-8", "replace").replace("\r\n", "\n")
        for line, raw in enumerate(plain_text.split("\n"), start=block.line):
            nul = raw.count("\0")
            self.nul += nul
            plain = raw.replace("\0", "").strip("\r\n")
            bare = plain.strip()
            if not bare or bare == END_OF_EXPORT:
                continue
            if bare in header.head:
                self._note_titles(line, len(rows))
                continue
            fields = _as_wide(split_row(plain, header.delimiter), header)
            if fields is None or nul or not self._has_time(fields) or (block.is_end and self._is_cut(plain, fields)):
                wrong.append((line, split_row(plain, header.delimiter)))
                continue
            lines.append(line)
            rows.append(fields)
        self._note_wrong(wrong, len(rows), is_end=block.is_end)
        if not rows:
            return None
        columns: _Columns = {place: [row[place] for row in rows] for place in self._texts}
        for place in self._numbers:
            values = self._column(place, lines, rows)
            if values is not None:
                columns[place] = values
        return columns

    def _column(self, place: int, lines: Sequence[int], rows: Sequence[Sequence[str]]) -> FloatArray | None:
        """Return the numbers of a column; nothing where it holds words, with which it is left out."""
        header = self.header
        fields = [row[place] for row in rows]
        numbers = [number(self.header.pointed(one)) for one in fields]
        wrong = [row for row, one in enumerate(numbers) if one is None]
        if not wrong:
            return np.array(numbers, dtype=np.float64)
        self.mistakes += [(lines[row], list(rows[row])) for row in wrong]
        column = header.places.index(place) if place in header.places else None
        if column is None or column == header.time_column:
            raise wrong_rows(self.path, self.mistakes, header)
        word = printable(fields[wrong[0]])[:LONGEST]
        self.done.left_out[header.names[column]] = f'line {lines[wrong[0]]}: expected a number, found "{word}"'
        return None

    def _note_titles(self, line: int, rows: int) -> None:
        row = self.done.count + rows
        if not self.done.titles_again or self.done.titles_again[-1][1] != row:
            self.done.titles_again.append((line, row))

    def _is_cut(self, line: str, fields: Sequence[str]) -> bool:
        """Return whether the last line, which has no end, has lost the end of its last number."""
        if any(number(self.header.pointed(one)) is None for place, one in enumerate(fields) if place in self._numbers):
            return True
        usual = {
            self._behind_the_sign(one)
            for one in self.tail.decode("utf-8", "replace").splitlines()[1:][-_DECIMALS_SEEN:]
            if one.strip()
        }
        return bool(usual) and self._behind_the_sign(line) < min(usual)

    def _has_time(self, fields: Sequence[str]) -> bool:
        header = self.header
        if header.stamps:
            stamps = [fields[place] for place in (*header.stamp_texts, *chain.from_iterable(header.more_dates))]
            return all(is_stamp(one) or (not one and header.more_dates) for one in stamps) and any(stamps)
        if header.time_column is None:
            return True
        return number(header.pointed(fields[header.places[header.time_column]])) is not None

    def _behind_the_sign(self, line: str) -> int:
        """Return how many letters the last field of a line has behind its decimal sign."""
        return len(split_row(line, self.header.delimiter)[-1].partition(self.header.decimal)[2])

    def _note_wrong(self, wrong: Sequence[tuple[int, list[str]]], rows: int, *, is_end: bool) -> None:
        """Count rows that are none.

        Raises RecordingError if they are too many, or nothing else says when the others were taken.
        """
        if not wrong:
            return
        self.damaged += [line for line, _ in wrong]
        self.mistakes += wrong
        most = _MOST_DAMAGED + _DAMAGED_SHARE * (self.done.count + rows)
        if len(self.damaged) > most or (self.header.time_column is None and not is_end) or not (self.done.count + rows):
            raise wrong_rows(self.path, self.mistakes, self.header)

    def _close(self) -> None:
        """Say what was left out.

        Raises RecordingError if no column of numbers is left.
        """
        header, done = self.header, self.done
        if self.damaged:
            more = f" and {len(self.damaged) - 1} more" if len(self.damaged) > 1 else ""
            done.remarks.append(f"Line {self.damaged[0]}{more}: damaged or cut off, and left out.")
        if self.nul:
            done.remarks.append(f"{self.nul} NUL bytes between or behind the rows were left out.")
        for column, name in enumerate(header.names):
            if column != header.time_column and (sentence := self.marks[column].sentence(name)):
                done.remarks.append(sentence)
        channels = [name for column, name in enumerate(header.names) if column != header.time_column]
        done.empty = [name for name in header.names if done.count and not done.filled[name]]
        if channels and len(done.left_out) == len(channels) and self.mistakes:
            raise wrong_rows(self.path, self.mistakes, header)


def _blocks(path: Path, file: IO[bytes], line: int) -> Iterator[_Block]:
    """Yield whole lines, the first of a number, and what is behind the last of them."""
    while text := file.read(_BLOCK):
        rest = b"" if text.endswith(b"\n") else file.readline(LONGEST_LINE)
        if len(rest) == LONGEST_LINE or (len(text) > LONGEST_LINE and b"\n" not in text):
            raise RecordingError(f"{path}: expected lines of text, found one of over {LONGEST_LINE} characters.")
        text = (text + rest).removeprefix(_UTF_8_MARK if line == 1 else b"")
        lines = int(np.count_nonzero(np.frombuffer(text, dtype=np.uint8) == _LINE_FEED))
        end = b"" if text.endswith(b"\n") else text[text.rfind(b"\n") + 1 :]
        if lines:
            yield _Block(line=line, text=text.removesuffix(end), lines=lines)
            line += lines
        if end:
            yield _Block(line=line, text=end, lines=1, is_end=True)


def _last_value(values: FloatArray) -> int | None:
    """Return the place of the last finite number; nothing where there is none."""
    if values.size and np.isfinite(values[-1]):
        return int(values.size) - 1
    places = np.flatnonzero(np.isfinite(values))
    return int(places[-1]) if places.size else None


def _as_wide(fields: list[str], header: Header) -> list[str] | None:
    """Return the fields of a row as many as columns; nothing where one that is read is missing, or there are more."""
    if len(fields) == header.width:
        return fields
    if len(fields) > header.width:
        return fields[: header.width] if all(map(is_gap, fields[header.width :])) else None
    return fields + [""] * (header.width - len(fields)) if len(fields) >= _least(header) else None


def _least(header: Header) -> int:
    """Return how many fields a row has at least: columns behind those that are read may be missing, or have ended."""
    if header.more_times and header.time_column is not None:
        return header.places[header.time_column] + 2
    return header.width if header.is_whole else 1 + max([*header.places, *header.stamps])
