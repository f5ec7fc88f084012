"""Structures of one name in MATLAB files: signals of Simulink and recordings of dSPACE, with labels and units."""

import h5py
import numpy as np
import pytest
import scipy.io

from shaftprint.errors import RecordingError
from shaftprint.recording import read_recording

COUNT = 200
TIME = 0.01 * np.arange(COUNT)
TORQUE, SPEED = np.cos(TIME), 1500.0 + np.sin(TIME)
NAMES, UNITS = ("M_s", "n_e"), ("Nm", "rpm")


def _array(fields, rows):
    array = np.zeros((1, len(rows)), dtype=[(field, "O") for field in fields])
    for place, row in enumerate(rows):
        array[0, place] = row
    return array


def _channels(path, **hints):
    with read_recording(path, **hints) as recording:
        return {
            name: (one.unit, one.rate_hz, one.start_s, one.values(0, one.count))
            for name, one in recording.channels.items()
        }


@pytest.mark.parametrize("signals", [1, 2])
def test_signals_of_simulink_have_their_labels(tmp_path, signals):
    rows = [(values[:, None], 1.0, name, "m/Scope") for name, values in zip(NAMES, (TORQUE, SPEED), strict=True)]
    array = _array(("values", "dimensions", "label", "blockName"), rows[:signals])
    scipy.io.savemat(tmp_path / "log.mat", {"out": {"time": TIME[:, None], "signals": array, "blockName": "m/Scope"}})
    channels = _channels(tmp_path / "log.mat")
    assert list(channels) == list(NAMES[:signals])
    assert channels["M_s"][1] == 100.0
    assert np.array_equal(channels["M_s"][3], TORQUE)


def test_signals_without_labels_have_their_place(tmp_path):
    rows = [(values[:, None], "") for values in (TORQUE, SPEED)]
    scipy.io.savemat(tmp_path / "log.mat", {"out": {"time": TIME, "signals": _array(("values", "label"), rows)}})
    assert [name.replace("|", "/") for name in _channels(tmp_path / "log.mat")] == [
        "out/signals(1).values",
        "out/signals(2).values",
    ]


def _dspace_v5(path):
    slow = 0.1 * np.arange(30) + 0.05
    x = _array(("Name", "Data", "Unit"), [("HostService", TIME[None], "s"), ("Slow", slow[None], "s")])
    y = [(NAMES[0], TORQUE[None], UNITS[0]), (NAMES[1], SPEED[None], UNITS[1]), ("T_oil", np.full((1, 30), 60.0), "°C")]
    scipy.io.savemat(path, {"exp001": {"X": x, "Y": _array(("Name", "Data", "Unit"), y)}})


def _dspace_v73(path):
    def of_class(item, kind):
        item.attrs["MATLAB_class"] = np.bytes_(kind)
        return item

    def put(group, name, value):
        letters = isinstance(value, str)
        content = np.array([[ord(one)] for one in value], dtype=np.uint16) if letters else value[:, None]
        return of_class(group.create_dataset(name, data=content), "char" if letters else "double").ref

    with h5py.File(path, "w", userblock_size=512) as file:
        places = file.create_group("#refs#")
        top = of_class(file.create_group("exp001"), "struct")
        several = of_class(top.create_group("Y"), "struct")
        fields = {"Name": NAMES, "Data": (TORQUE, SPEED), "Unit": UNITS}
        for field, values in fields.items():
            references = [[put(places, f"{field}{place}", value)] for place, value in enumerate(values)]
            several.create_dataset(field, data=np.array(references, dtype=h5py.ref_dtype), dtype=h5py.ref_dtype)
        one = of_class(top.create_group("X"), "struct")
        put(one, "Data", TIME)
        put(one, "Name", "HostService")
    with path.open("r+b") as file:
        file.write(b"MATLAB 7.3 MAT-file, Platform: PCWIN64".ljust(116) + bytes(8) + b"\x00\x02IM")


@pytest.mark.parametrize("write", [_dspace_v5, _dspace_v73])
def test_a_recording_of_dspace_has_names_units_and_times(tmp_path, write):
    write(tmp_path / "log.mat")
    channels = _channels(tmp_path / "log.mat")
    assert list(channels)[:2] == list(NAMES)
    for name, unit, values in zip(NAMES, ("N m", "rpm"), (TORQUE, SPEED), strict=True):
        assert channels[name][:3] == (unit, 100.0, 0.0)
        assert np.array_equal(channels[name][3], values)


def test_each_signal_of_dspace_has_the_times_of_its_length(tmp_path):
    _dspace_v5(tmp_path / "log.mat")
    assert _channels(tmp_path / "log.mat")["T_oil"][:3] == ("°C", 10.0, 0.05)


def test_references_in_a_circle_come_to_an_end(tmp_path):
    path = tmp_path / "log.mat"
    _dspace_v73(path)
    with h5py.File(path, "r+") as file:
        several = file["exp001/Y"]
        several.create_dataset("Self", data=np.array([[several.ref]] * 2, dtype=h5py.ref_dtype), dtype=h5py.ref_dtype)
    assert set(NAMES) <= set(_channels(path))


@pytest.mark.parametrize("rasters", [1, 2])
def test_a_signal_of_dspace_has_the_times_of_its_index(tmp_path, rasters):
    """Rasters of one length are told apart by the index alone."""
    later = TIME + 0.003
    x = _array(("Name", "Data", "Unit"), [("10ms", TIME[None], "s"), ("Second task", later[None], "s")][:rasters])
    y = [(NAMES[0], TORQUE[None], UNITS[0], 1.0), (NAMES[1], SPEED[None], UNITS[1], float(rasters))]
    content = {"exp001": {"X": x, "Y": _array(("Name", "Data", "Unit", "XIndex"), y)}}
    scipy.io.savemat(tmp_path / "log.mat", content)
    channels = _channels(tmp_path / "log.mat")
    assert {name: one[:3] for name, one in channels.items()} == {
        "M_s": ("N m", 100.0, 0.0),
        "n_e": ("rpm", 100.0, 0.0 if rasters == 1 else 0.003),
    }
    assert np.array_equal(channels["n_e"][3], SPEED)


def test_times_are_those_of_the_names(tmp_path):
    """Dewesoft writes times a channel beside the rate of the fastest, asammdf times a group."""
    slow = {"time": 0.1 * np.arange(30) + 0.05, "value": np.linspace(60.0, 61.0, 30)}
    of_dewesoft = {
        "Sample_rate": 100.0, "Data1_M_s": TORQUE[:, None], "Data1_time_M_s": TIME[:, None],
        "Data1_T_oil": slow["value"][:, None], "Data1_time_T_oil": slow["time"][:, None],
    }  # fmt: skip
    of_asammdf = {
        "DGM0_timestamps": TIME[:, None], "DG0_M_s": TORQUE[:, None],
        "DGM1_timestamps": slow["time"][:, None], "DG1_T_oil": slow["value"][:, None],
    }  # fmt: skip
    for content, begin in ((of_dewesoft, "Data1"), (of_asammdf, "DG")):
        scipy.io.savemat(tmp_path / "log.mat", content)
        channels = _channels(tmp_path / "log.mat")
        assert [name.startswith(begin) for name in channels] == [True, True]
        torque, temperature = channels.values()
        assert (torque[1:3], temperature[1:3]) == ((100.0, 0.0), (10.0, 0.05))
        assert np.array_equal(temperature[3], slow["value"])


def _pulse(frequency, **channels):
    content = {"File_Header": {"NumberOfChannels": "2", "SampleFrequency": frequency}}
    for number, (name, unit, values) in enumerate(channels.values(), start=1):
        content[f"Channel_{number}_Header"] = {"SignalName": name, "Unit": unit}
        content[f"Channel_{number}_Data"] = values[:, None]
    return content


@pytest.mark.parametrize(("frequency", "kept"), [("100,0", COUNT), ("100 10", 20)])
def test_channels_with_a_head_each_have_its_name_and_the_rate_of_the_file(tmp_path, frequency, kept):
    content = _pulse(frequency, torque=("M_s", "Nm", TORQUE), speed=("n_e", "rpm", SPEED[:kept]))
    scipy.io.savemat(tmp_path / "log.mat", content)
    channels = _channels(tmp_path / "log.mat")
    assert {name: one[:2] for name, one in channels.items()} == {
        "M_s": ("N m", 100.0),
        "n_e": ("rpm", 100.0 if kept == COUNT else 10.0),
    }
    assert np.array_equal(channels["M_s"][3], TORQUE)


def test_one_rate_for_channels_of_several_lengths_is_asked_for(tmp_path):
    content = _pulse("100", torque=("M_s", "Nm", TORQUE), speed=("n_e", "rpm", SPEED[:20]))
    scipy.io.savemat(tmp_path / "log.mat", content)
    with pytest.raises(RecordingError, match=r"pass sample_rate_hz="):
        _channels(tmp_path / "log.mat")


@pytest.mark.parametrize(
    "content",
    [
        {"A": SPEED[:, None], "B": TORQUE[:, None], "Tstart": -1.0, "Tinterval": 0.01, "Length": float(COUNT)},
        {"Channel_1": {"XInc": 0.01, "XOrg": -1.0, "XUnits": "s", "Data": TORQUE[:, None]}},
    ],
)
def test_oscilloscopes_state_step_and_start(tmp_path, content):
    scipy.io.savemat(tmp_path / "log.mat", content)
    channels = _channels(tmp_path / "log.mat")
    assert {one[1:3] for one in channels.values()} == {(100.0, -1.0)}
    assert np.array_equal(list(channels.values())[-1][3], TORQUE)
