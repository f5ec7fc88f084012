"""Intervals of the margins: the contour of the likelihood, followed to its ends."""

import numpy as np
import pytest

from shaftprint.fingerprint import margin_quantities
from shaftprint.identify import profile
from shaftprint.models import loop_gain, margins


@pytest.fixture(scope="module")
def profiled(gauge_fit):
    return profile(gauge_fit)


def test_points_lie_on_the_contour_that_belongs_to_95_percent(gauge_fit, profiled):
    free = [gauge_fit.structure.names.index(p.name) for p in gauge_fit.structure.free]
    residuals, _ = gauge_fit.objective.residuals(profiled.points[:, free])
    rise = np.sum(residuals**2, axis=1) - 2.0 * gauge_fit.cost
    ends = list(profiled.intervals.values())
    closed = np.array([not flag for end in ends for flag in (end.lower_open, end.upper_open)])
    np.testing.assert_allclose(rise[closed], 1.959964**2, rtol=0.012)
    assert np.all(rise[~closed] < 1.959964**2)


def test_each_interval_ends_where_the_margin_of_a_point_does(gauge_fit, profiled):
    found = {quantity.name: quantity for quantity in margin_quantities(gauge_fit, profiled)}
    reached = [margins(gauge_fit.structure, point) for point in profiled.points]
    for name, values in (
        ("gain margin", [m.gain_margin for m in reached]),
        ("phase margin", [np.degrees(m.phase_margin_rad) for m in reached]),
        ("delay margin", [m.delay_margin_s for m in reached]),
    ):
        lower, upper = found[name].interval_95
        assert lower <= found[name].value <= upper
        assert (lower, upper) == pytest.approx((min(values), max(values)))


def test_the_loop_passes_minus_one_at_both_ends_of_the_gain_margin(gauge_fit, profiled):
    gain = next(q for q in margin_quantities(gauge_fit, profiled) if q.name == "gain margin")
    reached = [margins(gauge_fit.structure, point) for point in profiled.points]
    for end in gain.interval_95:
        place = int(np.argmin([abs(m.gain_margin - end) for m in reached]))
        at = loop_gain(gauge_fit.structure, profiled.points[place], 1j * reached[place].gain_margin_rad_s)
        assert end * at[0] == pytest.approx(-1.0, abs=1e-6)


def test_without_a_profile_there_is_no_interval(gauge_fit):
    assert all(quantity.interval_95 is None for quantity in margin_quantities(gauge_fit))
