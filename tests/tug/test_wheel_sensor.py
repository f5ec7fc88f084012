"""The pick-up of a toothed wheel on the simulated tug: teeth where the truth says, gaps where there are none."""

import numpy as np
import pytest

from shaftprint.errors import SettingsError
from shaftprint.recording import read_recording
from shaftprint.tug import Tug, sail
from shaftprint.vessel import Vessel


def with_wheel(vessel, wheel, *, shaft="propeller", **logger):
    content = vessel.model_dump()
    one = {"name": "n_e", "channel": "PTM_w", "shaft": shaft, "unit": "V", "wheel": wheel}
    content["sensors"]["speed"] = [one]
    content["logger"].update(logger)
    return Vessel.model_validate(content)


@pytest.mark.parametrize(
    ("wheel", "longest"), [("60-2", [3]), ("36-1", [2]), ("36-2-1", [3, 2]), ("12+1", [0.55, 0.45])]
)
def test_teeth_pass_where_the_wheel_has_them(vessel, ask, quiet_tug, tmp_path, wheel, longest):
    path = tmp_path / "wheel.nc"
    truth = sail(
        with_wheel(vessel, wheel), ask(40.0), path, tug=Tug(noise=quiet_tug.noise, tooth_error_deg=0.0), seed=1
    )
    with read_recording(path) as recording:
        volts = recording.channels["PTM_w"].values(0, 80_000)
    high = volts > 2.5
    edges = np.flatnonzero(high[1:] & ~high[:-1]) / 2000.0
    places = int(wheel.replace("+", "-").split("-")[0])
    turns_hz = 1183.8 / 60.0 / 3.82
    # each interval in places, to the half millisecond of the logger
    intervals = np.diff(edges) * turns_hz * places
    tolerance = 0.0005 * turns_hz * places
    turn = round(places * sum(1 for _ in intervals) / intervals.sum())
    for size in longest:
        count = np.count_nonzero(np.abs(intervals - size) < tolerance + 1e-9)
        assert count == pytest.approx(40.0 * turns_hz, abs=1.5)
    others = intervals[np.all(np.abs(intervals[:, np.newaxis] - longest) > tolerance + 1e-9, axis=1)]
    assert others == pytest.approx(np.ones(others.size), abs=tolerance)
    strips = truth.strips[0].angle_deg
    assert sum(strips) == pytest.approx(360.0)
    assert len(strips) == turn - (wheel == "12+1")


def test_errors_of_the_teeth_are_told(vessel, ask, quiet_tug, tmp_path):
    tug = Tug(noise=quiet_tug.noise, tooth_error_deg=0.1)
    truth = sail(with_wheel(vessel, "36-1"), ask(5.0), tmp_path / "wheel.nc", tug=tug, seed=1)
    angles = np.array(truth.strips[0].angle_deg)
    # of two teeth, each off by a tenth of a degree
    assert np.std(angles[:-1] - 10.0) == pytest.approx(0.1 * np.sqrt(2.0), rel=0.35)
    assert angles[-1] == pytest.approx(20.0, abs=0.5)


@pytest.mark.parametrize(
    ("wheel", "shaft", "rate"), [("60-2", "engine", 7200), ("36-1", "engine", 4400), ("12+1", "engine", 2900)]
)
def test_a_logger_that_is_too_slow_for_the_wheel_is_refused(vessel, ask, tmp_path, wheel, shaft, rate):
    ship = with_wheel(vessel, wheel, shaft=shaft)
    with pytest.raises(SettingsError, match=rf"a logger of {rate} Hz or more for channel PTM_w.* found 2000 Hz"):
        sail(ship, ask(5.0), tmp_path / "wheel.nc", seed=1)
    assert not (tmp_path / "wheel.nc").exists()
