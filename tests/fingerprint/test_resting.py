"""Which numbers rest on what was taken as known."""

import numpy as np

from shaftprint.catalogue import structure
from shaftprint.fingerprint._assumptions import resting_on
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
