"""A second test after a first one: what was found is assumed, and what was measured counts."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.design import replan, ship_of_fit
from shaftprint.errors import DesignError
from shaftprint.identify import Draw, Settings, expected_response, identify, identify_jointly, planned_lines
from shaftprint.survey import STAN_TUG_NOISE

pytestmark = pytest.mark.slow


class At(Draw):
    """One start, at given parameters."""

    def __init__(self, theta):
        self.theta = theta

    def starts(self, lower, upper, count, rng):
        return self.theta[None, :]


@pytest.fixture(scope="module")
def fit(plan, truth):
    """A fit to the exact responses of the legs of a plan."""
    pairs = []
    for line, leg in zip(plan.structures, plan.legs, strict=True):
        lines = planned_lines(
            leg.frequency_hz, noise=STAN_TUG_NOISE, amplitude=np.abs(leg.amplitudes), duration_s=leg.window_s
        )
        pairs.append((line, expected_response(lines, line, truth)))
    start = At(np.array([truth[p.name] for p in plan.ship.structure.free]))
    return identify_jointly(pairs, rng=np.random.default_rng(1), settings=Settings(starts=1, draw=start))


def test_line_of_a_fit_has_its_values_and_covariance(plan, fit, truth):
    line = ship_of_fit(structure("GAUGE-CLOSED"), fit)
    assert line.structure.factors == {}
    for name, value in truth.items():
        place = line.structure.names.index(name)
        assert line.values[place] == pytest.approx(value, rel=1e-4, abs=1e-4)
        assert np.sqrt(line.covariance[place, place]) == pytest.approx(plan.predicted.estimate(name).std, rel=1e-3)


def test_both_tests_together_know_more_than_the_second_alone(plan, fit, quick):
    """The same plan once more: what both know is what one of twice the length would, or better."""
    second = replan(plan, fit, within_s=360.0, rng=np.random.default_rng(2), effort=quick)
    assert len(second.earlier) == 2
    for name in ("K_p", "t_d", "tau_dn"):
        assert second.predicted.estimate(name).std < 0.85 * plan.predicted.estimate(name).std
    alone = replace(second, earlier=())
    assert alone.legs == second.legs
    # the first test makes the line known well enough for the limits to be nearly those of the exact line
    for leg, first in zip(second.legs, plan.legs, strict=True):
        assert leg.peak_rpm > 0.6 * first.peak_rpm


def test_fit_of_another_structure_is_refused(make_closed_fit):
    with pytest.raises(DesignError, match="assumed ship GAUGE-CLOSED: expected a fit with t_d"):
        ship_of_fit(structure("GAUGE-CLOSED"), make_closed_fit)


@pytest.fixture(scope="module")
def make_closed_fit():
    """A fit of a structure of the thesis, without delay."""
    chosen = structure("CL1")
    lines = planned_lines(np.geomspace(0.02, 2.0, 12), noise=STAN_TUG_NOISE, amplitude=0.1, duration_s=60.0)
    return identify(chosen, expected_response(lines, chosen), rng=np.random.default_rng(1))
