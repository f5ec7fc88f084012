"""A table of a response: its values, their conjugates, straight lines between, nothing else outside."""

import numpy as np
import pytest

from shaftprint.errors import StructureError
from shaftprint.models import Gain, Parameter, Structure, check_structure
from shaftprint.models._tabulated import Tabulated

TABLE = Tabulated(np.array([1.0, 2.0, 4.0]), np.array([1.0 + 1.0j, 3.0 - 1.0j, 5.0 + 0.0j]))


def test_values_between_and_outside():
    omega = np.array([0.5, 1.0, 1.5, 3.0, 4.0, 40.0])
    expected = [1.0 + 1.0j, 1.0 + 1.0j, 2.0, 4.0 - 0.5j, 5.0, 5.0]
    assert TABLE.transfer(1j * omega) == pytest.approx(expected)
    assert TABLE.transfer(-1j * omega) == pytest.approx(np.conj(expected))


def test_it_composes_with_blocks_of_parameters():
    gain = Parameter("k", "-", 0.0, 5.0, 2.0, "gain")
    mine = Structure(name="MINE", title="m", input="u", outputs={"y": Gain(gain) * TABLE})
    check_structure(mine)
    assert mine.response([3.0], [2.0j])[0, 0] == pytest.approx(9.0 - 3.0j)


@pytest.mark.parametrize(
    ("omega", "values", "message"),
    [
        ([1.0, 2.0], [1.0], r"expected a value for each of one or more frequencies, found \(1,\) for \(2,\)"),
        ([], [], "expected a value for each"),
        ([2.0, 1.0], [1.0, 1.0], "expected frequencies above 0 rad/s in ascending order"),
        ([0.0, 1.0], [1.0, 1.0], "expected frequencies above 0"),
    ],
)
def test_what_is_no_table_is_refused(omega, values, message):
    with pytest.raises(StructureError, match=message):
        Tabulated(np.array(omega), np.array(values))
