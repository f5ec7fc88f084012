"""Data without noise, whose covariance says next to nothing: the search must find the truth all the same."""

import numpy as np
import pytest
from tests.identify.one_objective import build_objective

from shaftprint.catalogue import structure
from shaftprint.identify import Prior, Settings, Unweighted, identify
from shaftprint.identify.search._search import _floors
from shaftprint.spectra import FrequencyResponse

FREQUENCY_HZ = np.array(
    [0.0044, 0.0092, 0.0193, 0.0275, 0.0405, 0.06, 0.0848, 0.11, 0.1778, 0.3728, 0.7814, 1.637, 3.433]
)
TRUTHS = {
    "OL5": {"K_p": 4.36, "K_i": 4.2664, "t_d": 0.1023, "omega_n": 8.202, "zeta": 0.88},
    "CL4": {"tau_n": 0.39, "K_p": 1.8, "K_i": 4.3, "t_d": 0.12, "omega_n": 9.0, "zeta": 1.2},
    "GAUGE-CLOSED": {
        "K_p": 1.0, "K_i": 3.5, "t_d": 0.08, "omega_n": 9.0, "zeta": 0.8, "tau_dn": 0.33, "tau_up": 1.0, "k_q": 2.0,
        "t_sp": 0.02,
    },
}  # fmt: skip


def exact(name, rng, *, share=1e-6, spread=0.0):
    """A structure, its truth up to 25 % above the table, and its response with standard deviations of a share of it.

    ``spread`` is by how many decades the shares differ from line to line, both ways.
    """
    shipped = structure(name)
    truth = {key: value * rng.uniform(0.9, 1.25) for key, value in TRUTHS[name].items()}
    response = shipped.response(shipped.vector(truth), 2j * np.pi * FREQUENCY_HZ)
    std = np.tile(np.abs(response), (2, 1)).T * share * 10.0 ** rng.uniform(-spread, spread, (13, 1))
    return (
        shipped,
        truth,
        FrequencyResponse(
            frequency_hz=FREQUENCY_HZ,
            response=response[:, None],
            covariance=std[:, :, None] * np.eye(std.shape[1]) * std[:, None, :],
            inputs=(shipped.input,),
            outputs=tuple(shipped.outputs),
        ),
    )


@pytest.mark.slow
@pytest.mark.parametrize("spread", [0.0, 2.0], ids=["even", "uneven"])
@pytest.mark.parametrize("name", TRUTHS)
def test_fifty_starts_find_the_truth(name, spread):
    """Three truths each; seeds 3 and 8 of the uneven GAUGE-CLOSED end elsewhere where the search goes straight down."""
    for seed in (3, 8, 18):
        shipped, truth, response = exact(name, np.random.default_rng(seed), spread=spread)
        priors = {}
        if name == "GAUGE-CLOSED":
            priors = {"g": Prior(0.0, 0.1), "tau_up": Prior(truth["tau_up"], 0.05)}
        found = identify(shipped, response, rng=np.random.default_rng(seed + 100), settings=Settings(priors=priors))
        for parameter, value in truth.items():
            assert found.value(parameter) == pytest.approx(value, rel=1e-4), (seed, parameter)
        assert found.reached >= 2


def objective_of(response, weighting=None):
    settings = Settings() if weighting is None else Settings(weighting=weighting)
    return build_objective(structure("OL5"), response, weighting=settings.weighting, priors={}, regularisation={})


def test_steps_begin_at_10_percent_and_end_before_the_true_covariance():
    _, _, response = exact("OL5", np.random.default_rng(1), share=3e-6)
    assert list(_floors(objective_of(response))) == pytest.approx([0.1, 0.01, 1e-3, 1e-4, 1e-5])


def test_usual_noise_and_fits_without_weights_take_no_steps():
    _, _, usual = exact("OL5", np.random.default_rng(1), share=1e-3)
    _, _, sharp = exact("OL5", np.random.default_rng(1))
    assert list(_floors(objective_of(usual))) == []
    assert list(_floors(objective_of(sharp, Unweighted()))) == []


def test_a_value_of_zero_needs_no_share():
    """The response of a pure gain at 0: no division by it."""
    _, _, response = exact("OL5", np.random.default_rng(1))
    zero = FrequencyResponse(
        frequency_hz=FREQUENCY_HZ,
        response=np.zeros_like(response.response),
        covariance=response.covariance,
        inputs=("e",),
        outputs=("M_s",),
    )
    assert list(_floors(objective_of(zero))) == []
