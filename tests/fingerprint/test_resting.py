"""Which numbers rest on what was taken as known."""

import re
from dataclasses import replace

import numpy as np
from tests.known_fits import TRUTH, noisy_response

from shaftprint.catalogue import structure
from shaftprint.fingerprint._assumptions import assumptions_of, resting_on
from shaftprint.identify import Prior, Settings, identify, profile_intervals
from shaftprint.spectra import FrequencyResponse

GAUGE = structure("GAUGE-CLOSED")
FREQUENCY_HZ = np.geomspace(0.01, 3.0, 20)
STD = 1e-3


def test_gains_rest_on_the_inertia_upstream_and_ratios_of_one_recording_do_not():
    """Gains, inertia upstream and slopes by one factor leave all responses as they are; the rest is seen."""
    exact = GAUGE.response(GAUGE.vector({}), 2j * np.pi * FREQUENCY_HZ)
    rng = np.random.default_rng(2)
    measured = FrequencyResponse(
        frequency_hz=FREQUENCY_HZ,
        response=(exact + STD * (rng.standard_normal(exact.shape) + 1j * rng.standard_normal(exact.shape)))[:, None],
        covariance=np.broadcast_to(STD**2 * np.eye(4), (FREQUENCY_HZ.size, 4, 4)),
        inputs=("n_set",),
        outputs=("n", "M_s"),
    )
    settings = Settings(priors={"tau_up": Prior(1.0, 0.03), "g": Prior(0.0, 0.1), "t_gauge": Prior(0.0, 0.002)})
    fit = identify(GAUGE, measured, rng=np.random.default_rng(1), settings=settings)
    intervals = profile_intervals(fit)
    resting = set(resting_on(fit, (), intervals, name="tau_up", at=(0.8, 1.2)))
    assert {"K_p", "K_i"} <= resting
    assert not resting & {"tau_up", "tau_dn", "k_q", "t_gauge", "K_p / K_i"}
    # an inertia within its deviation moves nothing out of its interval
    assert resting_on(fit, (), intervals, name="tau_up", at=(1.0,)) == ()
    # beyond the bounds of the search is at them: as far as 0
    assert "K_p" in resting_on(fit, (), intervals, name="tau_up", at=(-1.0,))


def said_of(vessel, *, tau_up_std, share):
    """Return what is said to rest on gauge, inertia and slope of a fit, and ways to fit it with one held or bent."""
    settings = Settings(starts=12, priors={"tau_up": Prior(1.016, tau_up_std), "g": Prior(0.0, 0.1)})
    measured = noisy_response(GAUGE, TRUTH, share=share, seed=3)
    fit = identify(GAUGE, measured, rng=np.random.default_rng(1), settings=settings)
    intervals = profile_intervals(fit)

    def again(name="", value=0.0, *, bent=0.0):
        priors = {other: prior for other, prior in settings.priors.items() if other != name}
        of_output = np.array([1.0 + bent * (output == "M_s") for output in measured.outputs])
        held = identify(
            GAUGE.held_at(**{name: value}) if name else GAUGE,
            replace(measured, response=measured.response * of_output[:, None, None]),
            rng=np.random.default_rng(1),
            settings=Settings(starts=12, priors=priors),
        )
        numbers = {one.name: one.value for one in (*held.parameters, *held.combinations)}
        return {
            number
            for number, found in numbers.items()
            if number in intervals and not intervals[number].lower <= found <= intervals[number].upper
        }

    return [text for text in assumptions_of(fit, vessel, (), intervals) if "leave" in text], again


def test_what_is_said_to_rest_on_a_gauge_that_does_not_bend_leaves_its_interval_with_one_that_does(vessel):
    (of_gauge, *_), again = said_of(vessel, tau_up_std=0.03, share=0.003)
    told, _, ground = of_gauge.partition(" rest on a torque gauge whose line does not bend: ")
    assert ground == "with one that shows changes 3 % larger or smaller they would leave their intervals."
    assert {"tau_dn", "k_q"} <= set(re.split(", | and ", told)) == again(bent=0.03) | again(bent=-0.03)


def test_a_gear_ratio_is_named_where_no_pick_up_shows_the_speed_of_the_propeller(vessel):
    fit = identify(GAUGE, noisy_response(GAUGE, TRUTH, share=0.01, seed=3), rng=np.random.default_rng(1))
    engine = tuple(one for one in vessel.sensors.speed if one.shaft == "engine")
    geared = vessel.model_copy(update={"sensors": vessel.sensors.model_copy(update={"speed": engine})})
    named = [
        f"gear ratio of {vessel.gearbox.ratio:g}" in " ".join(assumptions_of(fit, one)) for one in (vessel, geared)
    ]
    assert named == [False, True]


def test_what_is_said_to_leave_its_interval_leaves_it_when_it_is_fitted_again(vessel):
    """The drawing knows the inertia better than the test: gains follow it."""
    (_, of_inertia, of_slope), again = said_of(vessel, tau_up_std=0.03, share=0.001)
    left = again("tau_up", 0.8 * 1.016) | again("tau_up", 1.2 * 1.016)
    assert {"K_p", "K_i"} <= left
    told, _, ground = of_inertia.partition(" rest on the inertia upstream of the gauge, 54")
    assert ground.endswith("with one 20 % smaller or larger they would leave their intervals.")
    assert set(re.split(", | and ", told)) == left
    assert "with g = -0.5 as of some engines" in of_slope


def test_an_inertia_that_moves_nothing_is_not_said_to_move_anything(vessel):
    """The test knows the inertia as well as the drawing: with another one the gains stay in their intervals."""
    (_, of_slope), again = said_of(vessel, tau_up_std=0.5, share=0.01)
    assert not {"K_p", "K_i"} & (again("tau_up", 0.8 * 1.016) | again("tau_up", 1.2 * 1.016))
    assert "inertia" not in of_slope
    assert "K_p" in again("g", -0.5)
    assert of_slope.startswith("K_p")
