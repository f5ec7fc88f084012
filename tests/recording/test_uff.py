"""Universal files as pyuff writes them."""

import datetime as dt

import numpy as np
import pytest

from shaftprint.errors import RecordingError
from shaftprint.recording import read_recording

pyuff = pytest.importorskip("pyuff")
# its writer of binary data leaves the file to be closed by Python
pytestmark = pytest.mark.filterwarnings("ignore:unclosed file:ResourceWarning")

TIME = np.arange(500) / 51200.0
VALUES = np.cos(300.0 * TIME)


def _set(values=VALUES, **more):
    return {
        "type": 58, "binary": 0, "func_type": 1, "rsp_node": 1, "rsp_dir": 3, "ref_node": 0, "ref_dir": 0,
        "data": values, "x": TIME, "id1": "shaft torque", "id2": "", "id3": "05-Mar-26 09:00:00",
        "id4": "NONE", "id5": "NONE",
        "rsp_ent_name": "NONE", "ref_ent_name": "NONE", "abscissa_spacing": 1, "abscissa_spec_data_type": 17,
        "ordinate_spec_data_type": 8, "ordinate_axis_units_lab": "Nm", "ordinate_axis_lab": "Torque",
        "abscissa_axis_units_lab": "s", "abscissa_axis_lab": "Time", "orddenom_spec_data_type": 0, **more,
    }  # fmt: skip


def _read(tmp_path, *sets, **hints):
    path = tmp_path / "log.uff"
    path.unlink(missing_ok=True)
    pyuff.UFF(str(path)).write_sets(list(sets), "add")
    return read_recording(path, **hints)


@pytest.mark.parametrize("binary", [0, 1])
@pytest.mark.parametrize("spacing", [0, 1])
def test_text_and_binary_even_and_uneven(tmp_path, binary, spacing):
    recording = _read(tmp_path, _set(binary=binary, abscissa_spacing=spacing))
    channel = recording.channel("shaft torque")
    assert (channel.unit, channel.count, channel.long_name) == ("N m", 500, "Torque")
    assert channel.values(0, 500) == pytest.approx(VALUES, abs=1e-9)
    assert recording.began == dt.datetime(2026, 3, 5, 9)  # noqa: DTZ001
    # the file has six digits: 1.95313E-05 s would be 51199.87 Hz
    assert channel.rate_hz == (51200.0 if spacing else pytest.approx(51200.0, rel=1e-4))
    assert ("51200 Hz is the roundest" in " ".join(recording.remarks)) == bool(spacing)


def test_points_have_names_and_what_is_no_time_is_left_out(tmp_path):
    point = {"rsp_ent_name": "rotor", "rsp_node": 12, "rsp_dir": -1}
    response = _set(values=np.exp(1j * TIME), func_type=4, abscissa_spec_data_type=18, id1="H")
    recording = _read(tmp_path, _set(**point), _set(id1="speed", ordinate_axis_units_lab="rpm"), response)
    assert list(recording.channels) == ["rotor:12:-X", "speed"]
    assert recording.channel("speed").unit == "rpm"
    assert recording.left_out == {"H": "expected a function of time, found a frequency response"}


def test_a_rate_beside_the_step(tmp_path):
    assert _read(tmp_path, _set(), sample_rate_hz=51200.1).channel("shaft torque").rate_hz == 51200.1
    with pytest.raises(RecordingError, match=r"a step of 1\.95313e-05 s 51199\.9 Hz, the hint sample_rate_hz 100 Hz"):
        _read(tmp_path, _set(), sample_rate_hz=100.0)


def test_a_damaged_file_ends_in_one_sentence(tmp_path):
    path = tmp_path / "log.uff"
    _read(tmp_path, _set())
    path.write_text(path.read_text().replace("9.99999", "x.99999")[:-700])
    with pytest.raises(RecordingError, match="expected"):
        read_recording(path)


def test_zeros_that_a_text_editor_made_blanks_are_told(tmp_path):
    _read(tmp_path, _set(np.where(np.arange(500) % 9, VALUES, 0.0), binary=1)).close()
    path = tmp_path / "log.uff"
    path.write_bytes(path.read_bytes().replace(b"\0", b" "))
    with pytest.raises(RecordingError, match="found blanks in the place of all zeros"):
        read_recording(path)
