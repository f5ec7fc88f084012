"""What a test would find, against hand-derived information, fits of the same lines, and limits that can be seen."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.campaign import load_campaign
from shaftprint.catalogue import structure
from shaftprint.errors import IdentificationError
from shaftprint.identify import (
    Prior,
    Settings,
    expected_response,
    identify,
    identify_jointly,
    planned_lines,
    planned_response,
    predict_accuracy,
)
from shaftprint.identify.prediction._accuracy import predict_joint_accuracy, predict_joint_deviations
from shaftprint.identify.prediction._predicted_intervals import predict_intervals
from shaftprint.models import Combination, Delay, Parameter, SecondOrderLag, Structure
from shaftprint.survey import STAN_TUG_NOISE

TRUTH = {
    "K_p": 5.7, "K_i": 4.27, "t_d": 0.0703, "omega_n": 10.3, "zeta": 0.47, "tau_dn": 0.32, "tau_up": 1.016,
    "k_q": 2.0, "g": 0.0, "t_sp": 0.0518, "c_set": 1.0, "t_gauge": 0.0,
}  # fmt: skip
KNOWN = {"g": Prior(0.0, 0.1), "tau_up": Prior(1.016, 0.0285)}

# Standard deviations that fits of GAUGE-CLOSED to simulated recordings of the thesis campaign state: medians over
# seeds 1 to 12, with the inertia of the TVC known to 2.8 % (tug.sail, prepare_signals, estimate_response, identify).
OF_FITS = {
    "K_p": 0.464, "K_i": 0.339, "t_d": 0.0187, "omega_n": 0.325, "zeta": 0.0501, "tau_dn": 0.000267, "tau_up": 0.0284,
    "k_q": 0.00115, "g": 0.0862, "t_sp": 0.0189, "c_set": 0.000345, "t_gauge": 9.5e-5, "t_d + t_sp": 0.00068,
    "K_p / K_i": 0.0181, "v K_i / (k_q - g)": 0.0854, "v K_p / (tau_up + tau_dn)": 0.366,
}  # fmt: skip


@pytest.fixture(scope="module")
def planned():
    """The thesis campaign on the Stan Tug."""
    return planned_response(load_campaign("thesis"), STAN_TUG_NOISE)


@pytest.fixture(scope="module")
def thesis(planned):
    """What it would tell of the gauge-aware line."""
    return predict_accuracy(structure("GAUGE-CLOSED"), planned, values=TRUTH, priors=KNOWN)


# ---- the same numbers as a fit ----


@pytest.mark.parametrize("name", ["OL1", "OL5", "CL1", "CL4"])
def test_equals_the_covariance_of_a_fit(make_response, name):
    response = make_response(name, noise=0.02, correlation=0.3, rng=np.random.default_rng(4))
    fit = identify(structure(name), response, rng=np.random.default_rng(1))
    values = dict(zip(fit.structure.names, fit.values, strict=True))
    found = predict_accuracy(structure(name), response, values=values)
    assert found.covariance == pytest.approx(fit.covariance, rel=1e-6)
    assert [(e.name, e.value, e.std) for e in found.parameters] == [(e.name, e.value, e.std) for e in fit.parameters]


def test_equals_a_fit_with_priors_and_combinations(planned):
    gauge = structure("GAUGE-CLOSED")
    response = expected_response(planned, gauge, TRUTH)
    fit = identify(gauge, response, rng=np.random.default_rng(1), settings=Settings(priors=KNOWN))
    values = dict(zip(fit.structure.names, fit.values, strict=True))
    found = predict_accuracy(gauge, response, values=values, priors=KNOWN)
    assert found.covariance == pytest.approx(fit.covariance, rel=1e-6)
    for mine, other in zip(found.combinations, fit.combinations, strict=True):
        assert (mine.name, mine.unit, mine.value) == (other.name, other.unit, pytest.approx(other.value))
        assert mine.std == pytest.approx(other.std, rel=1e-6)


def test_equals_a_joint_fit(make_response):
    one, other = (make_response("CL4", noise=0.02, rng=np.random.default_rng(k)) for k in (1, 2))
    slow = structure("CL4").scaled(tau_n=1.3, K_p=1.3, K_i=1.3)
    pairs = [(structure("CL4"), one), (slow, other)]
    fit = identify_jointly(pairs, rng=np.random.default_rng(1))
    values = dict(zip(fit.objective.names, fit.values, strict=True))
    assert predict_joint_accuracy(pairs, values=values).covariance == pytest.approx(fit.covariance, rel=1e-6)


def test_estimated_covariances_cost_what_their_degrees_of_freedom_do(make_response):
    """A fit states it for its own noise, a prediction on average, whatever the values of the response."""
    response = make_response("CL4", noise=0.02, rng=np.random.default_rng(4), degrees_of_freedom=np.full(13, 30.0))
    fit = identify(structure("CL4"), response, rng=np.random.default_rng(1))
    values = dict(zip(fit.structure.names, fit.values, strict=True))
    found = predict_accuracy(structure("CL4"), response, values=values)
    empty = predict_accuracy(structure("CL4"), replace(response, response=0.0 * response.response), values=values)
    known = replace(response, degrees_of_freedom=np.full(13, np.inf))
    assert empty.covariance == pytest.approx(found.covariance, rel=1e-12)
    std, stated = (np.sqrt(np.diag(covariance)) for covariance in (found.covariance, fit.covariance))
    assert std == pytest.approx(stated, rel=0.15)
    assert np.all(std >= np.sqrt(np.diag(predict_accuracy(structure("CL4"), known, values=values).covariance)))


def test_fisher_information_of_the_core_by_hand():
    """``dH/dtau = -s / (tau s + 2)^2``, each part of a line with the variance ``S / (T A^2)``."""
    noise = STAN_TUG_NOISE.of_outputs("n")
    line = planned_lines([0.5], noise=noise, amplitude=0.1, duration_s=60.0)
    response = replace(line, inputs=("M_s",))
    s = 2j * np.pi * 0.5
    slope = np.abs(s / (0.3897 * s + 2.0) ** 2)
    std = np.sqrt(noise.at([0.5])[0, 0, 0].real / 60.0) / 0.1 / slope
    found = predict_accuracy(structure("OL1"), response, values={"tau_n": 0.3897})
    assert found.estimate("tau_n").std == pytest.approx(std, rel=1e-9)


def test_fits_of_simulated_recordings_state_the_same(thesis):
    ratio = {name: thesis.estimate(name).std / std for name, std in OF_FITS.items()}
    assert ratio == pytest.approx(dict.fromkeys(OF_FITS, 1.0), abs=0.3)


# ---- laws ----


def test_longer_lines_and_larger_amplitudes():
    def std(**changed):
        fields = {"amplitude": 0.1, "duration_s": 60.0} | changed
        lines = planned_lines(np.geomspace(0.02, 3.0, 12), noise=STAN_TUG_NOISE, **fields)
        return np.sqrt(np.diag(predict_accuracy(structure("CL4"), lines).covariance))

    assert std(duration_s=240.0) == pytest.approx(std() / 2.0, rel=1e-9)
    assert std(amplitude=0.3) == pytest.approx(std() / 3.0, rel=1e-9)


def test_two_tests_together_are_one_of_twice_the_length():
    lines, longer = (
        planned_lines(np.geomspace(0.02, 3.0, 12), noise=STAN_TUG_NOISE, amplitude=0.1, duration_s=length)
        for length in (60.0, 120.0)
    )
    both = predict_joint_accuracy([(structure("CL4"), lines), (structure("CL4"), lines)])
    assert both.covariance == pytest.approx(predict_accuracy(structure("CL4"), longer).covariance, rel=1e-9)


def test_what_cannot_be_found_is_infinite(planned):
    found = predict_accuracy(structure("BENCHMARK"), planned)
    std = {e.name: e.std for e in (*found.parameters, *found.combinations)}
    assert [name for name, s in std.items() if np.isinf(s)] == ["K_p", "K_i", "v"]
    assert np.isfinite(std["v K_p"])
    assert np.isnan(found.correlation[0, 1])
    assert "Not known: K_p, K_i, v." in found.sentences


def test_second_working_point_breaks_the_common_factor(planned):
    """At 3/4 of the speed ``tau``, the gains and ``g`` are 4/3 as large, but ``k_q`` is not: ``k_q - g`` tells."""
    gauge = structure("GAUGE-CLOSED")
    slow = gauge.scaled(**dict.fromkeys(("tau_dn", "tau_up", "K_p", "K_i", "g"), 4.0 / 3.0))
    alone = predict_accuracy(gauge, planned, values=TRUTH)
    both = predict_joint_accuracy([(gauge, planned), (slow, planned)], values=TRUTH)
    assert [e.name for e in alone.parameters if np.isinf(e.std)] == ["K_p", "K_i", "tau_up", "g"]
    assert all(np.isfinite(e.std) for e in both.parameters)
    assert both.estimate("g").std < 0.05


@pytest.mark.parametrize("name", ["BENCHMARK", "GAUGE-CLOSED"])
def test_deviations_alone_are_those_of_the_whole(planned, name):
    """Also where a factor is not known and its product is."""
    pairs = [(structure(name), planned)]
    values = TRUTH if name == "GAUGE-CLOSED" else {}
    whole = predict_joint_accuracy(pairs, values=values)
    alone, covariance = predict_joint_deviations(pairs, values=values, priors={})
    assert alone == pytest.approx({one.name: one.std for one in whole.numbers}, rel=1e-6)
    assert covariance == pytest.approx(whole.covariance, rel=1e-6)


def test_latency_of_the_set_point_makes_the_delay_in_the_loop_known(thesis, planned):
    """Their sum is known to 0.7 ms, so that of ``t_d`` little more than the latency's own 2 ms is left."""
    priors = KNOWN | {"t_sp": Prior(TRUTH["t_sp"], 0.002)}
    found = predict_accuracy(structure("GAUGE-CLOSED"), planned, values=TRUTH, priors=priors).estimate("t_d").std
    assert 0.0018 < found < 0.0022
    assert found < 0.15 * thesis.estimate("t_d").std


# ---- words ----


def late(*, lower=7.0, upper=13.0):
    """A delay and a lag in series."""
    t_d = Parameter("t_d", "s", 0.0, 0.5, 0.1, "delay")
    omega_n = Parameter("omega_n", "rad/s", lower, upper, 10.0, "frequency")
    zeta = Parameter("zeta", "-", 0.1, 4.0, 0.5, "damping", held=True)
    return Structure(name="LATE", title="", input="x", outputs={"y": Delay(t_d) * SecondOrderLag(omega_n, zeta)})


def slow_lines(highest_hz, std=1e-3):
    frequency = np.linspace(0.1, 1.0, 10) * highest_hz
    noise = replace(STAN_TUG_NOISE.of_outputs("n"), outputs=("y",))
    lines = planned_lines(frequency, noise=noise, amplitude=0.1, duration_s=60.0)
    return replace(lines, inputs=("x",), covariance=np.tile(std**2 * np.eye(2), (10, 1, 1)))


def test_slow_lines_see_the_sum_of_delay_and_lag_only():
    """Both are ``1 - s (t_d + 2 zeta / omega_n)`` for slow lines: the sum is known as a single delay would be."""
    lines = slow_lines(0.05)
    (group,) = predict_accuracy(late(), lines).groups
    assert group.names == ("t_d", "omega_n")
    assert group.correlation > 0.99
    assert group.known[0].name == "t_d + 2 zeta / omega_n"
    assert group.known[0].value == pytest.approx(0.2)
    alone = 1e-3 / np.sqrt(np.sum(lines.omega_rad_s**2))
    assert group.known[0].std == pytest.approx(alone, rel=0.15)
    percent = 100.0 * group.known[0].std / 0.2
    assert group.sentence == (
        f"With these lines t_d and omega_n cannot be separated (correlation {group.correlation:.2f}); "
        f"t_d + 2 zeta / omega_n is known to {percent:.2g} %."
    )


def test_fast_lines_separate_delay_and_lag():
    found = predict_accuracy(late(), slow_lines(5.0))
    assert found.groups == ()
    assert found.sentences == ("Known to 1 % or better: t_d, omega_n.",)


def test_thesis_campaign_in_words(thesis):
    assert "Known to 1 % or better: tau_dn, k_q, c_set, t_d + t_sp." in thesis.text
    assert "t_d + t_sp is known to 0.5" in thesis.text
    assert "K_p / K_i is known to 1." in thesis.text
    assert "g stays at its prior, 0.00 +/- 0.10: the test says little about it." in thesis.text
    assert "Hardly known, worse than 20 %: t_d, t_sp." in thesis.text


def test_bound_that_is_near(planned):
    found = predict_accuracy(structure("GAUGE-CLOSED"), planned, values=TRUTH, priors={"g": KNOWN["g"]})
    std = found.estimate("t_sp").std
    assert std > TRUTH["t_sp"]
    assert any(
        line.startswith(f"t_sp: one standard deviation, {std:.2g}, reaches past the bound 0;")
        for line in found.sentences
    )


def test_intervals_of_a_planned_test_end_at_the_bound(planned):
    """Without the TVC the delay in the loop reaches 0: the other end is nearer than the standard deviation says."""
    gauge, priors = structure("GAUGE-CLOSED"), {"g": KNOWN["g"]}
    found = predict_intervals(gauge, planned, values=TRUTH, priors=priors)
    std = predict_accuracy(gauge, planned, values=TRUTH, priors=priors).estimate("t_d").std
    assert found["t_d"].lower == 0.0
    assert found["t_d"].lower_open
    assert TRUTH["t_d"] < found["t_d"].upper < TRUTH["t_d"] + 1.2 * std


def test_intervals_of_what_is_well_known_are_two_standard_deviations_wide(thesis, planned):
    found = predict_intervals(structure("GAUGE-CLOSED"), planned, values=TRUTH, priors=KNOWN)
    for name in ("tau_dn", "k_q", "c_set", "K_p / K_i"):
        half = 0.5 * (found[name].upper - found[name].lower)
        assert half == pytest.approx(1.96 * thesis.estimate(name).std, rel=0.02), name


def test_intervals_of_some_outputs(planned):
    found = predict_intervals(structure("CL4").of_outputs("n"), planned)
    assert found["tau_n"].lower < 0.39 < found["tau_n"].upper


def test_combinations_of_ones_own(thesis, planned):
    total = Combination(name="tau", unit="s", of=lambda p: p["tau_up"] + p["tau_dn"], meaning="total inertia time")
    found = predict_accuracy(structure("GAUGE-CLOSED"), planned, values=TRUTH, priors=KNOWN, combinations=(total,))
    assert found.estimate("tau").value == pytest.approx(1.336)
    assert found.estimate("tau").std == pytest.approx(thesis.estimate("tau_up").std, rel=0.01)
    nothing = Combination(name="1 / g", unit="-", of=lambda p: 1.0 / p["g"], meaning="infinite")
    endless = predict_accuracy(structure("GAUGE-CLOSED"), planned, values=TRUTH, priors=KNOWN, combinations=(nothing,))
    assert np.isinf(endless.estimate("1 / g").std)


# ---- refusals ----


def test_value_of_no_parameter(planned):
    with pytest.raises(IdentificationError, match="accuracy of CL4: mass is no parameter of it; it has tau_n, "):
        predict_accuracy(structure("CL4"), planned, values={"mass": 1.0})


def test_value_outside_its_bounds(planned):
    with pytest.raises(IdentificationError, match="expected omega_n from 7 to 13 rad/s, found 20"):
        predict_accuracy(structure("CL4"), planned, values={"omega_n": 20.0})


def test_estimate_of_no_name(thesis):
    with pytest.raises(IdentificationError, match="accuracy of GAUGE-CLOSED: mass is not among K_p, K_i"):
        thesis.estimate("mass")
