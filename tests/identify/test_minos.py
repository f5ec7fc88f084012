"""Profile-likelihood intervals beside those of another program: MINOS of iminuit, on the same cost."""

import numpy as np
import pytest
from iminuit import Minuit

from shaftprint.catalogue import structure
from shaftprint.identify import Prior, Settings, identify, profile_intervals

pytestmark = pytest.mark.slow


BENCHMARK = {"tau_n": 0.4, "K_p": 4.0, "K_i": 5.0, "g": -0.5, "v": 1.0}
GAUGE = {"tau_dn": 0.32, "tau_up": 1.016, "k_q": 2.0, "g": 0.0, "v": 1.0, "K_p": 5.7, "K_i": 4.27, "t_d": 0.07}
GAUGE |= {"t_sp": 0.05, "omega_n": 10.3, "zeta": 0.47, "c_set": 1.0, "t_gauge": 0.0}
PRIORS = {"g": Prior(0.0, 0.1), "tau_up": Prior(1.016, 0.05)}

MOST_PLACES = 8
# Structure, truth, noise, seed, priors, and the ends that a bound of the search sets.
PROBLEMS = {
    "open loop": (structure("OL5"), None, 0.05, 8, {}, set()),
    "curved valley": (structure("CL4"), None, 0.05, 8, {}, set()),
    "at a bound": (structure("CL4").free_between(omega_n=(7.0, 9.0)), None, 0.05, 8, {}, {("omega_n", 1)}),
    "unidentifiable": (structure("BENCHMARK"), BENCHMARK, 0.002, 5, {}, {("v", 1), ("K_i", 1)}),
    "with priors": (structure("GAUGE-CLOSED").held_at(c_set=1.0, t_gauge=0.0), GAUGE, 0.01, 8, PRIORS, set()),
}


def minos(found):
    """Return the 95 % interval of MINOS for every free parameter; an end that is no crossing is not a number.

    Along a valley MINOS may lose its way and says so; then it is asked again from another place.
    """
    rng = np.random.default_rng(1)
    start, parameters = np.array([e.value for e in found.parameters]), found.structure.free
    ends = {}
    for _ in range(MOST_PLACES):
        search = _searched(found, start)
        for name, error in search.merrors.items():
            at_limit = (error.at_lower_limit, error.at_upper_limit)
            valid = (error.lower_valid or at_limit[0], error.upper_valid or at_limit[1])
            moved = search.values[name] + np.array([error.lower, error.upper])
            if all(valid):
                ends.setdefault(name, np.where(at_limit, np.nan, moved))
        if len(ends) == start.size:
            break
        lower, upper = np.array([(p.lower, p.upper) for p in parameters]).T
        start = np.clip(start * rng.uniform(0.8, 1.25, start.size), lower, upper)
    return ends


def _searched(found, start):
    """Return MINOS' search from a place, done."""

    def chi_square(theta):
        residuals, _ = found.objective.residuals(np.asarray(theta)[None])
        return float(residuals[0] @ residuals[0])

    def slopes(theta):
        residuals, jacobian = found.objective.residuals(np.asarray(theta)[None])
        return 2.0 * jacobian[0] @ residuals[0]

    parameters = found.structure.free
    search = Minuit(chi_square, start, name=[p.name for p in parameters], grad=slopes)
    search.errordef = 1.0
    search.strategy = 2
    search.tol = 1e-4
    for parameter, estimate in zip(parameters, found.parameters, strict=True):
        width = parameter.upper - parameter.lower
        search.limits[parameter.name] = (parameter.lower, parameter.upper)
        search.errors[parameter.name] = estimate.std if np.isfinite(estimate.std) else 0.1 * width
    search.migrad()
    search.minos(cl=0.95)
    return search


@pytest.mark.parametrize("case", PROBLEMS)
def test_ends_agree_with_minos_to_one_percent(make_response, case):
    model, truth, noise, seed, priors, stopped = PROBLEMS[case]
    response = make_response(
        model.name if truth is None else model, truth, noise=noise, rng=np.random.default_rng(seed)
    )
    found = identify(model, response, rng=np.random.default_rng(1), settings=Settings(priors=priors))
    theirs, ours = minos(found), profile_intervals(found)
    open_ends = set()
    for estimate in found.parameters:
        interval = ours[estimate.name]
        for side, end, is_open in ((0, interval.lower, interval.lower_open), (1, interval.upper, interval.upper_open)):
            other = theirs[estimate.name][side]
            assert np.isnan(other) == is_open
            if is_open:
                open_ends.add((estimate.name, side))
                bounds = next((p.lower, p.upper) for p in model.free if p.name == estimate.name)
                assert end == pytest.approx(bounds[side], rel=1e-9)
            else:
                assert abs(end - other) < 0.01 * abs(other - estimate.value)
    assert open_ends == stopped
