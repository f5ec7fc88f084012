"""What a test is said to know: by the interval where the standard deviation is too small."""

import pytest

from shaftprint.fingerprint import Quantity
from shaftprint.report.sections._results import _share


def test_a_wide_interval_outweighs_a_small_deviation():
    stopped = Quantity(name="omega_n", unit="rad/s", value=10.948, std=0.092, interval_95=(9.95, 11.04))
    assert _share(stopped) == pytest.approx(0.0465, abs=1e-4)


def test_without_an_interval_the_deviation_counts():
    assert _share(Quantity(name="K_Q", unit="-", value=0.05, std=0.001)) == pytest.approx(0.02)
    assert _share(Quantity(name="g", unit="-", value=0.0, std=0.1)) == float("inf")
