"""A torque gauge whose zero nobody knows: ``k_q`` finds it from the dynamics, in a raw recording of a quarter hour.

With ``M_s0' = M_s0 (1 + d)`` the deviations of the torque come out too small by ``1 + d``, and the slope 2 of the
propeller law with them.
"""

import pytest

from shaftprint.tug import Tug, sail


@pytest.mark.slow
@pytest.mark.parametrize("offset", [0.03, 0.0, -0.02])
def test_zero_of_the_gauge_is_found_within_half_a_percentage_point(
    vessel, short_campaign, identified, tmp_path, offset
):
    path = tmp_path / "offset.nc"
    truth = sail(vessel, short_campaign, path, tug=Tug(torque_zero_offset_nm=offset * 1725.0), seed=5)
    assert truth.physical["torque_zero_offset_nm"] == pytest.approx(offset * 1725.0)
    fit = identified(path, short_campaign).fit
    slope = fit.value("k_q")
    assert 2.0 / slope - 1.0 == pytest.approx(offset, abs=0.005)
    # and the fit knows how far off it may be: k_q to 0.005 is a quarter of a point
    stated = next(estimate for estimate in fit.parameters if estimate.name == "k_q").std
    assert abs(slope - 2.0 / (1.0 + offset)) < 3.0 * stated
    assert stated < 0.005
