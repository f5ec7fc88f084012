"""Deviations from the scatter of slopes by cluster, where noise is alike within a window."""

import numpy as np
import pytest

from shaftprint.identify import Settings
from shaftprint.models import FirstOrderLag, Gain, Parameter, Structure
from shaftprint.time_domain import TimeSettings, identify_in_time, record_from_arrays
from shaftprint.time_domain.nonlinear._covariance import with_scatter_of_blocks

GAIN = Parameter("k", "-", 0.1, 5.0, 1.0, "gain")
LAG = Parameter("T", "s", 0.01, 1.0, 0.02, "lag", held=True)
PLAIN = Structure(name="GAIN", title="A gain", input="u", outputs={"y": Gain(GAIN) * FirstOrderLag(LAG)})


def test_what_is_one_in_a_window_counts_once_for_each_window():
    """Each of 30 windows of 40 s has an input of its own and a disturbance ``b`` that lasts for the window.

    The error of the gain is ``sum u b / sum u^2``, with the deviation ``s / (sum u^2)^0.5`` whatever the number of
    samples; independent blocks of 4 s would make it a third of that. Thirty windows tell it to 13 %.
    """
    rng = np.random.default_rng(2)
    windows, seconds, rate_hz, size = 30, 40, 5.0, 0.1
    level = np.repeat(rng.uniform(0.5, 1.5, windows), int(seconds * rate_hz))
    disturbance = np.repeat(size * rng.standard_normal(windows), int(seconds * rate_hz))
    output = level + disturbance + 0.02 * rng.standard_normal(level.size)
    used = np.tile(np.arange(int(seconds * rate_hz)) >= 5, windows)
    record = record_from_arrays("windows", {"u": level}, {"y": output}, rate_hz=rate_hz, used=used)
    plain = TimeSettings(drift_degree=-1, rounds=0)
    found = identify_in_time([(PLAIN, record)], rng=rng, settings=Settings(starts=1), time=plain, start={"k": 1.0})
    stated = with_scatter_of_blocks(found).parameters[0].std
    each = level[:: int(seconds * rate_hz)]
    assert stated == pytest.approx(size / np.sqrt(np.sum(each**2)), rel=0.4)
