"""Issue item A6: names as long as the system takes them are written, longer ones end in one sentence."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from shaftprint.recording import Samples, read_recording, recording_from_arrays, write_by_ending

LONGEST = 255


@pytest.fixture
def recording(tmp_path):
    place = tmp_path / "in.csv"
    rows = "\n".join(f"{i / 100},{i % 7}" for i in range(500))
    place.write_text(f"time [s],M_s [V]\n{rows}\n")
    return place


def name_of(length, ending):
    return "x" * (length - len(ending)) + ending


def program(*arguments):
    """Run the program in a process of its own: what is ignored while it ends is printed by the interpreter."""
    call = [sys.executable, "-m", "shaftprint", *map(str, arguments)]
    return subprocess.run(call, capture_output=True, text=True, timeout=600, check=False)


@pytest.mark.parametrize("length", [230, 253, LONGEST])
@pytest.mark.parametrize("ending", [".nc", ".csv", ".mat", ".mf4", ".tdms"])
def test_names_as_long_as_they_may_be(tmp_path, ending, length):
    samples = [Samples(name="M_s", values=np.arange(500.0), unit="V", rate_hz=100.0)]
    (tmp_path / "source").write_text("x")
    source = recording_from_arrays(tmp_path / "source", samples, format="arrays")
    path = tmp_path / name_of(length, ending)
    write_by_ending(path, source.channels.values())
    with read_recording(path) as opened:
        channel = next(iter(opened.channels.values()))
        np.testing.assert_allclose(channel.values(0, 500), np.arange(500.0))
    assert sorted(entry.name for entry in tmp_path.iterdir()) == sorted(["source", path.name])


def test_letters_of_several_bytes(tmp_path):
    samples = [Samples(name="M_s", values=np.arange(500.0), unit="V", rate_hz=100.0)]
    (tmp_path / "source").write_text("x")
    source = recording_from_arrays(tmp_path / "source", samples, format="arrays")
    path = tmp_path / ("\N{CJK UNIFIED IDEOGRAPH-8239}" * 84 + ".nc")
    write_by_ending(path, source.channels.values())
    assert path.is_file()


@pytest.mark.slow
@pytest.mark.parametrize("ending", [".nc", ".csv", ".mat"])
def test_a_name_that_is_too_long_ends_convert_in_a_sentence(tmp_path, recording, ending):
    path = tmp_path / name_of(LONGEST + 1, ending)
    done = program("convert", recording, "-o", path, "--no-progress")
    assert done.returncode == 1
    assert done.stderr.count("\n") == 1, done.stderr
    assert str(path) in done.stderr
    assert "File name too long" in done.stderr


@pytest.mark.slow
def test_sail_needs_room_for_the_name_of_the_truth(tmp_path):
    path = tmp_path / name_of(253, ".nc")
    done = program("sail", "stan-tug-1205", "short", "-o", path, "--no-progress")
    assert done.returncode == 1
    assert done.stderr.count("\n") == 1, done.stderr
    assert "File name too long" in done.stderr
    assert list(Path(tmp_path).iterdir()) == []


@pytest.mark.slow
def test_export_of_a_long_name(demo, tmp_path):
    """All writers take the same temporary name."""
    assert program("export", "json", demo[0], "-o", tmp_path / name_of(253, ".json")).returncode == 0
    done = program("export", "json", demo[0], "-o", tmp_path / name_of(LONGEST + 1, ".json"))
    assert (done.returncode, done.stderr.count("\n")) == (1, 1), done.stderr
    picture = tmp_path / name_of(253, ".svg")
    assert program("inertia", "stan-tug-1205", "--modes", picture).returncode == 0
    assert picture.read_text(encoding="utf-8").startswith("<?xml")
