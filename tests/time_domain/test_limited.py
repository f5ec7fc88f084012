"""A line with a torque limit, found from a chirp, steps and sines together.

The truth comes from steps that end at every corner, a fifth as long as those of the fit, and the noise is drawn with
known colours.
"""

import numpy as np
import pytest
from scipy.signal import lfilter

from shaftprint.catalogue import limited, structure
from shaftprint.identify import Settings
from shaftprint.simulation import simulate_exactly
from shaftprint.spectra import FrequencyResponse
from shaftprint.time_domain import identify_in_time, output_error, record_from_arrays
from shaftprint.time_domain._identify_in_time import with_noise_at
from shaftprint.time_domain.nonlinear._covariance import with_scatter_of_blocks

RATE = 20.0
TRUTH = {
    "K_p": 5.2,
    "K_i": 4.4,
    "t_d": 0.083,
    "omega_n": 11.0,
    "zeta": 0.52,
    "tau_dn": 0.33,
    "k_q": 2.1,
    "m_max": 1.9,
}
KNOWN = {"tau_up": 0.95, "g": 0.0, "t_sp": 0.0, "c_set": 1.0, "t_gauge": 0.0}
STD = {"n": 0.002, "M_s": 0.015}


@pytest.fixture(scope="module")
def line():
    held = {**KNOWN, "m_min": -0.6, "T_aw": 0.5}
    asked = limited("torque")
    return asked.held_at(**{name: value for name, value in held.items() if name in asked.names})


def record(line, name, n_set, rng):
    """Exact outputs with noise that remembers, a part of it common to both outputs."""
    time = np.arange(n_set.size) / RATE
    exact = simulate_exactly(line, line.vector(TRUTH), time, {"n_set": n_set}, longest_step_s=1e-3)
    white = rng.standard_normal((2, n_set.size + 100))
    white[1] += 0.5 * white[0]
    noise = {
        key: STD[key] * lfilter([1.0], [1.0, -a], row)[100:]
        for key, row, a in zip(("n", "M_s"), white, (0.7, 0.4), strict=True)
    }
    return record_from_arrays(name, {"n_set": n_set}, {k: exact.outputs[k] + noise[k] for k in noise}, rate_hz=RATE)


@pytest.fixture(scope="module")
def tests(line):
    rng = np.random.default_rng(5)
    time = np.arange(1200) / RATE
    chirp = 0.04 * np.sin(2.0 * np.pi * (0.05 + 0.5 * time / 60.0 * 1.45) * time)
    steps = np.repeat([0.0, 0.15, 0.0, 0.2, -0.1, 0.25], 200)
    return {"chirp": record(line, "chirp", chirp, rng), "steps": record(line, "steps", steps, rng)}


@pytest.fixture(scope="module")
def sines():
    """Lines of the linear structure, too small for any limit, with independent noise of 0.3 %."""
    rng = np.random.default_rng(6)
    linear = structure("GAUGE-CLOSED").held_at(**KNOWN)
    frequency = np.array([0.05, 0.1, 0.2, 0.4, 0.7, 1.0, 1.6, 2.5])
    exact = linear.response(
        linear.vector({n: v for n, v in TRUTH.items() if n in linear.names}), 2j * np.pi * frequency
    )
    std = 0.003 * np.abs(exact)
    noise = std * (rng.standard_normal(exact.shape) + 1j * rng.standard_normal(exact.shape))
    return linear, FrequencyResponse(
        frequency_hz=frequency,
        response=(exact + noise)[:, None],
        covariance=np.stack([np.diag(row**2) for row in np.tile(std, (2, 1)).T]),
        inputs=("n_set",),
        outputs=tuple(linear.outputs),
        lines=tuple(f"S{i}" for i in range(frequency.size)),
    )


@pytest.fixture(scope="module")
def found(line, tests, sines):
    """Fits to the two records, and to them and the sines."""
    start = {name: 1.1 * value for name, value in TRUTH.items()}
    pairs = [(line, tests["chirp"]), (line, tests["steps"]), sines]
    return {
        name: identify_in_time(chosen, rng=np.random.default_rng(1), settings=Settings(starts=1), start=start)
        for name, chosen in (("records", pairs[:2]), ("all", pairs))
    }


@pytest.mark.slow
@pytest.mark.parametrize("name", ["records", "all"])
def test_governor_line_and_limit_are_found(found, name):
    for estimate in found[name].parameters:
        assert abs(estimate.value - TRUTH[estimate.name]) < 3.0 * estimate.std, estimate.name
    limit = next(p for p in found[name].parameters if p.name == "m_max")
    assert limit.std < 0.01 * limit.value
    assert found[name].p_value > 1e-3


def test_every_record_has_the_noise_that_was_put_in(found):
    """AR(1) with its own pole for each output, and innovations that are correlated: 1, 1.25 and 0.5 times the sizes."""
    scale = np.array([STD["n"], STD["M_s"]])
    for part in found["all"].parts[:2]:
        poles = np.abs(np.linalg.eigvals(part.noise.coefficients[0])) if part.noise.order == 1 else None
        if poles is not None:
            np.testing.assert_allclose(sorted(poles), [0.4, 0.7], atol=0.08)
        shape = part.noise.covariance / np.outer(scale, scale)
        np.testing.assert_allclose(shape, [[1.0, 0.5], [0.5, 1.25]], atol=0.15)


def test_sines_add_what_they_know_and_nothing_of_the_limit(found, sines):
    fewer, more = ({p.name: p.std for p in found[name].parameters} for name in ("records", "all"))
    assert all(more[name] <= 1.02 * fewer[name] for name in TRUTH)
    assert more["t_d"] < 0.9 * fewer["t_d"]
    term = found["all"].objective.terms[2]
    assert "m_max" not in {p.name for p in term.structure.free}
    assert [part.name for part in found["all"].parts] == ["record chirp", "record steps", "response of n, M_s"]


def test_without_the_limit_the_steps_give_wrong_numbers_and_more_noise(found, tests):
    """The test of fit asks linear questions and does not see it: that is what ``limits`` is for."""
    linear = structure("GAUGE-CLOSED").held_at(**KNOWN)
    start = {name: value for name, value in TRUTH.items() if name != "m_max"}
    fit = identify_in_time(
        [(linear, tests["steps"])], rng=np.random.default_rng(1), settings=Settings(starts=1), start=start
    )
    off = {p.name: abs(p.value - TRUTH[p.name]) / p.std for p in fit.parameters}
    assert off["k_q"] > 5.0
    with_limit = found["records"].parts[1]
    assert np.all(np.diag(fit.parts[0].noise.power) > [5.0, 2.0] * np.diag(with_limit.noise.power))
    assert with_limit.fit_percent["n"] > fit.fit_percent["n"] + 3.0


def test_a_limit_that_no_record_meets_stays_unknown_and_spoils_no_other(line, tests):
    start = {name: 1.02 * value for name, value in TRUTH.items()} | {"m_max": 5.0}
    fit = identify_in_time(
        [(line, tests["chirp"])], rng=np.random.default_rng(1), settings=Settings(starts=1), start=start
    )
    before, after = ({p.name: p for p in one.parameters} for one in (fit, with_scatter_of_blocks(fit)))
    assert not np.isfinite(after["m_max"].std)
    for name in TRUTH.keys() - {"m_max"}:
        assert before[name].std <= after[name].std < 3.0 * before[name].std, name
        assert abs(after[name].value - TRUTH[name]) < 3.0 * after[name].std, name


def test_derivatives_through_a_limit_are_those_of_the_cost(line, tests):
    """At parameters off the truth, where the limit acts for seconds."""
    term = with_noise_at(output_error(line, tests["steps"]), line.vector(TRUTH))
    theta = np.array([1.05 * TRUTH[p.name] for p in line.free])
    table = term.table(theta[None])[0]
    for i, step in enumerate(np.diag(1e-5 * theta)):
        ahead, behind = term.table(np.array([theta + step, theta - step]))
        slope = (np.sum(ahead[0] ** 2) - np.sum(behind[0] ** 2)) / (4.0 * step[i])
        assert table[0] @ table[1 + i] == pytest.approx(slope, rel=2e-3, abs=1e-5 * np.sum(table[0] ** 2))
