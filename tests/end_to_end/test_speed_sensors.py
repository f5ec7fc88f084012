"""A quarter of an hour of the tug from toothed wheels, an instrument, encoders: the response of the even wheel."""

import numpy as np
import pytest

from shaftprint.tug import sail
from shaftprint.vessel import Vessel

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def measured(vessel, short_campaign, identified, tmp_path_factory):
    """Response of the same voyage as another sensor shows it."""
    folder = tmp_path_factory.mktemp("speeds")

    def response(**fields):
        content = vessel.model_dump()
        content["sensors"]["speed"] = [{"name": "n_x", "channel": "X", "shaft": "propeller", "unit": "V", **fields}]
        ship = Vessel.model_validate(content)
        path = folder / f"{len(list(folder.iterdir()))}.nc"
        sail(ship, short_campaign, path, seed=1)
        return identified(path, short_campaign, ship=ship).spectra.response

    return response


@pytest.fixture(scope="module")
def even(measured):
    return measured(wheel="60")


@pytest.mark.parametrize(
    "fields",
    [
        pytest.param({"wheel": "60-2"}, id="60-2"),
        pytest.param({"wheel": "36-1"}, id="36-1"),
        pytest.param({"wheel": "36-2-1"}, id="36-2-1", marks=pytest.mark.long),
        pytest.param({"unit": "rpm", "shaft": "engine", "latency_s": 0.02}, id="rpm"),
        pytest.param({"unit": "deg"}, id="deg"),
        pytest.param(
            {"unit": "counts", "shaft": "engine", "counts_per_revolution": 2048.0, "rolls_over_at": 65_536.0},
            id="counts",
        ),
    ],
)
def test_every_sensor_gives_the_response_of_the_even_wheel(measured, even, fields):
    response = measured(**fields)
    assert response.lines == even.lines
    used = response.used & even.used
    variance = np.diagonal(even.covariance, axis1=1, axis2=2)
    std = np.sqrt(variance[:, :2] + variance[:, 2:])
    apart = np.abs(response.response[:, 0] - even.response[:, 0]).T[used] / std[used]
    # the same sea, the same engine, the same gauge: what differs is how the speed was seen
    assert apart.max() < 0.5
