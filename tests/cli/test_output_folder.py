"""A folder of results is written whole or not at all, and nobody's files are lost."""

import os
from pathlib import Path

import click
import pytest

from shaftprint.cli.output._output_folder import output_folder


def _write(path, names, *, of="identify", force=False, text="new"):
    with output_folder(path, of=of, force=force) as folder:
        for name in names:
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_text(text)


def _fail_half_way(path):
    with output_folder(path, of="identify", force=False) as folder:
        (folder / "x.txt").write_text("half")
        raise RuntimeError("half way")


def test_new_folder_with_parents(tmp_path):
    _write(tmp_path / "a" / "b", ["x.txt", "figures/y.svg"])
    assert (tmp_path / "a" / "b" / "x.txt").read_text() == "new"
    assert (tmp_path / "a" / "b" / "figures" / "y.svg").read_text() == "new"
    assert [entry.name for entry in (tmp_path / "a").iterdir()] == ["b"]


def test_error_leaves_earlier_results_as_they_were(tmp_path):
    place = tmp_path / "out"
    _write(place, ["x.txt"], text="old")
    with pytest.raises(RuntimeError, match="half way"):
        _fail_half_way(place)
    assert (place / "x.txt").read_text() == "old"
    assert [entry.name for entry in tmp_path.iterdir()] == ["out"]


def test_error_leaves_no_new_folder(tmp_path):
    with pytest.raises(RuntimeError, match="half way"):
        _fail_half_way(tmp_path / "out")
    assert list(tmp_path.iterdir()) == []


def test_own_results_are_replaced_and_notes_are_kept(tmp_path):
    place = tmp_path / "out"
    _write(place, ["x.txt", "gone.txt"], text="old")
    (place / "my notes.txt").write_text("mine")
    _write(place, ["x.txt", "more.txt"])
    assert (place / "x.txt").read_text() == "new"
    assert (place / "more.txt").read_text() == "new"
    assert (place / "my notes.txt").read_text() == "mine"
    assert not (place / "gone.txt").exists()


def test_it_is_said_which_results_were_replaced(tmp_path, capsys):
    place = tmp_path / "out"
    _write(place, ["x.txt"], text="old")
    assert capsys.readouterr().err == ""
    os.utime(place / ".shaftprint", (1_770_000_000, 1_770_000_000))
    _write(place, ["x.txt"])
    (said,) = capsys.readouterr().err.splitlines()
    assert said.startswith(f"{place}: replaced the results of 2026-02-0")


def test_folder_of_others_is_refused_unless_forced(tmp_path):
    place = tmp_path / "photos"
    place.mkdir()
    (place / "a.jpg").write_text("mine")
    with pytest.raises(click.ClickException, match=r"photos: expected an empty folder .* found a\.jpg; .*--force"):
        _write(place, ["x.txt"])
    (place / "b.jpg").write_text("mine")
    with pytest.raises(click.ClickException, match=r"found a\.jpg and 1 more"):
        _write(place, ["x.txt"])
    _write(place, ["x.txt"], force=True)
    assert sorted(entry.name for entry in place.iterdir()) == [".shaftprint", "a.jpg", "b.jpg", "x.txt"]
    assert (place / "a.jpg").read_text() == "mine"


def test_results_of_another_command_may_be_what_this_one_reads(tmp_path):
    place = tmp_path / "demo"
    _write(place, ["recording.nc", "index.html"], of="demo", text="sailed")
    with pytest.raises(click.ClickException, match=r"results of shaftprint identify, found those of shaftprint demo; "):
        _write(place, ["index.html"])
    _write(place, ["index.html", "fingerprint.json"], force=True)
    assert (place / "recording.nc").read_text() == "sailed"
    assert (place / "index.html").read_text() == "new"
    # from now on they are whatever the user makes of them
    _write(place, ["index.html"])
    assert (place / "recording.nc").read_text() == "sailed"
    assert not (place / "fingerprint.json").exists()


def test_a_list_that_is_empty_names_no_command(tmp_path):
    place = tmp_path / "out"
    _write(place, ["x.txt"], text="old")
    (place / ".shaftprint").write_text("")
    with pytest.raises(click.ClickException, match=r"found x\.txt; "):
        _write(place, ["x.txt"])
    assert (place / "x.txt").read_text() == "old"


def test_empty_folder_is_used(tmp_path):
    (tmp_path / "out").mkdir()
    _write(tmp_path / "out", ["x.txt"])
    assert (tmp_path / "out" / "x.txt").exists()


@pytest.mark.parametrize("place", [".", "sub/.."])
def test_working_folder_itself(tmp_path, monkeypatch, place):
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "sub").mkdir()
    monkeypatch.chdir(tmp_path / "out")
    _write(Path(place), ["x.txt"], force=True)
    assert (tmp_path / "out" / "x.txt").exists()
    assert [entry.name for entry in tmp_path.iterdir()] == ["out"]


def test_root_of_the_disk():
    with pytest.raises(click.ClickException, match="expected a folder below the root of the disk"):
        _write(Path(Path.cwd().anchor), ["x.txt"], force=True)


def test_file_in_the_place_of_the_folder(tmp_path):
    (tmp_path / "out").write_text("mine")
    with pytest.raises(click.ClickException, match="expected a folder for the results, found a file"):
        _write(tmp_path / "out", ["x.txt"], force=True)
    assert (tmp_path / "out").read_text() == "mine"


@pytest.mark.parametrize("line", ["../precious.txt", "{absolute}"])
def test_list_of_files_cannot_reach_outside(tmp_path, line):
    precious = tmp_path / "precious.txt"
    precious.write_text("mine")
    place = tmp_path / "out"
    _write(place, ["x.txt"])
    (place / ".shaftprint").write_text(f"# shaftprint identify\n{line.format(absolute=precious)}\n")
    _write(place, ["x.txt"])
    assert precious.read_text() == "mine"
