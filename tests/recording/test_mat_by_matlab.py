"""MATLAB files that MATLAB itself wrote, versions 4 to 7.4 on five kinds of machines: SciPy brings them along.

Their content is written down in SciPy's ``io/matlab/tests/test_mio.py``.
"""

from pathlib import Path

import numpy as np
import pytest
import scipy.io
from click.testing import CliRunner

from shaftprint.cli import shaftprint
from shaftprint.errors import RecordingError
from shaftprint.recording import read_recording

FOLDER = Path(scipy.io.__file__).parent / "matlab" / "tests" / "data"
FILES = sorted(FOLDER.glob("*.mat"))
THETA = np.pi / 4.0 * np.arange(9)

pytestmark = pytest.mark.skipif(not FILES, reason="this SciPy was installed without its test files")


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_every_file_ends_in_a_table_or_in_one_sentence(path):
    for more in ([], ["--sample-rate", "10"]):
        result = CliRunner().invoke(shaftprint, ["inspect", str(path), "--no-progress", *more], catch_exceptions=False)
        if result.exit_code == 0:
            assert "Channels, raw" in result.stdout
            assert result.stderr == ""
        else:
            assert result.exit_code == 1
            assert len(result.stderr.splitlines()) == 1
            assert path.name in result.stderr
            assert "NoneType" not in result.stderr


@pytest.mark.parametrize("version", ["4.2c_SOL2", "6.1_SOL2", "6.5.1_GLNX86", "7.1_GLNX86", "7.4_GLNX86"])
def test_a_vector_is_the_same_in_every_version(version):
    with read_recording(FOLDER / f"testdouble_{version}.mat", sample_rate_hz=10.0) as recording:
        assert recording.channel("testdouble").values(0, 9) == pytest.approx(THETA, abs=1e-14)


def test_version_7_3_before_it_had_that_name():
    with read_recording(FOLDER / "testhdf5_7.4_GLNX86.mat", sample_rate_hz=10.0) as recording:
        assert recording.format == "MATLAB v7.3"
        assert recording.channel("testdouble").values(0, 9) == pytest.approx(THETA, abs=1e-14)


@pytest.mark.parametrize("version", ["6.1_SOL2", "6.5.1_GLNX86", "7.1_GLNX86", "7.4_GLNX86"])
def test_a_field_of_a_structure_is_a_channel(version):
    with read_recording(FOLDER / f"teststruct_{version}.mat", sample_rate_hz=10.0) as recording:
        assert recording.channel("doublefield").values(0, 3) == pytest.approx([np.sqrt(2.0), np.e, np.pi], abs=1e-14)
        assert recording.left_out["teststruct/complexfield"] == "expected real numbers, found complex ones."


def test_logical_values_are_zeros_and_ones():
    with read_recording(FOLDER / "testbool_8_WIN64.mat", sample_rate_hz=10.0) as recording:
        assert recording.channel("testbools").values(0, 2).tolist() == [1.0, 0.0]


def test_a_vector_beside_a_matrix():
    with read_recording(FOLDER / "testmulti_7.4_GLNX86.mat", sample_rate_hz=10.0) as recording:
        assert recording.channel("theta").values(0, 9) == pytest.approx(THETA, abs=1e-14)
        assert recording.left_out["a"].startswith("expected a vector, found an array of 3 x 5")


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("testsparse_7.4_GLNX86", r"found a sparse matrix; in MATLAB: testsparse = full\(testsparse\)"),
        ("testcell_7.1_GLNX86", "testcell: expected a vector of numbers, found a cell array"),
        ("teststructarr_6.1_SOL2", "expected channels with samples, found none"),
        ("testfunc_7.4_GLNX86", "testfunc: expected numbers, found a MATLAB function, which only MATLAB can open"),
        ("corrupted_zlib_data", "expected a whole MATLAB file, found a damaged or truncated one"),
    ],
)
def test_what_is_no_channel_is_said(name, words):
    with pytest.raises(RecordingError, match=words):
        read_recording(FOLDER / f"{name}.mat", sample_rate_hz=10.0)
