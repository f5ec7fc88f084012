import pytest

from shaftprint.escape import plain_name
from shaftprint.files import written_whole


def _write(path, text, *, overwrite=False, then=lambda: None):
    with written_whole(path, overwrite=overwrite) as part:
        part.write_text(text)
        then()


def _fail():
    raise RuntimeError("half way")


def test_the_file_appears_when_the_block_has_ended(tmp_path):
    path = tmp_path / "result.txt"
    with written_whole(path) as part:
        part.write_text("whole")
        assert not path.exists()
    assert path.read_text() == "whole"
    assert [entry.name for entry in tmp_path.iterdir()] == ["result.txt"]


def test_an_error_leaves_nothing_behind(tmp_path):
    with pytest.raises(RuntimeError, match="half way"):
        _write(tmp_path / "result.txt", "half", then=_fail)
    assert list(tmp_path.iterdir()) == []


def test_an_existing_file_is_kept(tmp_path):
    path = tmp_path / "result.txt"
    path.write_text("first")
    with pytest.raises(FileExistsError, match=r"result\.txt exists already"):
        _write(path, "second")
    assert path.read_text() == "first"


def test_an_existing_file_is_kept_when_an_overwriting_block_fails(tmp_path):
    path = tmp_path / "result.txt"
    path.write_text("first")
    with pytest.raises(RuntimeError, match="half way"):
        _write(path, "second", overwrite=True, then=_fail)
    assert path.read_text() == "first"
    _write(path, "second", overwrite=True)
    assert path.read_text() == "second"


def test_a_file_that_appeared_meanwhile_is_kept(tmp_path):
    path = tmp_path / "result.txt"
    with pytest.raises(FileExistsError, match="exists already"):
        _write(path, "mine", then=lambda: path.write_text("somebody else's"))
    assert [entry.name for entry in tmp_path.iterdir()] == ["result.txt"]
    assert path.read_text() == "somebody else's"


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("CL4_n", "CL4_n"),
        ("MY/LOOP", "MY-LOOP"),
        (r"a\b:c*d?e", "a-b-c-d-e"),
        ("speed / voltage", "speed-voltage"),
        ('"x"<y>|z', "-x-y-z"),
    ],
)
def test_a_text_becomes_a_name_that_every_system_takes(text, name):
    assert plain_name(text) == name
