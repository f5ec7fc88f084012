"""One file a family of the benchmark of real writers; ``python -m benchmarks.real_writers DIR`` makes them all."""

import numpy as np
import pytest
from benchmarks.real_writers._damage import WAYS, damaged
from benchmarks.real_writers._families import FAMILIES, write_one
from benchmarks.real_writers._truth import answer

NAMED = {family.name: family for family in FAMILIES}


def _file(family, number, folder):
    try:
        return write_one(NAMED[family], folder, number)
    except ImportError as error:
        pytest.skip(f"needs {error.name}")


@pytest.mark.parametrize(
    ("family", "number"),
    # ranges of whole counts, a long pause, big-endian counts, SciPy's packed counts, 7.3, names of months, text
    [
        ("MDF", 27),
        ("TDMS", 19),
        ("HDF5", 3),
        ("NetCDF", 26),
        ("MATLAB", 13),
        ("text", 6),
        ("UFF 58", 0),
        ("CAN logs", 1),
    ],
)
def test_what_a_writer_was_given_is_read(tmp_path, family, number):
    path, _, truth = _file(family, number, tmp_path)
    found = answer(path, truth)
    assert (found.wrong, found.refused, dict(found.left_out)) == ((), "", {})


@pytest.mark.parametrize("number", [4, 6, 9])
def test_what_is_not_read_is_refused(tmp_path, number):
    path, _, truth = _file("others", number, tmp_path)
    sentence = answer(path, truth).refused
    assert "found none of them; " in sentence
    assert "from the program that wrote it" not in sentence


@pytest.mark.parametrize("way", WAYS)
def test_a_damaged_copy_ends_in_an_answer(tmp_path, way):
    path, _, truth = _file("MATLAB", 0, tmp_path)
    copy = tmp_path / "copy.mat"
    copy.write_bytes(damaged(path.read_bytes(), np.random.default_rng(3), way, in_head=True))
    answer(copy, truth)
