"""The shipped campaign against tables 2.3, 3.3 and 3.5 of the thesis."""

import numpy as np
import pytest

from shaftprint.campaign import load_campaign

# Table 3.5: line, i, frequency [Hz], start [s], stop [s]
TABLE_3_5 = [
    ("S1", 4, 0.0044, 476.9, 1385.99),
    ("S2", 4, 0.0092, 1433.0, 1867.78),
    ("S3", 6, 0.0193, 1962.0, 2272.88),
    ("S4", 8, 0.0275, 2365.0, 2655.91),
    ("S5", 11, 0.0405, 2735.0, 3006.61),
    ("S6", 13, 0.06, 3048.0, 3264.67),
    ("S7", 18, 0.0848, 3282.0, 3494.26),
    ("S8", 21, 0.11, 3540.0, 3730.91),
    ("S9", 41, 0.1778, 3755.0, 3985.60),
    ("S10", 65, 0.3728, 4009.0, 4183.36),
    ("S11", 139, 0.7814, 4219.0, 4396.89),
    ("S12", 211, 1.637, 4481.0, 4609.89),
    ("S13", 240, 3.433, 4630.0, 4699.91),
    ("S14", 431, 7.19, 4840.0, 4899.94),
    ("S15", 450, 15.01, 5020.0, 5049.98),
    ("S16", 632, 31.644, 5234.0, 5253.97),
]


@pytest.fixture(scope="module")
def thesis():
    return load_campaign("thesis")


@pytest.mark.parametrize(("name", "periods", "frequency", "start", "stop"), TABLE_3_5)
def test_windows_of_table_3_5(thesis, name, periods, frequency, start, stop):
    sine = next(sine for sine in thesis.sines if sine.name == name)
    assert (sine.frequency_hz, sine.settled_s) == (frequency, start)
    assert sine.periods == periods
    # S5 stops at 3006.60494 s: the table rounds T to 271.605 s first and then the sum to two decimals
    assert sine.window_stop_s == pytest.approx(stop, abs=0.0051)
    assert sine.window_s == pytest.approx(stop - start, abs=0.0051)
    assert sine.start_s == pytest.approx(start - 10.0)
    assert sine.amplitude_v == 0.6
    assert sine.stop_s >= sine.window_stop_s


def test_there_are_sixteen_sines_four_chirps_and_two_staircases(thesis):
    assert len(thesis.sines) == 16
    assert [chirp.name for chirp in thesis.chirps] == ["C11", "C21", "C22", "C23"]
    assert [stairs.name for stairs in thesis.staircases] == ["St1", "St2"]
    assert [item.name for item in thesis.excitations][-6:] == ["St1", "St2", "C11", "C21", "C22", "C23"]
    assert thesis.offset_v == -5.0
    assert thesis.duration_s == 11450.0


def test_chirps_of_table_2_3(thesis):
    rows = [(c.start_s, c.stop_s, c.start_frequency_hz, c.stop_frequency_hz) for c in thesis.chirps]
    assert rows == [
        (8850.0, 9450.0, 0.001, 3.981),
        (9600.0, 10150.0, 0.001, 0.02),
        (10200.0, 10750.0, 0.015, 0.27),
        (10900.0, 11450.0, 0.1, 3.981),
    ]


def test_staircases_step_as_in_the_tables(thesis):
    first, second = thesis.staircases
    assert np.abs(np.diff(first.levels_v)).tolist() == [1.0] * 6
    assert (min(first.levels_v), max(first.levels_v)) == (-6.0, -3.0)
    # table 3.3: six steps, the first after 58.9 s and then every minute
    steps_s = [58.91, 119.505, 178.595, 239.045, 298.695, 358.585]
    assert first.dwell_s == pytest.approx(np.mean(np.diff(steps_s)), abs=0.1)
    assert np.abs(np.diff(second.levels_v)).tolist() == [2.0] * 4
    assert (min(second.levels_v), max(second.levels_v)) == (-7.0, -3.0)
    assert first.start_s == 7150.0
    assert first.stop_s <= 7600.0
    assert second.start_s == 7900.0
    assert second.stop_s <= 8300.0
