"""A fingerprint as tables for a spreadsheet."""

import csv
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

from numpy.typing import ArrayLike

from shaftprint.arguments import refusing_none
from shaftprint.errors import ExportError
from shaftprint.escape import csv_cell
from shaftprint.export._model import exported_model
from shaftprint.export._model_response import model_response
from shaftprint.export._tables import Cell, Row, number_rows, parameter_rows, response_rows
from shaftprint.files import written_whole
from shaftprint.fingerprint._fingerprint import Fingerprint
from shaftprint.models._structure import Structure


@dataclass(frozen=True, kw_only=True, slots=True)
class WrittenTables:
    """What was written."""

    parameters: Path
    """All parameters, held ones included."""
    combinations: Path
    """Combinations of parameters, physical values, margins and calibrations."""
    response: Path
    """Frequency response of the model with its 95 % band."""


@refusing_none(ExportError)
def write_csv(
    fingerprint: Fingerprint,
    path: str | Path,
    *,
    of: Structure | None = None,
    omega_rad_s: ArrayLike | None = None,
    overwrite: bool = False,
) -> WrittenTables:
    """Write three tables with commas between columns, points in numbers and a header; an empty cell is not known.

    Parameters
    ----------
    path
        Beginning of their names: ``tug.csv`` gives ``tug-parameters.csv``, ``tug-combinations.csv`` and
        ``tug-response.csv``.
    of
        The structure that was identified; the shipped one of its name if not given.
    omega_rad_s
        Frequencies of the response [rad/s], shape (frequencies,); 0.05 to 50 rad/s if not given.
    overwrite
        Whether earlier files are replaced.

    Raises
    ------
    ExportError
        If the frequencies are wrong.
    FingerprintError
        If the structure has other parameters than the fingerprint.
    StructureError
        If there is no shipped structure of that name.
    FileExistsError
        If a file exists and is not to be replaced.
    """
    model = exported_model(fingerprint, of=of, linear=True)
    stem = Path(path).with_suffix("") if Path(path).suffix == ".csv" else Path(path)
    written = WrittenTables(
        **{name: stem.with_name(f"{stem.name}-{name}.csv") for name in ("parameters", "combinations", "response")}
    )
    tables = {
        written.parameters: parameter_rows(fingerprint, model.structure),
        written.combinations: number_rows(fingerprint),
        written.response: response_rows(model_response(model, omega_rad_s)),
    }
    with ExitStack() as stack:
        for csv_path, rows in tables.items():
            _write(stack.enter_context(written_whole(csv_path, overwrite=overwrite)), rows)
    return written


def _write(path: Path, rows: Sequence[Row]) -> None:
    with path.open("w", encoding="utf-8", newline="") as file:
        table = csv.DictWriter(file, list(rows[0]) if rows else ["name"])
        table.writeheader()
        table.writerows({key: _text(cell) for key, cell in row.items()} for row in rows)


def _text(cell: Cell) -> str:
    """Return what stands in a cell; numbers come back exactly."""
    if cell is None:
        return ""
    if isinstance(cell, bool):
        return "yes" if cell else "no"
    return repr(cell) if isinstance(cell, float) else csv_cell(cell)
