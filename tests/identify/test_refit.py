"""Many responses fitted at once: each as if alone, with the scatter that the covariance states."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.arrays import ComplexArray
from shaftprint.catalogue import structure
from shaftprint.errors import IdentificationError
from shaftprint.identify import Identification, Prior, Settings, identify, refit
from shaftprint.models import Structure
from shaftprint.spectra import FrequencyResponse

FREQUENCY_HZ = np.geomspace(0.01, 3.0, 12)
TRUTH = {"K_p": 1.8, "K_i": 4.3, "t_d": 0.12, "omega_n": 9.0, "zeta": 1.2}
CORE = {"tau_n": 0.39, "k_q": 2.0}


def _covariance(size: int, std: float) -> np.ndarray:
    """All parts of a line share a third of their variance."""
    line = std**2 * (np.eye(size) + np.ones((size, size)) / 2.0) / 1.5
    return np.broadcast_to(line, (FREQUENCY_HZ.size, size, size))


def _draws(truth: ComplexArray, std: float, count: int, seed: int) -> ComplexArray:
    """Responses with noise of that covariance, shape (count, outputs, lines)."""
    rng = np.random.default_rng(seed)
    outputs, lines = truth.shape
    parts = rng.standard_normal((count, 2 * outputs, lines)) + rng.standard_normal((count, 1, lines)) / np.sqrt(2.0)
    parts *= std / np.sqrt(1.5)
    return truth + parts[:, :outputs] + 1j * parts[:, outputs:]


def _identified(made_of: Structure, values: dict[str, float], std: float, **options: object) -> Identification:
    truth = made_of.response(made_of.vector(values), 2j * np.pi * FREQUENCY_HZ)
    response = FrequencyResponse(
        frequency_hz=FREQUENCY_HZ,
        response=_draws(truth, std, 1, seed=1)[0][:, None, :],
        covariance=_covariance(2 * truth.shape[0], std),
        inputs=(made_of.input,),
        outputs=tuple(made_of.outputs),
        used=np.arange(FREQUENCY_HZ.size) != 3,
    )
    return identify(made_of, response, rng=np.random.default_rng(2), settings=Settings(**options))  # type: ignore[arg-type]


@pytest.fixture(scope="module")
def found() -> Identification:
    return _identified(structure("OL5"), TRUTH, 0.02)


def test_the_identifications_own_data_give_its_own_values(found: Identification) -> None:
    again = refit(found, found.response.response[None, :, 0])
    assert again.names == ("K_p", "K_i", "t_d", "omega_n", "zeta")
    assert again.values[0] == pytest.approx(found.values, rel=1e-5)
    assert again.cost[0] == pytest.approx(found.cost, rel=1e-7)
    assert again.converged.all()


@pytest.mark.parametrize("name", ["OL5", "CL4"])
def test_every_repeat_is_fitted_as_if_it_were_alone(name: str) -> None:
    """From the truth, with one output and with two whose noise is correlated."""
    values = TRUTH if name == "OL5" else {**TRUTH, "tau_n": 0.39}
    made_of = structure(name)
    found = _identified(made_of, values, 0.02)
    truth = made_of.response(made_of.vector(values), 2j * np.pi * FREQUENCY_HZ)
    drawn = _draws(truth, 0.02, 4, seed=3)
    together = refit(found, drawn)
    for row, alone in enumerate(drawn):
        single = FrequencyResponse(
            frequency_hz=FREQUENCY_HZ,
            response=alone[:, None, :],
            covariance=found.response.covariance,
            inputs=found.response.inputs,
            outputs=found.response.outputs,
            used=found.response.used,
        )
        other = identify(made_of, single, rng=np.random.default_rng(row))
        assert together.cost[row] == pytest.approx(other.cost, rel=1e-6)
        free = [p.name for p in made_of.free]
        assert together.values[row] == pytest.approx([other.value(n) for n in free], rel=2e-3)


def test_the_scatter_of_many_repeats_is_the_covariance_of_one() -> None:
    """1000 repeats of a response with little noise: standard deviations to 7 % (three sigma), the mean without bias."""
    made_of = structure("CL1")
    values = {"tau_n": 0.39, "K_p": 1.8, "K_i": 4.3}
    found = _identified(made_of, values, 1e-3)
    truth = made_of.response(made_of.vector(values), 2j * np.pi * FREQUENCY_HZ)
    repeated = refit(found, _draws(truth, 1e-3, 1000, seed=4))
    std = np.sqrt(np.diag(found.covariance))
    assert repeated.values.std(axis=0, ddof=1) == pytest.approx(std, rel=0.07)
    expected = [values[name] for name in repeated.names]
    assert np.all(np.abs(repeated.values.mean(axis=0) - expected) < 4.0 * std / np.sqrt(1000.0))


def test_more_repeats_than_a_block_keep_their_order(found: Identification) -> None:
    own = found.response.response[:, 0]
    drawn = np.stack([own * (1.0 + 1e-3 * (k % 7)) for k in range(1100)])
    repeated = refit(found, drawn)
    for k in range(7):
        rows = repeated.values[k::7]
        assert np.abs(rows / rows[0] - 1.0).max() < 1e-4
    assert repeated.values[1, 0] > repeated.values[0, 0]


def test_a_start_may_be_given_for_all_or_for_each(found: Identification) -> None:
    drawn = np.repeat(found.response.response[None, :, 0], 2, axis=0)
    near = found.values * 0.97
    for start in (near, np.stack([near, found.values * 1.02])):
        assert refit(found, drawn, start=start).cost == pytest.approx([found.cost] * 2, rel=1e-6)


def test_a_prior_and_a_held_parameter_stay_what_they_were() -> None:
    """With a prior much narrower than the data, the estimate is the prior's mean whatever the response."""
    made_of = structure("OL5").held_at(omega_n=9.0)
    found = _identified(made_of, TRUTH, 0.02, priors={"t_d": Prior(mean=0.15, std=1e-7)})
    repeated = refit(found, found.response.response[None, :, 0])
    assert repeated.names == ("K_p", "K_i", "t_d", "zeta")
    assert repeated.values[0, 2] == pytest.approx(0.15, abs=1e-6)


def test_the_means_of_priors_may_be_drawn() -> None:
    """Each repeat has its own mean of a prior that is much narrower than the data."""
    made_of = structure("OL5").held_at(omega_n=9.0)
    found = _identified(made_of, TRUTH, 0.02, priors={"t_d": Prior(mean=0.15, std=1e-7)})
    own = np.repeat(found.response.response[None, :, 0], 2, axis=0)
    repeated = refit(found, own, prior_means=[[0.14], [0.16]])
    assert repeated.values[:, 2] == pytest.approx([0.14, 0.16], abs=1e-6)
    for wrong in ([0.14, 0.16], [[0.14], [np.nan]]):
        with pytest.raises(IdentificationError, match=r"prior_means: expected finite values of shape \(2 repeats, 1"):
            refit(found, own, prior_means=wrong)


def test_priors_drawn_with_the_data_give_the_stated_spread() -> None:
    """1000 repeats whose prior of ``t_d`` is twice as good as the data: deviations to 7 %; with kept means half."""
    made_of = structure("OL5").held_at(omega_n=9.0, zeta=1.2)
    alone = _identified(made_of, TRUTH, 1e-3)
    std = {p.name: p.std for p in alone.parameters}["t_d"] / 2.0
    found = _identified(made_of, TRUTH, 1e-3, priors={"t_d": Prior(mean=0.12, std=std)})
    truth = made_of.response(made_of.vector(TRUTH | {"omega_n": 9.0}), 2j * np.pi * FREQUENCY_HZ)
    drawn = _draws(truth, 1e-3, 1000, seed=4)
    means = 0.12 + std * np.random.default_rng(5).standard_normal((1000, 1))
    stated = np.sqrt(np.diag(found.covariance))
    assert refit(found, drawn, prior_means=means).values.std(axis=0) == pytest.approx(stated, rel=0.07)
    assert refit(found, drawn).values.std(axis=0)[2] < 0.6 * stated[2]


def test_covariances_may_differ_from_repeat_to_repeat(found: Identification) -> None:
    """Each repeat is fitted as if it were alone with its own covariance, correlated otherwise than the first."""
    rng = np.random.default_rng(6)
    own = found.response.response[:, 0]
    mixed = rng.standard_normal((3, 12, 2, 2))
    covariances = 1e-4 * (np.einsum("rlij,rlkj->rlik", mixed, mixed) + 0.1 * np.eye(2))
    repeated = refit(found, np.stack([own] * 3), covariances=covariances)
    for row, covariance in enumerate(covariances):
        single = replace(found.response, covariance=covariance)
        other = identify(structure("OL5"), single, rng=np.random.default_rng(row))
        assert repeated.cost[row] == pytest.approx(other.cost, rel=1e-6)
        assert repeated.values[row] == pytest.approx(other.values, rel=2e-3)
    with pytest.raises(IdentificationError, match=r"covariances: expected shape \(3, 12, 2, 2\), found \(12, 2, 2\)"):
        refit(found, np.stack([own] * 3), covariances=covariances[0])


def test_lines_that_are_not_fitted_are_not_looked_at(found: Identification) -> None:
    spoilt = found.response.response[None, :, 0].copy()
    spoilt[..., 3] = 100.0
    assert refit(found, spoilt).cost[0] == pytest.approx(found.cost, rel=1e-7)


def test_shapes_and_values_that_cannot_be_are_refused(found: Identification) -> None:
    own = found.response.response[None, :, 0]
    with pytest.raises(IdentificationError, match=r"expected shape \(repeats, 1 channels, 12 lines\), found \(1, 12\)"):
        refit(found, own[0])
    with pytest.raises(IdentificationError, match=r"found \(1, 1, 5\)"):
        refit(found, own[..., :5])
    with pytest.raises(IdentificationError, match=r"found \(0, 1, 12\)"):
        refit(found, own[:0])
    broken = np.repeat(own, 3, axis=0)
    broken[1, 0, 2] = np.nan
    with pytest.raises(IdentificationError, match="not finite, first in repeat 1"):
        refit(found, broken)
    with pytest.raises(IdentificationError, match=r"expected 5 values, or 1 rows of them.* found shape \(3,\)"):
        refit(found, own, start=np.ones(3))
