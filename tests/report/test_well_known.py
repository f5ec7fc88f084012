"""What a test is said to know: by the interval where the standard deviation is too small."""

from types import SimpleNamespace

import pytest

from shaftprint.fingerprint import Quantity
from shaftprint.report.sections import summary_section

STOPPED = {"name": "omega_n", "unit": "rad/s", "value": 10.948, "std": 0.092}


@pytest.fixture
def well_known(fingerprint):
    """Whether the summary says that a quantity is known to 3 %."""

    def said(**quantity):
        alone = {"parameters": (Quantity(**quantity),), "combinations": (), "physical": ()}
        text = " ".join(summary_section(SimpleNamespace(fingerprint=fingerprint.model_copy(update=alone))).paragraphs)
        assert ("This test knows to better than 3 %" in text) == (f"{quantity['name']} = " in text)
        return f"{quantity['name']} = " in text

    return said


def test_a_wide_interval_outweighs_a_small_deviation(well_known):
    assert well_known(**STOPPED)
    # 0.998 rad/s below is 1.96 standard deviations of 4.65 %
    assert not well_known(**STOPPED, interval_95=(9.95, 11.04))
    # 1.96 times 3 % of the value is 0.6437 rad/s
    assert well_known(**STOPPED, interval_95=(10.948 - 0.643, 11.04))
    assert not well_known(**STOPPED, interval_95=(10.948 - 0.645, 11.04))


def test_without_an_interval_the_deviation_counts(well_known):
    assert well_known(name="K_Q", unit="-", value=0.05, std=0.00149)
    assert not well_known(name="K_Q", unit="-", value=0.05, std=0.00151)
    assert not well_known(name="g", unit="-", value=0.0, std=0.1)
