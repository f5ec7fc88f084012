"""A channel on a clock of its own: its lines come ever later, which no delay of a model explains."""

from dataclasses import replace

import numpy as np
import pytest
from tests.known_fits import FREQUENCY_HZ, TRUTH, noisy_response

from shaftprint.catalogue import structure
from shaftprint.identify import Prior, Settings, assess, identify
from shaftprint.identify.judgement._clock_drift import unseen_drift

PRIORS = {"g": Prior(0.0, 0.1), "tau_up": Prior(1.016, 0.03), "t_gauge": Prior(0.0, 0.002)}
MIDDLE_S = np.linspace(280.0, 850.0, FREQUENCY_HZ.size)
LINE = structure("GAUGE-CLOSED")


def fit_of(*, seed, drift=0.0, **fields):
    """A fit to data whose outputs lead by what the clock of the set point loses."""
    response = noisy_response(LINE, TRUTH, share=0.02, seed=seed)
    leads = np.exp(2j * np.pi * FREQUENCY_HZ * drift * MIDDLE_S)
    data = replace(response, response=response.response * leads, middle_s=MIDDLE_S, **fields)
    # what is judged is the optimum, which a few starts reach
    return identify(LINE, data, rng=np.random.default_rng(1), settings=Settings(starts=6, priors=PRIORS))


def clocks(identification):
    reasons = assess(identification).reasons
    return {reason.where: reason.sentence for reason in reasons if reason.kind == "channel clock"}


@pytest.mark.parametrize("drift", [60e-6, -60e-6])
def test_the_clock_of_a_set_point_that_runs_apart_is_named_with_its_drift(drift):
    """The times of the sines say that somebody's clock does, the other channels whose."""
    found = clocks(fit_of(seed=3, drift=drift, input_drift=drift))
    assert list(found) == ["n_set"]
    assert ("later" if drift > 0.0 else "earlier") in found["n_set"]
    ppm = float(found["n_set"].split("off by ")[1].split(" +/-")[0])
    assert ppm == pytest.approx(1e6 * abs(drift), abs=20.0)


def test_one_clock_is_not_in_doubt_and_one_beside_the_campaign_may_be_that_of_the_generator():
    """A generator that runs 60 ppm beside is told from a channel that does by the other channels."""
    of_generator = fit_of(seed=4, input_drift=60e-6)
    assert clocks(of_generator) == {}
    assert unseen_drift(of_generator) == 0.0


@pytest.mark.slow
def test_what_the_lines_cannot_tell_of_a_clock_is_stated():
    known, unknown = fit_of(seed=4, input_drift=8e-6), fit_of(seed=4)
    assert clocks(known) == clocks(unknown) == {}
    assert unseen_drift(known) == 8e-6
    assert 10e-6 < unseen_drift(unknown) < 50e-6
