"""Changes of a known line, without noise: which cause is named, how large it is, and what cancels."""

from dataclasses import replace

import numpy as np
import pytest
from tests.known_fits import TRUTH, fitted, known_signals, known_working_point, taken

from shaftprint.drift import differ
from shaftprint.drift._pair import pair_of
from shaftprint.drift._words import finding_sentences
from shaftprint.fingerprint import SourceFile
from shaftprint.identify import Prior, Settings
from shaftprint.reasons import Reason
from shaftprint.vessel import Vessel, load_vessel

# The prior of the upstream inertia as a vessel file gives it: known to 2 % beside the scale of the gauge, another 2 %.
STD = 0.0285
HALF = STD / np.sqrt(2.0)
PRIORS = {
    "g": Prior(0.0, 0.1),
    "tau_up": Prior(1.016, STD, sources={"TVC": HALF, "gauge scale": -HALF}),
}


def fingerprint(g=0.0, **changes):
    values = TRUTH | {name: factor * TRUTH[name] for name, factor in changes.items()} | {"g": g}
    return taken(fitted("GAUGE-CLOSED", values, share=0.002, settings=Settings(starts=20, priors=PRIORS)))


def deviation(first, other, name):
    """Return the standard deviation of the difference of one number of an unchanged ship."""
    pair = pair_of(first, other, load_repeatability=0.005)
    place = pair.names.index(name)
    return float(np.sqrt(pair.covariance[place, place]))


@pytest.fixture(scope="module")
def before():
    return fingerprint()


def test_an_unchanged_line_has_not_changed(before):
    finding = differ(before, before)
    assert finding.changes == ()
    assert finding.rest_p_value == pytest.approx(1.0)
    assert finding_sentences(finding) == ("No: 9 numbers of the ship, judged together, agree within chance.",)


ELASTIC = TRUTH | {"k_c": 700.0, "d_c": 2.0}


def elastic_fingerprint(**changes):
    values = ELASTIC | {name: factor * ELASTIC[name] for name, factor in changes.items()}
    return taken(fitted("GAUGE-ELASTIC", values, share=0.002, settings=Settings(starts=20, priors=PRIORS)))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("changes", "cause", "size"),
    [
        ({"k_c": 0.8}, "stiffness of the coupling", -0.2),
        pytest.param({"tau_dn": 1.02}, "inertia behind the gauge", 0.02, marks=pytest.mark.long),
    ],
)
def test_a_coupling_that_ages_is_named_and_nothing_else_is_taken_for_it(changes, cause, size):
    (change,) = differ(elastic_fingerprint(), elastic_fingerprint(**changes)).changes
    assert change.best.cause.name == cause
    assert change.best.size == pytest.approx(size, abs=0.1 * abs(size))


@pytest.mark.parametrize(
    ("changes", "cause", "size"),
    [
        ({"K_p": 0.95}, "proportional gain of the governor", -0.05),
        ({"K_p": 0.95, "K_i": 0.95}, "injection or turbocharger", -0.05),
        ({"K_i": 1.1}, "integral gain of the governor", 0.1),
        ({"t_d": 1.1}, "delay of governor and fuel", 0.00703),
        ({"t_sp": 0.9}, "latency of the set point", -0.00518),
        ({"omega_n": 0.97}, "fuel actuator", -0.03),
        ({"tau_dn": 1.02}, "inertia behind the gauge", 0.02),
    ],
)
def test_the_cause_of_a_change_is_named_with_its_size(before, changes, cause, size):
    """Without noise the estimates are the truth but for the priors, which stand where the truth is."""
    finding = differ(before, fingerprint(**changes))
    best = finding.changes[0].best
    assert best.cause.name == cause
    assert best.size == pytest.approx(size, rel=0.02)
    assert best.std < 0.5 * abs(size)
    assert len(finding.changes) == 1


def test_a_gain_is_seen_to_have_changed_by_half_of_what_it_is_known_to(before):
    """By itself the gain is known to two and a half per cent; against the other numbers to a tenth of that."""
    gain = before.quantity("governor proportional action")
    assert gain.std > 0.025 * gain.value
    best = differ(before, fingerprint(K_p=0.9875)).changes[0].best
    assert best.cause.name == "proportional gain of the governor"
    assert best.size == pytest.approx(-0.0125, rel=0.02)
    assert best.std < 0.0025


@pytest.mark.slow
def test_more_propeller_torque_is_seen_beyond_the_load_of_the_day(before):
    """K_Q goes with the torque of the working point, known to 0.5 % in each test and to 0.5 % from day to day."""
    point = known_working_point()
    heavier = replace(point, shaft_torque_nm=1.1 * point.shaft_torque_nm)
    values = TRUTH | {name: TRUTH[name] / 1.1 for name in ("K_p", "K_i", "tau_dn", "tau_up")}
    priors = {
        **PRIORS,
        "tau_up": Prior(1.016 / 1.1, STD / 1.1, sources={"TVC": HALF / 1.1, "gauge scale": -HALF / 1.1}),
    }
    fit = fitted("GAUGE-CLOSED", values, share=0.002, settings=Settings(starts=20, priors=priors))
    finding = differ(before, taken(fit, signals=known_signals(heavier)))
    best = finding.changes[0].best
    assert best.cause.name == "propeller"
    assert best.size == pytest.approx(0.1, rel=0.01)
    assert best.std == pytest.approx(1.1 * np.sqrt(2.0 * (0.005**2 + 0.005**2)), rel=0.1)
    assert differ(before, taken(fit, signals=known_signals(heavier)), load_repeatability=0.05).changes == ()


@pytest.mark.slow
def test_an_assumption_that_is_wrong_in_both_tests_cancels():
    """The engine's slope is one and a half deviations from what both vessel files assume."""
    same, weaker = fingerprint(g=0.15), fingerprint(g=0.15, K_p=0.95)
    assert same.quantity("K_p").value != pytest.approx(5.7, rel=0.01)
    assert differ(same, fingerprint(g=0.15)).changes == ()
    best = differ(same, weaker).changes[0].best
    assert best.cause.name == "proportional gain of the governor"
    assert best.size == pytest.approx(-0.05, rel=0.05)


def test_a_calibration_that_was_made_anew_counts_in_full(before):
    content = load_vessel("stan-tug-1205").model_dump()
    content["sensors"]["shaft_torque"]["scale_nm_per_unit"] *= 1.03
    anew = Vessel.model_validate(content)
    sources = (
        SourceFile(role="vessel", name="tug.toml", sha256="ce" * 32),
        *(source for source in before.sources if source.role != "vessel"),
    )
    fit = fitted("GAUGE-CLOSED", TRUTH, share=0.002, settings=Settings(starts=20, priors=PRIORS))
    other = taken(fit, vessel=anew).model_copy(update={"sources": sources})
    own, both = deviation(before, before, "I_dn"), deviation(before, other, "I_dn")
    assert own < 0.003
    # scales that are known to 2 % each
    assert both == pytest.approx(np.sqrt(2.0 * 0.02**2 + own**2), rel=0.01)


def test_numbers_that_hang_on_a_doubt_are_left_out(before):
    """A scale that the data contradict spoils torques in N m, and all that is told apart with the upstream inertia."""
    doubt = Reason(kind="gauge scale", sentence="The scale of the gauge is doubtful.")
    longer = fingerprint(t_d=1.1)
    doubtful = longer.model_copy(update={"verdict": replace(longer.verdict, reasons=(doubt,))})
    finding = differ(before, doubtful)
    assert finding.left_out["K_Q"] == "it depends on the scale of the torque gauge"
    assert finding.left_out["governor proportional action"] == finding.left_out["K_Q"]
    assert finding.names == ()


def test_where_all_numbers_hang_on_a_doubt_nothing_is_told(before):
    doubt = Reason(kind="misfit", sentence="The structure does not explain the data.")
    doubtful = before.model_copy(update={"verdict": replace(before.verdict, reasons=(doubt,))})
    finding = differ(before, doubtful)
    assert finding.names == ()
    assert finding_sentences(finding) == ("It cannot be told: no number of both fingerprints can be judged.",)


def test_a_fingerprint_of_an_earlier_version_is_said(before):
    earlier = before.model_copy(update={"joint": None})
    (sentence,) = finding_sentences(differ(before, earlier))
    assert "has no joint covariance; identify its recording again" in sentence


def with_held(fingerprint, name):
    own = [list(row) for row in fingerprint.joint.own_covariance]
    at = fingerprint.joint.names.index(name)
    for other in range(len(own)):
        own[other][at] = own[at][other] = 0.0
    joint = fingerprint.joint.model_copy(update={"own_covariance": tuple(map(tuple, own))})
    return fingerprint.model_copy(update={"joint": joint})


def test_a_number_that_was_held_is_left_out(before):
    finding = differ(before, with_held(before, "I_up"))
    assert finding.left_out == {"I_up": "it was held"}
    assert finding.changes == ()


def test_a_cause_that_could_not_be_judged_is_not_excluded(before):
    finding = differ(before, with_held(fingerprint(t_d=1.2), "t_d"))
    assert [cause.name for cause in finding.not_judged] == ["delay of governor and fuel"]
    assert finding_sentences(finding)[-1] == "Not excluded, since it could not be judged: delay of governor and fuel."


def test_numbers_of_which_one_follows_from_another_are_not_judged_together(before):
    size = len(before.joint.names)
    same = tuple((1e-4,) * size for _ in range(size))
    joint = before.joint.model_copy(update={"own_covariance": same, "loadings": {}})
    twin = before.model_copy(update={"joint": joint})
    assert (
        differ(twin, twin, load_repeatability=0.0).because == "the covariance of the numbers is not positive definite"
    )


def test_a_test_astern_is_not_held_against_the_propeller_ahead(before):
    """Ahead and astern a propeller takes another torque and more or less water: that is no change of the ship."""
    fit = fitted("GAUGE-CLOSED", TRUTH, share=0.002, settings=Settings(starts=20, priors=PRIORS))
    astern = taken(fit, vessel=load_vessel("stan-tug-1205-astern"))
    pair = pair_of(before, astern, load_repeatability=0.005)
    why = "the shaft did not turn the same way, and the propeller takes another torque astern"
    assert pair.left_out["K_Q"] == pair.left_out["I_dn"] == why
    assert "governor proportional action" in pair.names
    assert pair_of(astern, astern, load_repeatability=0.005).left_out.get("K_Q", "") == ""
