import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shaftprint.errors import SignalError
from shaftprint.signals.pulses._pulses import number_pulses


def steady(count: int = 60, period: float = 100.0, jitter: float = 0.5, seed: int = 0) -> np.ndarray:
    return period * np.arange(count) + jitter * np.random.default_rng(seed).standard_normal(count)


def test_clean_pulses_are_numbered_one_by_one():
    train = number_pulses(steady(), channel="P")
    assert np.array_equal(train.number, np.arange(60))
    assert train.faults == ()


@pytest.mark.parametrize("missing", [[20], [20, 22], [20, 21], [20, 21, 22], [1], [57], [15, 40]])
def test_missing_pulses_leave_the_numbers_of_the_others(missing):
    full = steady()
    train = number_pulses(np.delete(full, missing), channel="P")
    assert np.array_equal(train.number, np.delete(np.arange(60), missing))
    assert sum(fault.count for fault in train.faults) == len(missing)
    assert {fault.kind for fault in train.faults} == {"missing pulse"}
    assert train.faults[0].position == pytest.approx(full[missing[0]], abs=2.0)


@pytest.mark.parametrize("part", [0.02, 0.3, 0.5, 0.7, 0.98])
def test_doubled_pulse_is_dropped_wherever_it_lies(part):
    full = steady()
    extra = full[30] + part * 100.0
    train = number_pulses(np.sort(np.append(full, extra)), channel="P")
    assert np.array_equal(train.position, full)
    assert [(fault.kind, fault.count) for fault in train.faults] == [("doubled pulse", 1)]
    assert train.faults[0].position == extra


def test_two_doubled_pulses_beside_each_other_are_dropped():
    full = steady()
    extra = full[[30, 31]] + 30.0
    train = number_pulses(np.sort(np.append(full, extra)), channel="P")
    assert np.array_equal(train.position, full)


def test_missing_and_doubled_close_together():
    full = steady()
    faulty = np.sort(np.append(np.delete(full, 33), full[30] + 10.0))
    train = number_pulses(faulty, channel="P")
    assert np.array_equal(train.number, np.delete(np.arange(60), 33))
    assert [fault.kind for fault in train.faults] == ["doubled pulse", "missing pulse"]


@settings(deadline=None, max_examples=60)
@given(
    ratio=st.floats(0.55, 1.8),
    lag=st.floats(0.05, 2.0),
    phase=st.floats(0.0, 1.0),
    period_s=st.sampled_from([0.05, 0.2]),
)
def test_steps_of_the_speed_are_no_faults(ratio, lag, phase, period_s):
    # speed 1 -> ratio with a first-order lag: the largest steps of the thesis change it by 74 %
    time = np.arange(0.0, 20.0, 1e-3)
    speed = np.where(time < 8.0, 1.0, ratio + (1.0 - ratio) * np.exp(-(time - 8.0) / lag)) / period_s
    angle = np.concatenate([[0.0], np.cumsum(speed[:-1]) * 1e-3]) + phase
    pulses = np.interp(np.arange(1, int(angle[-1])), angle, time)
    assert number_pulses(pulses, channel="P").faults == ()


def test_sine_of_the_speed_is_no_fault():
    time = np.arange(0.0, 60.0, 1e-3)
    for frequency in (0.1, 0.8, 1.6, 3.4):
        angle = np.cumsum(5.0 * (1.0 + 0.2 * np.sin(2 * np.pi * frequency * time))) * 1e-3
        pulses = np.interp(np.arange(1, int(angle[-1])), angle, time)
        assert number_pulses(pulses, channel="P").faults == ()


def test_uneven_strips_are_no_fault():
    places = np.array([0.0, 0.29, 0.5, 0.72])
    pulses = (np.arange(40)[:, np.newaxis] + places).ravel() * 400.0
    assert number_pulses(pulses, channel="P").faults == ()


def test_too_few_pulses():
    with pytest.raises(SignalError, match="channel PTM_1: expected at least 20 pulses, found 19"):
        number_pulses(steady(19), channel="PTM_1")


def test_too_many_faults():
    # every ninth on average, but not every ninth: that would be a wheel of nine teeth of which one is missing
    gone = np.arange(10, 190, 9) + np.random.default_rng(2).integers(-3, 4, 20)
    kept = np.delete(steady(200), gone)
    with pytest.raises(
        SignalError, match=r"channel PTM_1: expected regular pulses, found \d+ missing or doubled among"
    ):
        number_pulses(kept, channel="PTM_1")


def test_short_interval_that_fits_nowhere_is_left_alone():
    # a jump of the phase, not a pulse too many
    pulses = np.concatenate([steady(30), steady(30) + 2900.0 + 60.0 - 12.0])
    pulses[30:] += 0.0
    train = number_pulses(pulses, channel="P")
    assert train.position.size == 60
