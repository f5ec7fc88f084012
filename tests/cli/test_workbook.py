"""What ``--xlsx`` writes, read by another library: numbers are numbers, texts stay texts, nothing is lost."""

import errno
from pathlib import Path

import openpyxl
import pytest
from click.testing import CliRunner

from shaftprint.cli import shaftprint
from shaftprint.cli.output._workbook import Workbook
from shaftprint.plain_table import Symbol, Table, numbers, texts

TABLE = Table(
    title="Values: of [both]/ends, one after the other",
    columns=(*texts("quantity"), *numbers("value ± std", "95 % interval", "share", "one std", "p"), *texts("=note")),
    rows=(
        (Symbol("K_p"), "4.720 ± 0.091", "4.546 to 4.901", "59 %", "0.022 s", "4.7·10⁻⁵", "=1+1"),
        (Symbol("n"), "1\u202f360.9 ± 2.5", "−3.0 to 2.0", "−2 %", "1.6 kg m²", "0.74", "@here"),
        (Symbol("t_sp"), "0.000 (at its bound)", "0.000* to 0.069", "4.7·10⁻⁵ %", "", "< 1·10⁻³⁰⁰", "plain"),
    ),
    note="A note.",
)


@pytest.fixture
def book(tmp_path):
    made = Workbook(path=tmp_path / "out.xlsx", tables=[TABLE, TABLE])
    made.write()
    return openpyxl.load_workbook(made.path)


def test_numbers_are_numbers_with_the_digits_of_the_table(book):
    sheet = book.worksheets[1]
    heads, first, second, third = ([cell.value for cell in row] for row in sheet.iter_rows())
    assert heads[:9] == [
        "quantity", "value", "value, std", "95 % interval, from", "95 % interval, to", "share", "one std",
        "one std, unit", "p",
    ]  # fmt: skip
    assert first[:9] == ["K_p", 4.72, 0.091, 4.546, 4.901, 0.59, 0.022, "s", pytest.approx(4.7e-5)]
    assert second[:9] == ["n", 1360.9, 2.5, -3.0, 2.0, -0.02, 1.6, "kg m²", 0.74]
    assert third[1:5] == ["0.000 (at its bound)", None, "0.000* to 0.069", None]
    assert third[5:9] == [pytest.approx(4.7e-7), None, None, "< 1·10⁻³⁰⁰"]
    # 0.000047 % shown, where one decimal would be 0.0 %
    assert sheet.cell(4, 6).number_format == "0.000000%"
    assert [sheet.cell(2, column).number_format for column in (2, 6, 9)] == ["0.000", "0%", "0.0E+0"]


def test_texts_that_look_like_formulas_are_texts(book):
    for cell, text in ((book.worksheets[1]["J1"], "=note"), (book.worksheets[1]["J2"], "=1+1")):
        assert (cell.value, cell.data_type) == (text, "s")
    assert book.worksheets[1]["J2"].quotePrefix
    assert book.worksheets[1]["J3"].value == "@here"


def test_sheets_have_names_that_a_spreadsheet_takes_and_a_list_of_what_they_are(book):
    names = book.sheetnames
    assert names[0] == "Contents"
    assert len({name.lower() for name in names}) == 3
    assert all(len(name) <= 31 and not set("[]:*?/\\") & set(name) for name in names)
    assert [cell.value for cell in book["Contents"][2]] == [names[1], TABLE.title, "A note."]


def test_every_command_has_it_and_refuses_what_it_cannot_write(tmp_path):
    kept = tmp_path / "kept.xlsx"
    kept.write_text("mine")
    for path, words in (
        (kept, "exists already"),
        (tmp_path / "a.csv", "ends in .xlsx"),
        (tmp_path / "no/a.xlsx", "existing"),
    ):
        result = CliRunner().invoke(shaftprint, ["structures", "--xlsx", str(path)])
        assert result.exit_code == 1
        assert words in result.output
    assert kept.read_text() == "mine"


def test_a_disk_that_is_full_is_told_in_a_sentence(tmp_path, monkeypatch):
    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", full)
    path = tmp_path / "cl4.xlsx"
    result = CliRunner().invoke(shaftprint, ["structures", "CL4", "--xlsx", str(path)])
    assert isinstance(result.exception, SystemExit)
    assert result.exit_code == 1
    assert "cl4.xlsx: No space left on device; check the path" in " ".join(result.stderr.split())
    assert list(tmp_path.iterdir()) == []


def test_the_parameters_of_a_structure_come_as_numbers(tmp_path):
    path = tmp_path / "cl4.xlsx"
    result = CliRunner().invoke(shaftprint, ["structures", "CL4", "--quiet", "--xlsx", str(path)])
    assert result.exit_code == 0, result.output
    sheet = openpyxl.load_workbook(path).worksheets[1]
    column = [cell.value for cell in sheet[1]].index("lower")
    assert all(isinstance(row[column].value, float | int) for row in sheet.iter_rows(min_row=2))
