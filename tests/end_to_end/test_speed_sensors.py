"""A quarter of an hour of the tug from toothed wheels and from an instrument: the numbers of the even wheel."""

import numpy as np
import pytest

from shaftprint.tug import sail
from shaftprint.vessel import Vessel

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def fitted(vessel, short_campaign, identified, tmp_path_factory):
    """Fit of the same voyage as another sensor shows it."""
    folder = tmp_path_factory.mktemp("speeds")

    def fit(**fields):
        content = vessel.model_dump()
        content["sensors"]["speed"] = [{"name": "n_x", "channel": "X", "shaft": "propeller", "unit": "V", **fields}]
        ship = Vessel.model_validate(content)
        path = folder / f"{len(list(folder.iterdir()))}.nc"
        sail(ship, short_campaign, path, seed=1)
        return identified(path, short_campaign, ship=ship).fit

    return fit


@pytest.fixture(scope="module")
def even(fitted):
    return fitted(wheel="60")


@pytest.mark.parametrize(
    "fields",
    [
        pytest.param({"wheel": "60-2"}, id="60-2"),
        pytest.param({"wheel": "36-1"}, id="36-1"),
        pytest.param({"wheel": "36-2-1"}, id="36-2-1"),
        pytest.param({"unit": "rpm", "shaft": "engine", "latency_s": 0.02}, id="rpm"),
    ],
)
def test_every_sensor_gives_the_numbers_of_the_even_wheel(fitted, even, fields):
    fit = fitted(**fields)
    assert [one.name for one in fit.parameters] == [one.name for one in even.parameters]
    apart = (fit.values - even.values) / np.sqrt(np.diag(even.covariance))
    # the same sea, the same engine, the same gauge: what differs is how the speed was seen
    assert np.abs(apart).max() < 0.5
