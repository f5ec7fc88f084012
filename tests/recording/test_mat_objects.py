"""Timetables, tables, durations and dates of MATLAB, written by mat-io as MATLAB writes them."""

import importlib
import sys
import warnings
from datetime import datetime

import numpy as np
import pandas as pd
import pytest
import scipy.io

from shaftprint.errors import RecordingError
from shaftprint.recording import read_recording

# 2 kHz: half a millisecond, which is no whole number of the milliseconds that MATLAB counts
COUNT, STEP_NS = 200, 500_000
PASSED = np.arange(COUNT) * np.timedelta64(STEP_NS, "ns")
TORQUE = np.sin(0.1 * np.arange(COUNT))


def _timetable(index):
    table = pd.DataFrame({"M_s": TORQUE, "X": np.arange(COUNT), "note": ["a"] * COUNT}, index=index)
    table.index.name = "Time"
    return table


@pytest.fixture(params=["v7", "v7.3"])
def save(request, tmp_path):
    def to_file(**variables):
        path = tmp_path / "log.mat"
        with warnings.catch_warnings():
            # the library warns of what pandas will do, and of units of durations
            warnings.simplefilter("ignore")
            importlib.import_module("matio").save_to_mat(str(path), variables, version=request.param)
        return path

    return to_file


def test_a_timetable_is_read_with_the_times_of_its_rows(save):
    with read_recording(save(tt=_timetable(pd.to_timedelta(PASSED)))) as recording:
        torque = recording.channel("M_s")
        assert (torque.rate_hz, torque.start_s, torque.count) == (2000.0, 0.0, COUNT)
        assert np.array_equal(torque.values(0, COUNT), TORQUE)
        assert np.array_equal(recording.channel("X").values(0, 3), [0.0, 1.0, 2.0])
        assert set(recording.left_out) == {"tt/note"}
        assert recording.began is None


def test_a_timetable_of_dates_gives_the_date(save):
    dates = pd.DatetimeIndex(np.datetime64("2026-03-05T09:00", "ns") + PASSED)
    with read_recording(save(tt=_timetable(dates))) as recording:
        assert recording.channel("M_s").rate_hz == pytest.approx(2000.0, rel=1e-5)
        assert recording.channel("M_s").clock_jumps == ()
        assert recording.began == datetime.fromisoformat("2026-03-05T09:00")


def test_a_table_and_a_duration(save):
    table = pd.DataFrame({"time": 0.01 * np.arange(COUNT), "M_s": TORQUE})
    with read_recording(save(tab=table)) as recording:
        assert (set(recording.channels), recording.channel("M_s").rate_hz) == ({"M_s"}, 100.0)
    with read_recording(save(t=PASSED.reshape(-1, 1), u=TORQUE)) as recording:
        assert (set(recording.channels), recording.channel("u").rate_hz) == ({"u"}, 2000.0)


def _series(data, times=(), start=0.0, step=0.0, unit="", clock="seconds", length=None):
    """Return what MATLAB keeps of a timeseries: times, or the first of them and their step."""
    opaque = importlib.import_module("matio.utils.matclass").MatlabOpaque
    column = np.array(times, dtype=np.float64).reshape(-1, 1)
    of_time = {
        "Units": clock, "Time_": np.empty((0, 0)), "Start_": start, "Increment_": step,
        "Length": float(max(np.shape(data)) if length is None else length),
    }  # fmt: skip
    properties = {
        "Name": "measured", "Data_": data, "Time_": column, "IsTimeFirst_": data.ndim == 2,
        "DataInfo": opaque({"Units": unit}, "tsdata.datametadata"),
        "TimeInfo": opaque(of_time, "tsdata.timemetadata"),
    }  # fmt: skip
    return opaque(properties, "timeseries")


def test_time_series_have_the_times_that_they_keep_or_count(save):
    torque, both = TORQUE.reshape(-1, 1), np.stack([TORQUE, 2.0 * TORQUE], axis=1)
    path = save(
        M_s=_series(torque, start=3.0, step=0.01, unit="N m"),
        n=_series(both, times=5.0 * np.arange(COUNT), clock="milliseconds"),
        X=_series(both.T.reshape(1, 2, COUNT).copy(), start=0.0, step=0.5),
    )
    with read_recording(path) as recording:
        channels = {name: (one.rate_hz, one.start_s, one.unit) for name, one in recording.channels.items()}
        assert channels == {
            "M_s": (pytest.approx(100.0), 3.0, "N m"),
            "n 1": (pytest.approx(200.0), 0.0, ""),
            "n 2": (pytest.approx(200.0), 0.0, ""),
            "X 1": (pytest.approx(2.0), 0.0, ""),
            "X 2": (pytest.approx(2.0), 0.0, ""),
        }
        for name, values in (("M_s", TORQUE), ("n 2", 2.0 * TORQUE), ("X 2", 2.0 * TORQUE)):
            assert np.array_equal(recording.channel(name).values(0, COUNT), values)


@pytest.mark.parametrize("length", [2.0 * COUNT, np.nan, np.inf])
def test_a_length_that_the_samples_do_not_have_costs_that_series_alone(save, length):
    torque = TORQUE.reshape(-1, 1)
    path = save(M_s=_series(torque, step=0.01), X=_series(torque, step=0.01, length=length))
    with read_recording(path) as recording:
        assert set(recording.channels) == {"M_s"}
        assert any("a time series without" in words for words in recording.left_out.values())


def test_without_the_library_the_remedy_is_that_of_the_class(save, monkeypatch):
    path = save(tt=_timetable(pd.to_timedelta(PASSED)))
    timetable = path.rename(path.with_name("timetable.mat"))
    table = save(tab=pd.DataFrame({"time": 0.01 * np.arange(COUNT), "M_s": TORQUE}))
    monkeypatch.setitem(sys.modules, "matio", None)
    with pytest.raises(RecordingError, match=r'pip install "shaftprint\[readers\]" reads .*RowTimes'):
        read_recording(timetable)
    with pytest.raises(RecordingError, match=r'pip install "shaftprint\[readers\]" reads it.*table2struct\(tab'):
        read_recording(table)


_IDDATA = (
    "Domain", "Name", "OutputData", "OutputName", "OutputUnit", "InputData", "InputName", "InputUnit", "Period",
    "InterSample", "Ts", "Tstart", "SamplingInstants", "TimeUnit", "ExperimentName", "Notes", "UserData",
)  # fmt: skip


def _cell(*of_experiments):
    cells = np.empty((len(of_experiments), 1), dtype=object)
    cells[:, 0] = list(of_experiments)
    return cells


def _iddata(path, **properties):
    """Write an object of the System Identification Toolbox, which MATLAB keeps as a structure with a class."""
    empty = np.empty((0, 0))
    told = {"Domain": "Time", "TimeUnit": "seconds", **properties}
    record = np.empty((1, 1), dtype=[(key, object) for key in _IDDATA])
    record[0, 0] = tuple(told.get(key, empty) for key in _IDDATA)
    scipy.io.savemat(path, {"bench": scipy.io.matlab.MatlabObject(record, "iddata")})
    return path


def test_iddata_are_read_with_their_names_units_and_rates(tmp_path):
    both = np.column_stack([TORQUE, 2.0 * TORQUE])
    path = _iddata(
        tmp_path / "one.mat",
        OutputData=_cell(both), OutputName=_cell("torque", "speed"), OutputUnit=_cell("Nm", "rpm"),
        InputData=_cell(3.0 * TORQUE[:, np.newaxis]), InputName=_cell("u1"), InputUnit=_cell(""),
        Ts=_cell(4.0), Tstart=_cell(12.0), SamplingInstants=_cell(np.empty((COUNT, 0))), TimeUnit="milliseconds",
    )  # fmt: skip
    with read_recording(path) as recording:
        said = [(name, one.unit, one.rate_hz, one.start_s) for name, one in recording.channels.items()]
        assert said == [("torque", "N m", 250.0, 0.012), ("speed", "rpm", 250.0, 0.012), ("u1", "", 250.0, 0.012)]
        assert np.array_equal(recording.channel("speed").values(0, COUNT), 2.0 * TORQUE)
        assert np.array_equal(recording.channel("u1").values(0, COUNT), 3.0 * TORQUE)


def test_experiments_of_iddata_keep_their_own_times(tmp_path):
    instants = 0.1 * np.arange(COUNT)[:, np.newaxis]
    path = _iddata(
        tmp_path / "two.mat",
        OutputData=_cell(TORQUE[:, np.newaxis], TORQUE[:50, np.newaxis]), OutputName=_cell("y1"),
        InputData=_cell(np.empty((COUNT, 0)), np.empty((50, 0))),
        Ts=_cell(np.empty((0, 0)), 0.02), Tstart=_cell(np.empty((0, 0)), np.empty((0, 0))),
        SamplingInstants=_cell(instants, np.empty((50, 0))),
    )  # fmt: skip
    with read_recording(path) as recording:
        said = [(name, round(one.rate_hz, 6), one.count) for name, one in recording.channels.items()]
    assert said == [("bench(1).y1", 10.0, COUNT), ("bench(2).y1", 50.0, 50)]


def test_other_objects_of_matlab_are_refused_with_what_to_save(tmp_path):
    path = _iddata(tmp_path / "frd.mat", Domain="Frequency", OutputData=_cell(TORQUE[:, np.newaxis]))
    with pytest.raises(RecordingError, match="bench: expected samples in time, found an iddata of frequencies"):
        read_recording(path)
    record = np.zeros((1, 1), dtype=[("num", object)])
    scipy.io.savemat(path, {"model": scipy.io.matlab.MatlabObject(record, "idtf")})
    with pytest.raises(RecordingError, match="found a MATLAB idtf, which only MATLAB can open; save the vectors"):
        read_recording(path)
