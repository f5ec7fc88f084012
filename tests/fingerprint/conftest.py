"""A fit whose result is known: noise-free responses of a known line, with a stated covariance."""

import pytest
from tests.known_fits import (
    CAMPAIGN,
    TRUTH,
    changed,
    fitted,
    known_signal_to_noise,
    known_signals,
    known_working_point,
    noisy_response,
    taken,
)

from shaftprint.identify import Prior, Settings
from shaftprint.vessel import load_vessel


@pytest.fixture(scope="session")
def vessel():
    return load_vessel("stan-tug-1205")


@pytest.fixture(scope="session")
def campaign():
    return CAMPAIGN


@pytest.fixture(scope="session")
def working_point():
    return known_working_point()


@pytest.fixture(scope="session")
def signals(working_point):
    return known_signals(working_point)


@pytest.fixture(scope="session")
def signal_to_noise():
    return known_signal_to_noise()


@pytest.fixture(scope="session")
def gauge_fit():
    return fitted("GAUGE-CLOSED", TRUTH, settings=Settings(starts=20, priors={"g": Prior(0.0, 0.1)}))


@pytest.fixture(scope="session")
def take():
    return taken


@pytest.fixture(scope="session")
def fingerprint(gauge_fit, take):
    return take(gauge_fit)


@pytest.fixture(scope="session")
def put_by_hand():
    return changed


@pytest.fixture(scope="session")
def fit():
    return fitted


@pytest.fixture(scope="session")
def respond():
    return noisy_response


@pytest.fixture(scope="session")
def truth():
    return dict(TRUTH)
