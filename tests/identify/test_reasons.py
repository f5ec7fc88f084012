"""By-number verdicts: what depends on a reason, what stays usable, and which reason comes first."""

from dataclasses import replace
from typing import get_args

import numpy as np
import pytest

from shaftprint.catalogue import ShipRole, structure
from shaftprint.identify import Estimate, Prior, Settings, assess, identify, profile
from shaftprint.identify.judgement._affected_numbers import AFFECTED, by_weight, depends_on
from shaftprint.reasons import Reason, ReasonKind

LINES_HZ = np.geomspace(0.0044, 3.4, 24)
DENSE = {"frequency_hz": LINES_HZ, "names": tuple(f"S{i}" for i in range(1, 25))}
AMPLE = {"tau_n": 0.329, "K_p": 0.8, "K_i": 3.0, "t_d": 0.06, "omega_n": 9.7705, "zeta": 0.8}
GAUGE = {
    "tau_dn": 0.32, "tau_up": 1.016, "k_q": 2.0, "g": 0.0, "v": 1.0, "K_p": 3.0, "K_i": 3.0, "t_d": 0.05,
    "t_sp": 0.05, "omega_n": 12.0, "zeta": 0.6, "c_set": 1.0, "t_gauge": 0.0,
}  # fmt: skip


@pytest.fixture
def gauge(make_response):
    """A gauge-aware fit that knows everything but what its priors know."""
    rng = np.random.default_rng(3)
    names = structure("GAUGE-CLOSED").names
    response = make_response(
        "GAUGE-CLOSED", {name: value for name, value in GAUGE.items() if name in names}, noise=0.002, rng=rng, **DENSE
    )

    def fitted(response=response, **priors):
        known = {"tau_up": Prior(1.016, 0.03), "g": Prior(0.0, 0.1), "t_gauge": Prior(0.0, 0.002)} | priors
        settings = Settings(starts=12, priors=known)
        return identify(structure("GAUGE-CLOSED"), response, rng=np.random.default_rng(1), settings=settings)

    return fitted, response


def test_every_kind_of_reason_has_its_row():
    assert set(AFFECTED) == set(get_args(ReasonKind))


@pytest.mark.slow
def test_what_does_not_hang_on_the_scale_of_the_gauge_stays_usable(gauge):
    """The slope of the load and the sum of the delays are ratios of what one recording shows."""
    fitted, _ = gauge
    before = assess(fitted())
    assert {"k_q", "t_d + t_sp", "tau_dn", "K_p / K_i"} <= set(before.trusted)
    scale = Reason(kind="gauge scale", sentence="The scale is in doubt.", where="M_s")
    verdict = assess(fitted(), reasons=(scale,))
    assert verdict.trustworthy
    assert {"k_q", "t_d + t_sp", "tau_dn"} <= set(verdict.trusted)
    assert verdict.not_trusted["K_p / K_i"] == "it depends on the scale of the torque gauge"
    assert verdict.reasons == (scale,)
    assert verdict.reason == "Part of the numbers can be trusted. The scale is in doubt."
    numbers = len(verdict.trusted) + len(verdict.not_trusted)
    assert verdict.words == f"trustworthy in part, {len(verdict.trusted)} of {numbers} numbers"
    assert sum("The scale is in doubt." in sentence for sentence in verdict.sentences) == 1
    assert {"K_p", "K_i"} <= set(before.not_trusted)
    assert before.words == "trustworthy, but not governor gains"


def test_reasons_of_the_response_come_with_it(gauge):
    fitted, response = gauge
    clock = Reason(kind="recording clock", sentence="The clock is in doubt.")
    verdict = assess(fitted(replace(response, reasons=(clock,))))
    assert not verdict.trustworthy
    assert verdict.trusted == ()
    assert verdict.reason == "The clock is in doubt."


def test_the_weightiest_reason_comes_first():
    small = Reason(kind="gear ratio", sentence="b")
    large = Reason(kind="clipping", sentence="a")
    assert by_weight((small, large, small)) == (large, small)


def test_an_unknown_number_depends_on_everything():
    """A number of an own structure is not in the table: nobody can say what it is made of."""
    own = Estimate(name="own", unit="-", value=1.0, std=0.1)
    assert all(depends_on(own, kind) for kind in AFFECTED if AFFECTED[kind][0])


@pytest.mark.parametrize(
    ("role", "unit", "in_doubt"),
    [
        (ShipRole.INERTIA_UPSTREAM, "s", True),
        (ShipRole.INERTIA_DOWNSTREAM, "s", False),
        (ShipRole.INERTIA_DOWNSTREAM, "kg m2", True),
        (ShipRole.PROPORTIONAL_GAIN, "-", True),
        (ShipRole.LOAD_SLOPE, "-", False),
        (ShipRole.LOOP_DELAY, "s", True),
        (ShipRole.TOTAL_DELAY, "s", False),
        (ShipRole.SET_POINT_SCALE, "-", False),
    ],
)
def test_a_wrong_scale_of_the_gauge_reaches_what_is_made_of_newton_metres(role, unit, in_doubt):
    """A gauge that shows everything 3 % too large: ratios of what it shows stay as they are."""
    number = Estimate(name="any name", unit=unit, value=1.0, std=0.1, role=role)
    assert depends_on(number, "gauge scale") == in_doubt


@pytest.mark.parametrize(
    ("role", "unit", "in_doubt"),
    [
        (ShipRole.TORQUE, "N m", True),
        (ShipRole.PROPORTIONAL_GAIN, "-", True),
        (ShipRole.INERTIA_DOWNSTREAM, "s", True),
        # in the units of the line changes of the torque tell them
        (ShipRole.INERTIA_DOWNSTREAM, "kg m2", False),
        (ShipRole.TORQUE, "-", False),
        (ShipRole.LOAD_SLOPE, "-", False),
        (ShipRole.TOTAL_DELAY, "s", False),
    ],
)
def test_a_wrong_zero_of_the_gauge_reaches_the_level_of_the_torque_and_what_is_over_it(role, unit, in_doubt):
    number = Estimate(name="any name", unit=unit, value=1.0, std=0.1, role=role)
    assert depends_on(number, "gauge zero") == in_doubt


def test_a_prior_that_is_pulled_is_named(gauge):
    """A latency that is known to be 12 +/- 2 ms, where the data show 0 to a fraction of that: six deviations."""
    fitted, _ = gauge
    verdict = assess(fitted(t_gauge=Prior(0.012, 0.002)))
    (reason,) = [reason for reason in verdict.reasons if reason.kind == "gauge latency"]
    assert reason.where == "t_gauge"
    assert "the prior is 0.0120 +/- 0.0020 s, the estimate is" in reason.sentence
    assert "t_d + t_sp" in verdict.not_trusted


@pytest.mark.slow
def test_without_profiles_they_are_made(gauge):
    fit = gauge[0]()
    assert assess(fit) == assess(fit, profile=profile(fit))


def test_a_structure_that_is_refitted_without_the_lines_that_it_misses_is_not_trusted(make_response):
    """A pick-up that smooths above 0.7 Hz: without the fast lines CL4 fits, and does not predict them."""
    response = make_response("CL4", AMPLE, noise=0.01, rng=np.random.default_rng(7), **DENSE)
    data = response.response.copy()
    data[0, 0] /= 1.0 + 0.08j * response.omega_rad_s * (LINES_HZ > 0.7)
    late = replace(response, response=data)
    names = [name for name, hz in zip(response.lines, LINES_HZ, strict=True) if hz < 0.7]
    few = identify(structure("CL4"), late, rng=np.random.default_rng(1), lines=names)
    verdict = assess(few)
    assert not verdict.trustworthy
    assert verdict.reasons[0].kind == "lines left out"
    assert f"from {2 * np.pi * LINES_HZ[0]:.2g} to {2 * np.pi * LINES_HZ[len(names) - 1]:.2g} rad/s" in (verdict.reason)
    right = identify(structure("CL4"), response, rng=np.random.default_rng(1), lines=names)
    assert all(reason.kind != "lines left out" for reason in assess(right).reasons)


def test_a_prior_that_the_data_pull_by_three_deviations_is_a_word_and_no_reason(gauge):
    """The data know the latency of the gauge to 0.1 ms beside 2 ms: it is as far from its prior as that is moved."""
    fitted, _ = gauge
    verdict = assess(fitted(t_gauge=Prior(-0.006, 0.002)))
    about = "what is assumed of t_gauge"
    assert not any(about in reason.sentence for reason in verdict.reasons)
    assert sum(about in caution for caution in verdict.cautions) == 1


def test_a_scale_of_the_set_point_that_a_lever_explains_is_a_word_and_no_reason(gauge):
    """A set point whose line is 0.9 % steeper than its levels said, known to 0.1 %."""
    fitted, response = gauge
    verdict = assess(fitted(replace(response, response=1.009 * response.response, covariance=response.covariance)))
    assert verdict.reasons == ()
    (caution,) = [one for one in verdict.cautions if "scale of the set point" in one]
    assert "c_set = 1.009" in caution or "c_set = 1.008" in caution
    assert not any("scale of the set point" in one for one in assess(fitted()).cautions)
