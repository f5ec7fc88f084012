"""Segments in two files: a table that is read and edited, and beside it what the channels did, for the fit."""

import csv
import io
import json
import zipfile
import zlib
from collections.abc import Sequence
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.errors import ServiceError
from shaftprint.escape import csv_cell
from shaftprint.files import reason, write_bytes
from shaftprint.service._segment import LeverLine, Segment

SCHEMA = 1
"""Version of both files."""
USED, REASON = "used", "reason"
# Fields of a segment that the table does not tell, kept with its channels.
_NUMBERS = ("start_s", "move_s", "move_end_s", "rate_hz", "every")
# A month of a lively crew at 100 Hz, unpacked [bytes].
_LARGEST = 2**31
# What a file that was cut or changed raises while it is unpacked.
_DAMAGE = (zipfile.BadZipFile, zlib.error, ValueError, EOFError, MemoryError, RecursionError)


def channel_file(path: Path) -> Path:
    """Return where what the channels did lies beside a table: ``NAME.npz``."""
    return path.with_suffix(".npz")


def write_segments(
    path: Path, segments: Sequence[Segment], line: LeverLine, rows: Sequence[dict[str, str]], facts: dict[str, object]
) -> None:
    """Write segments, both files whole.

    ``path``: the table. ``segments``: the segments, in its order. ``line``: what the lever asks for. ``rows``: what the
    table says of each; columns in the order of the first. ``facts``: what else the fit has to know, such as the load.
    Raises ServiceError if a file cannot be written.
    """
    text = io.StringIO(newline="")
    table = csv.DictWriter(text, fieldnames=list(rows[0]) if rows else [USED, REASON], lineterminator="\n")
    table.writeheader()
    table.writerows({name: csv_cell(cell) for name, cell in row.items()} for row in rows)
    meta = {
        "schema": SCHEMA,
        "line": asdict(line),
        "facts": facts,
        "segments": [{name: getattr(one, name) for name in (*_NUMBERS, "log", "state", "reason")} for one in segments],
    }
    arrays: dict[str, FloatArray] = {}
    for number, one in enumerate(segments):
        if not one.reason:
            for name in ("lever_v", "speed_rev_s", "torque_nm"):
                arrays[f"{name}_{number}"] = getattr(one, name).astype(np.float32)
    binary = io.BytesIO()
    np.savez(binary, allow_pickle=False, meta=np.frombuffer(json.dumps(meta).encode(), dtype=np.uint8), **arrays)
    write_bytes(channel_file(path), binary.getvalue(), noun="channels of the segments", error=ServiceError)
    write_bytes(path, text.getvalue().encode(), noun="table of segments", error=ServiceError)


def read_segments(path: str | Path) -> tuple[tuple[Segment, ...], LeverLine, dict[str, object]]:
    """Return segments, the line of the lever and the facts; what the table takes out has a reason.

    ``path``: the table. Raises ServiceError if a file is missing, is no such file, or both do not belong together.
    """
    path = Path(path)
    try:
        rows = list(csv.DictReader(io.StringIO(path.read_text(encoding="utf-8"))))
    except OSError as error:
        raise ServiceError(f"{path}: expected a table of segments, found none: {reason(error)}.") from None
    except (UnicodeDecodeError, csv.Error) as error:
        raise ServiceError(f"{path}: expected a table of segments of shaftprint service scan, found {error}.") from None
    beside = channel_file(path)
    try:
        _expect_possible_size(beside)
        with np.load(beside, allow_pickle=False) as content:
            meta = json.loads(bytes(content["meta"]).decode())
            if meta["schema"] != SCHEMA:
                raise ServiceError(
                    f"{beside}: expected schema {SCHEMA}, found {meta['schema']!r}; scan the logs again."
                )
            segments = [_segment(content, number, fields) for number, fields in enumerate(meta["segments"])]
            line, facts = LeverLine(**meta["line"]), dict(meta["facts"])
    except OSError as error:
        raise ServiceError(f"{_expected(beside, path)}, found none: {reason(error)}; scan the logs again.") from None
    except (*_DAMAGE, KeyError, TypeError, AttributeError):
        raise ServiceError(f"{_expected(beside, path)}, found a damaged file; scan the logs again.") from None
    if len(rows) != len(segments):
        raise ServiceError(
            f"{path}: expected a line for each of {len(segments)} segments, found {len(rows)}; take a segment out with "
            f'"no" in the column {USED}, and leave its line.'
        )
    return tuple(_as_marked(one, row, path) for one, row in zip(segments, rows, strict=True)), line, facts


def _expected(beside: Path, path: Path) -> str:
    return f"{beside}: expected the channels of the segments, which service scan writes beside {path.name}"


def _expect_possible_size(beside: Path) -> None:
    """Refuse what would not fit into memory before anything is unpacked."""
    with zipfile.ZipFile(beside) as archive:
        size = sum(one.file_size for one in archive.infolist())
    if size > _LARGEST:
        raise ServiceError(
            f"{beside}: expected at most {_LARGEST // 2**20} MiB of channels, found {size // 2**20} MiB; scan fewer "
            "logs at once."
        )


def _segment(content: "np.lib.npyio.NpzFile", number: int, fields: dict[str, object]) -> Segment:
    def channel(name: str) -> FloatArray:
        key = f"{name}_{number}"
        return frozen_float(content[key].astype(np.float64) if key in content else np.zeros(0))

    values = {name: float(str(fields[name])) for name in _NUMBERS if name != "every"}
    segment = Segment(
        log=str(fields["log"]),
        state=str(fields["state"]),
        reason=str(fields["reason"]),
        every=int(str(fields["every"])),
        lever_v=channel("lever_v"),
        speed_rev_s=channel("speed_rev_s"),
        torque_nm=channel("torque_nm"),
        **values,
    )
    if not segment.reason and not (
        segment.speed_rev_s.size and segment.speed_rev_s.size == segment.torque_nm.size and segment.lever_v.size
    ):
        raise ValueError("channels are missing")
    return segment


def _as_marked(segment: Segment, row: dict[str, str], path: Path) -> Segment:
    used = (row.get(USED) or "").strip().lower()
    if used not in ("yes", "no"):
        raise ServiceError(f'{path}, {segment.name}: expected "yes" or "no" in the column {USED}, found "{used[:40]}".')
    if used == "no":
        return replace(segment, reason=segment.reason or "taken out by hand")
    if not segment.speed_rev_s.size:
        raise ServiceError(f'{path}, {segment.name}: expected "no", since {segment.reason}, found "yes".')
    return replace(segment, reason="")
