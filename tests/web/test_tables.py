"""Tables of a page as files, and several files in one form."""

import csv
import io
import zipfile
from types import SimpleNamespace
from xml.etree import ElementTree as ET

import pytest
from tests.web.client import form_of
from tests.web.conftest import ADA

from shaftprint.plain_table import Column, Table
from shaftprint.tables._workbook import sheet_of, shown, write_workbook
from shaftprint.web import _upload
from shaftprint.web._page_tables import tables_in

PAGE = """<table><caption>One <b>table</b></caption>
<thead><tr><th>name</th><th class="number">K<sub>p</sub></th><th></th></tr></thead>
<tbody><tr><th>a &amp; b<br>c</th><td class="number">1</td><td><input></td></tr>
</tbody></table><p>no</p>"""


def rows_of(answer):
    assert answer.status == 200, answer.text
    return list(csv.reader(io.StringIO(answer.body.decode("utf-8-sig"))))


def test_tables_are_read_from_the_page_that_shows_them():
    (table,) = tables_in(PAGE)
    assert table.title == "One table"
    # a column of which only buttons are seen is none
    assert [(one.heading, one.number) for one in table.columns] == [("name", False), ("K_p", True)]
    assert table.rows == (("a & b c", "1"),)


def test_a_table_without_rows_does_not_change_the_numbers_of_the_others(site):
    empty = "<table><caption>None</caption><thead><tr><th>when</th></tr></thead><tbody></tbody></table>"
    none, one = tables_in(empty + PAGE)
    assert (none.title, [column.heading for column in none.columns], none.rows) == ("None", ["when"], ())
    assert one.title == "One table"
    owner = site.person("owner-ada")
    page = owner.get("/audit?kind=withdrew+an+event")
    assert "?kind=withdrew+an+event&amp;as=csv&amp;table=1" in page.text
    assert rows_of(owner.get("/audit?kind=withdrew+an+event&as=csv&table=1")) == [
        ["when", "who", "from", "what", "about"]
    ]


def test_a_value_and_its_deviation_are_two_numbers():
    columns = (Column("test"), Column("K_p [s]", number=True))
    rows = (("a", "−1 651.0 ± 2.5"), ("b", "7.00 ± 1.10 *"), ("c", "–"), ("d", "2026-03-01"))
    apart = sheet_of(Table(title="x", columns=columns, rows=rows))
    assert [one.heading for one in apart.columns] == ["test", "K_p [s]", "K_p [s], std", "K_p [s], not to be used"]
    assert [[shown(cell) for cell in row] for row in apart.rows] == [
        ["a", "-1651.0", "2.5", ""],
        ["b", "7.00", "1.10", "*"],
        ["c", "", "", ""],
        ["d", "2026-03-01", "", ""],
    ]


def test_numbers_are_shown_as_programs_read_them():
    assert [shown(one) for one in ((0.59, "0%"), (4.7e-5, "0.0E+0"), (0.1, "General"), "=1")] == [
        "59 %", "4.7e-05", "0.1", "=1",
    ]  # fmt: skip


def test_a_page_gives_each_of_its_tables_as_csv(site):
    tester = site.person("tester-ada")
    event = {"what": "other", "at": "2026-05-01T08:00", "zone": "UTC", "note": "=1+2"}
    tester.post(f"/ships/{ADA}/port/events", event)
    page = tester.get(f"/ships/{ADA}/port")
    assert "?as=csv&amp;table=1" in page.text
    events = rows_of(tester.get(f"/ships/{ADA}/port?as=csv&table=1"))
    assert events[0] == ["no.", "when", "what", "numbers", "note"]
    # no spreadsheet calculates it
    assert events[2][4] == "'=1+2"
    tests = rows_of(tester.get(f"/ships/{ADA}/port?as=csv&table=2"))
    assert [row[0] for row in tests[1:]] == ["2026-03-01", "2025-03-01"]
    numbers = [one for one in tester.get(f"/api/v1/ships/{ADA}/port").json["tests"][0]["numbers"] if one["value"]]
    place = next(at for at, title in enumerate(tests[0]) if title.startswith(numbers[0]["name"]))
    assert float(tests[1][place]) == pytest.approx(numbers[0]["value"], rel=0.05)
    assert float(tests[1][place + 1]) == pytest.approx(numbers[0]["std"], rel=0.1)
    for wrong in ("as=csv", "as=csv&table=9", "as=csv&table=0", "as=csv&table=x", "as=pdf&table=1"):
        assert tester.get(f"/ships/{ADA}/port?{wrong}").status == 404
    # who does not see the page does not see its tables
    assert site.person("reader-hidden").get(f"/ships/{ADA}/port?as=csv&table=1").status == 404


def test_a_page_gives_its_tables_as_a_workbook(site):
    answer = site.person("reader-ada").get("/?as=xlsx")
    assert answer.status == 200, answer.text
    assert answer.heads["content-disposition"] == 'attachment; filename="Ships.xlsx"'
    with zipfile.ZipFile(io.BytesIO(answer.body)) as book:
        assert any("Ada" in book.read(name).decode() for name in book.namelist() if "sharedStrings" in name)


def test_numbers_are_numbers_in_a_workbook_and_no_text_is_a_formula():
    pytest.importorskip("xlsxwriter")
    table = Table(title="A/B: [x]", columns=(Column("name"), Column("n", number=True)), rows=(("=1+2", "−2.5"),))
    content = io.BytesIO()
    write_workbook(content, [sheet_of(table), sheet_of(table)])
    with zipfile.ZipFile(content) as book:
        sheet, names = book.read("xl/worksheets/sheet2.xml"), book.read("xl/workbook.xml")
    cells = ET.fromstring(sheet).iter("{http://schemas.openxmlformats.org/spreadsheetml/2006/main}c")  # noqa: S314
    kinds = {one.get("r"): (one.get("t"), [part.tag.rpartition("}")[2] for part in one]) for one in cells}
    assert kinds["A2"] == ("s", ["v"])
    assert kinds["B2"] == (None, ["v"])
    assert b"<v>-2.5</v>" in sheet
    assert b'name="A B   x"' in names
    assert b'name="A B   x 2"' in names


def several(fields, files, boundary="frontier"):
    """Return content type and body of a form with several files."""
    kind, body = form_of(fields, *files[0], boundary=boundary)
    end = f"\r\n--{boundary}--\r\n".encode()
    for name, content in files[1:]:
        head = f'\r\n--{boundary}\r\nContent-Disposition: form-data; name="file"; filename="{name}"\r\n\r\n'
        body = body.removesuffix(end) + head.encode() + content + end
    return kind, body


@pytest.mark.parametrize("size", [1, 7, 5000])
def test_a_form_gives_several_files_however_it_is_cut(site, size):
    browser = site.person("tester-ada")
    files = [("a.nc", b"\r\n--x" * 3), ("b.toml", b""), ("c.toml", b"name = 1\r\n")]
    files[1] = ("b.toml", b"[engine]\n")
    kind, body = several({"token": browser.known(), "line": f"{ADA}/port"}, files)
    pieces = [body[start : start + size] for start in range(0, len(body), size)]
    answer = browser.ask("POST", "/upload", pieces=pieces, heads=[("content-type", kind)])
    assert answer.status == 303, answer.text
    listed = browser.get("/api/v1/upload").json["uploads"]
    sizes = {one["name"]: one["size"] for one in listed}
    assert {name: sizes[name] for name, _ in files} == {name: len(content) for name, content in files}


def test_files_of_one_form_need_their_room_once(site, monkeypatch):
    """1000 bytes beyond what stays free are enough for 900, also when half of them are written."""

    def usage(folder):
        there = sum(one.stat().st_size for one in folder.rglob("*") if one.is_file())
        return SimpleNamespace(free=_upload._LEFT_FREE + 1000 + len(frame) - there)

    browser = site.person("tester-ada")
    kind, frame = several({"token": browser.known(), "line": f"{ADA}/port"}, [("a.nc", b""), ("b.nc", b"")])
    _, body = several({"token": browser.token, "line": f"{ADA}/port"}, [("a.nc", b"x" * 450), ("b.nc", b"x" * 450)])
    monkeypatch.setattr(_upload.shutil, "disk_usage", usage)
    heads = [("content-type", kind), ("content-length", str(len(body)))]
    answer = browser.ask("POST", "/upload", body=body, heads=heads)
    assert answer.status == 303, answer.text


def test_what_came_before_a_file_that_is_refused_is_named(site):
    browser = site.person("tester-ada")
    kind, body = several({"token": browser.known(), "line": f"{ADA}/port"}, [("a.nc", b"x"), ("all.zip", b"x")])
    answer = browser.ask("POST", "/upload", body=body, heads=[("content-type", kind)])
    assert answer.status == 400
    assert "Kept before it: a.nc." in answer.text
    # a field behind the files has no meaning
    kind, body = form_of({"token": browser.known(), "line": f"{ADA}/port"}, "b.nc", b"x")
    field = b'\r\n--frontier\r\nContent-Disposition: form-data; name="line"\r\n\r\nx\r\n--frontier--\r\n'
    sent = browser.ask(
        "POST", "/upload", body=body.replace(b"\r\n--frontier--\r\n", field), heads=[("content-type", kind)]
    )
    assert sent.status == 400
