"""Where the uncertainty of physical values comes from: against simulated tests of simulated vessels and gauges."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.fingerprint import physical_quantities
from shaftprint.identify import Prior, Settings, identify, priors_from_vessel, profile, refit

TESTS = 800
# A standard deviation from so many tests is known to 2.5 %; three of them, and two percent that first order leaves.
TOLERANCE = 0.095


@pytest.fixture(scope="module")
def known(vessel, working_point):
    return priors_from_vessel(structure("GAUGE-CLOSED"), vessel, working_point)


@pytest.fixture(scope="module")
def found(fit, truth, known):
    return fit("GAUGE-CLOSED", truth, share=0.0005, settings=Settings(starts=20, priors=known))


@pytest.fixture(scope="module")
def simulated(found, vessel, working_point, truth):
    """Draw inertia of the calculation, gauge, engine slope, latency and noise; fit; return the physical values."""
    rng = np.random.default_rng(20)
    gauge = vessel.sensors.shaft_torque
    torque, shaft_rev_s = working_point.shaft_torque_nm, working_point.engine_speed_rev_s / vessel.gearbox.ratio
    scale = 1.0 + gauge.scale_std_fraction * rng.standard_normal(TESTS)
    # the true inertia is what the truth of tau_up says; the calculation misses it by its standard deviation
    inertia = truth["tau_up"] * torque / (2.0 * np.pi * shaft_rev_s)
    told = inertia + vessel.inertia_upstream_std_kg_m2 * rng.standard_normal(TESTS)
    # the gauge shows `scale` times the torque: the responses, divided by its mean, stay what they are
    shown = torque * scale
    means = {
        "tau_up": 2.0 * np.pi * told * shaft_rev_s / shown,
        "g": truth["g"] + 0.1 * rng.standard_normal(TESTS),
        "t_gauge": truth["t_gauge"] + gauge.latency_std_s * rng.standard_normal(TESTS),
    }
    model, response = found.structure, found.response
    true = model.response(model.vector(truth), 2j * np.pi * response.frequency_hz)
    std = np.sqrt(np.diagonal(response.covariance, axis1=1, axis2=2)).T
    parts = rng.standard_normal((TESTS, *std.shape)) * std
    drawn = true + parts[:, :2] + 1j * parts[:, 2:]
    order = list(found.settings.priors)
    fits = refit(found, drawn, prior_means=np.stack([means[name] for name in order], axis=1))
    assert fits.converged.mean() > 0.99
    value = dict(zip(fits.names, fits.values.T, strict=True))
    per_rpm = shown / (60.0 * working_point.engine_speed_rev_s)
    return {
        "I_up": value["tau_up"] * shown / (2.0 * np.pi * shaft_rev_s),
        "I_dn": value["tau_dn"] * shown / (2.0 * np.pi * shaft_rev_s),
        "governor proportional action": value["K_p"] * per_rpm,
        "governor integral action": value["K_i"] * per_rpm,
        "gauge zero share": 100.0 * (2.0 / value["k_q"] - 1.0),
    }


@pytest.mark.parametrize(
    "name",
    ["I_up", "I_dn", "governor proportional action", "governor integral action", "gauge zero share"],
)
def test_stated_deviation_is_the_scatter_over_vessels_gauges_and_noise(found, simulated, vessel, working_point, name):
    stated = {q.name: q for q in physical_quantities(found, working_point, vessel)}[name]
    assert stated.std == pytest.approx(np.std(simulated[name]), rel=TOLERANCE)
    assert stated.value == pytest.approx(np.mean(simulated[name]), abs=0.2 * stated.std)


def test_scale_of_the_gauge_counts_once_in_the_upstream_inertia(found, vessel, working_point):
    """The test says little of it: what is left is the calculation's own 2 %, not 2 % and the gauge twice."""
    inertia = {q.name: q for q in physical_quantities(found, working_point, vessel)}["I_up"]
    assert vessel.inertia_upstream_std_kg_m2 == pytest.approx(1.08, abs=0.01)
    assert inertia.std == pytest.approx(1.08, abs=0.02)


def test_working_point_divides_and_multiplies(found, fit, truth, vessel, working_point, known):
    """A mean torque of 1 % more makes responses, loads and prior 1 % smaller: physical values stay as they are."""
    more = replace(working_point, shaft_torque_nm=1.01 * working_point.shaft_torque_nm)
    response = found.response
    sizes = np.array([1.0, 1.0 / 1.01])
    halves = np.tile(sizes, 2)
    smaller = replace(
        response,
        response=response.response * sizes[:, None, None],
        covariance=response.covariance * np.outer(halves, halves),
        load=response.load / 1.01,
    )
    priors = priors_from_vessel(structure("GAUGE-CLOSED"), vessel, more) | {"g": Prior(0.0, 0.1 / 1.01)}
    again = identify(
        found.structure, smaller, rng=np.random.default_rng(7), settings=Settings(starts=20, priors=priors)
    )
    before = {q.name: q for q in physical_quantities(found, working_point, vessel)}
    for quantity in physical_quantities(again, more, vessel):
        if quantity.name != "K_Q":
            assert quantity.value == pytest.approx(before[quantity.name].value, rel=1e-5, abs=1e-4)
            assert quantity.std == pytest.approx(before[quantity.name].std, rel=1e-3)


@pytest.mark.parametrize(("offset", "slope"), [(0.03, 2.0 / 1.03), (-0.05, 2.0 / 0.95)])
def test_gauge_zero_share_is_the_offset_over_the_torque(fit, truth, vessel, working_point, offset, slope):
    """A gauge that shows 3 % of the working-point torque too much has all deviations 3 % too small over its mean."""
    shown = truth | {"tau_dn": truth["tau_dn"] / (1.0 + offset), "k_q": slope}
    found = fit("GAUGE-CLOSED", shown)
    zero = {q.name: q for q in physical_quantities(found, working_point, vessel)}["gauge zero share"]
    assert zero.unit == "%"
    assert zero.value == pytest.approx(100.0 * offset, abs=1e-3)
    slope_std = next(e.std for e in found.parameters if e.name == "k_q")
    assert zero.std == pytest.approx(200.0 / slope**2 * slope_std, rel=1e-4)


def test_a_slope_that_is_held_tells_nothing_of_the_gauge(fit, working_point, vessel):
    core = fit("OL1", {"tau_n": 0.39})
    assert "gauge zero share" not in [q.name for q in physical_quantities(core, working_point, vessel)]


def test_what_is_a_multiple_of_a_parameter_has_its_interval(found, vessel, working_point):
    """The gain is known to 30 % above and 5 % below, its gauge to 2 %: so is what it is in N m/rpm."""
    gain = next(one for one in found.parameters if one.name == "K_p")
    ends = replace(profile(found).intervals["K_p"], lower=0.95 * gain.value, upper=1.3 * gain.value)
    intervals = {"K_p": ends}
    shown = {q.name: q for q in physical_quantities(found, working_point, vessel, intervals=intervals)}
    action = shown["governor proportional action"]
    low, high = (end / action.value for end in action.interval_95)
    assert 0.90 < low < 0.951
    assert 1.299 < high < 1.33
    assert shown["governor integral action"].interval_95 is None
