"""What is assumed of the noise where a short test has seen none."""

import numpy as np
import pytest

from shaftprint.identify import NoiseLevels
from shaftprint.survey._assumed_noise import continued_below


def levels(frequency_hz, speed, torque, outputs=("n", "M_s")):
    """Noise whose outputs have nothing in common, but for a tenth."""
    root = np.sqrt(np.stack([speed, torque], axis=1))
    shape = np.array([[1.0, 0.1], [0.1, 1.0]])
    return NoiseLevels(
        frequency_hz=frequency_hz,
        density=shape * root[:, :, None] * root[:, None, :],
        outputs=outputs,
        set_point_per_v=0.2,
    )


def short_and_usual():
    """A ship with 4 times the usual noise of the speed and 9 times that of the torque, seen from 0.1 Hz on."""
    slow, fast = np.array([0.02, 0.05]), np.array([0.1, 0.3, 0.5, 1.0])
    every = np.concatenate([slow, fast])
    short = levels(fast, 4.0 * fast, 9.0 / fast)
    return short, levels(every, every, 1.0 / every), slow


def test_below_its_slowest_line_a_recording_goes_on_as_is_usual():
    """The governor holds the slow speed, the torque wanders: neither stays as it was at the slowest line."""
    short, usual, slow = short_and_usual()
    (whole,) = continued_below({1200.0: short}, {1200.0: usual}).values()
    density = whole.at(slow)
    assert density[:, 0, 0].real == pytest.approx(4.0 * slow)
    assert density[:, 1, 1].real == pytest.approx(9.0 / slow)
    assert density[:, 0, 1].real == pytest.approx(np.full(2, 0.1 * 6.0))
    assert whole.at(short.frequency_hz) == pytest.approx(short.density)


def test_what_was_recorded_or_has_other_outputs_stays():
    short, usual, _ = short_and_usual()
    other = levels(usual.frequency_hz, usual.frequency_hz, usual.frequency_hz, outputs=("n", "X"))
    for stated in ({1200.0: other}, {}, {1200.0: short}):
        (same,) = continued_below({1200.0: short}, stated).values()
        assert same.frequency_hz == pytest.approx(short.frequency_hz)
        assert same.density == pytest.approx(short.density)
