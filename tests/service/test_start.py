"""Where a fit begins: near enough to a line of whose governor nothing is known."""

from dataclasses import replace

import numpy as np
import pytest
from tests.service.test_misfit import records

from shaftprint.service._fit import fit_segments
from shaftprint.service._model import FREE, service_model
from shaftprint.service._start import begun
from shaftprint.vessel import load_vessel


@pytest.fixture(scope="module")
def model():
    return service_model(load_vessel("stan-tug-1205-service"))


@pytest.mark.slow
@pytest.mark.parametrize(("gain", "delay_s"), [(0.35, 0.04), (0.8, 0.12)])
def test_a_governor_far_from_the_usual_one_is_found(model, gain, delay_s):
    """Half the gain and delay of the usual governor, and all of it with a delay that is half as long again."""
    true = {**model.values, "K_p": gain * model.values["K_p"], "K_i": gain * model.values["K_i"], "t_d": delay_s}
    truth = np.array([true[name] for name in FREE])
    fit = fit_segments(given := records(np.random.default_rng(8), lambda *_: truth), begun(model, given))
    assert np.all(np.abs(fit.theta - truth) < 4.0 * fit.std)
    assert fit.std[FREE.index("K_p")] < 0.1 * truth[FREE.index("K_p")]


def test_a_fingerprint_is_where_a_fit_begins(model):
    of_fingerprint = replace(model, is_of_fingerprint=True)
    assert begun(of_fingerprint, [None] * 20) is of_fingerprint
