"""Which recordings are to be identified: a folder by its endings, a list by its rows."""

from datetime import datetime

import pytest

from shaftprint.errors import SettingsError
from shaftprint.fleet import recordings_in, recordings_of_list

BOTH = {"vessel": "stan-tug-1205", "campaign": "short"}


@pytest.fixture
def listed(tmp_path):
    """Write a list, and return its recordings."""

    def read(text, **facts):
        path = tmp_path / "list.csv"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return recordings_of_list(path, **(BOTH | facts))

    return read


def test_a_folder_gives_its_recordings_in_the_order_of_their_names(tmp_path):
    for name in ("b.nc", "a.MF4", "a.truth.json", "notes.md", ".hidden.nc"):
        (tmp_path / name).touch()
    (tmp_path / "2025").mkdir()
    (tmp_path / "2025" / "c.tdms").touch()
    found = recordings_in(tmp_path, **BOTH, ship="Meander", line="port", imo=None)
    assert [one.recording for one in found] == [str(tmp_path / name) for name in ("2025/c.tdms", "a.MF4", "b.nc")]
    assert {(one.ship, one.line, one.imo, one.vessel) for one in found} == {("Meander", "port", None, "stan-tug-1205")}


def test_a_folder_without_recordings_is_refused(tmp_path):
    with pytest.raises(SettingsError, match=r"expected recordings \(\.nc .*\), found none"):
        recordings_in(tmp_path, **BOTH)


def test_a_row_says_the_class_of_its_ship_and_a_job_without_one_is_that_of_earlier_versions(listed):
    first, second = listed("recording,ship,class\na.nc,Linge,Stan Tug 1205\nb.nc,Vecht,", line="port")
    assert (first.stated.class_name, second.stated.class_name) == ("Stan Tug 1205", None)
    assert "class_name" in first.settings()
    assert "class_name" not in second.settings()


def test_a_row_says_what_holds_for_its_recording(listed, tmp_path):
    (tmp_path / "mine.toml").touch()
    rows = ("a.nc,mine.toml,2026-03-31T09:30+02:00,1.8,9074729,Quay 1", "b.nc,,,,,")
    first, second = listed("\n".join(("Recording,vessel,tested-at,draught_m,imo,place", *rows)), line="port")
    assert (first.recording, first.vessel) == (str(tmp_path / "a.nc"), str(tmp_path / "mine.toml"))
    assert first.conditions.tested_at == datetime.fromisoformat("2026-03-31T07:30+00:00")
    assert (first.conditions.draught_m, first.conditions.place, first.imo, first.line) == (
        1.8,
        "Quay 1",
        9074729,
        "port",
    )
    assert (second.vessel, second.conditions.tested_at, second.imo) == ("stan-tug-1205", None, None)


def test_a_list_of_a_program_with_decimal_commas_is_read(listed):
    (one,) = listed(b'\xef\xbb\xbfrecording;place\r\na.nc;"Quay 1; berth 2"\r\n;\r\n')
    assert one.conditions.place == "Quay 1; berth 2"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "expected a column recording and each column once"),
        ("recording\n", "expected a row for each recording, found none"),
        ("file\na.nc\n", "found 'file'"),
        ("recording,draft_m\na.nc,1\n", "found 'draft_m'"),
        ("recording,draught-m\na.nc,deep\n", "row 2: draught_m: expected a number with a point, found 'deep'"),
        ("recording,draught-m\na.nc,nan\n", "row 2: draught_m: expected a number with a point, found 'nan'"),
        ("recording,draught-m\na.nc,1\nb.nc,99\n", "row 3: draught_m: Input should be less than or equal to 50"),
        ("recording,imo\na.nc,9074728\n", "row 2: imo: .*expected an IMO number"),
        ("recording,imo\na.nc,one\n", "row 2: imo: expected a whole number, found 'one'"),
        ("recording,tested-at\na.nc,yesterday\n", "row 2: tested_at: expected a time such as"),
        ("recording,time-zone\na.nc,Atlantis\n", "row 2: time_zone"),
        ("recording\na.nc,b.nc\n", "row 2: expected 1 cells, found 2"),
        ("recording,recording\na.nc,b.nc\n", "each column once"),
        ('recording\n"a.nc\n', "expected a list in CSV, found something else"),
        (b"recording\n\xff.nc\n", "expected a list in CSV in UTF-8"),
        ("recording,vessel\n,stan-tug-1205\n", "row 2: expected a recording, found none"),
    ],
)
def test_a_row_that_cannot_be_used_is_named(listed, text, words):
    with pytest.raises(SettingsError, match=words):
        listed(text)


def test_a_list_without_vessel_asks_for_one(listed):
    with pytest.raises(SettingsError, match="row 2: expected a vessel, found none; add it, or state --vessel"):
        listed("recording\na.nc\n", vessel=None)
