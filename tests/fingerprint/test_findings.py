"""What is said in words: each rule where it applies, and where it does not."""

from dataclasses import replace
from re import match, search

import numpy as np
import pytest
from tests.known_fits import known_signals, known_working_point

from shaftprint.catalogue import ShipRole
from shaftprint.fingerprint import physical_quantities
from shaftprint.fingerprint._findings import findings_of
from shaftprint.identify import Budget, BudgetRow, Estimate, Prior, Settings, Unweighted, budget
from shaftprint.reasons import Note
from shaftprint.vessel import load_vessel

NO_BUDGET = Budget(sources=(), rows=())


def found(identification, physical=(), left_out=None, stated=NO_BUDGET):
    return findings_of(identification, physical, stated, left_out or {})


def one(findings, start):
    """Return the one finding that begins so."""
    matching = [finding for finding in findings if finding.startswith(start)]
    assert len(matching) == 1, findings
    return matching[0]


def none(findings, part):
    return not any(part in finding for finding in findings)


@pytest.fixture(scope="module")
def sharp(gauge_fit, put_by_hand):
    """A fit that knows every parameter to 1 % and that most starts reached."""
    winner = replace(gauge_fit.clusters[0], starts=18)
    std = {parameter.name: 0.01 * abs(parameter.value) for parameter in gauge_fit.parameters}
    return put_by_hand(replace(gauge_fit, clusters=(winner,)), std=std)


@pytest.fixture(scope="module")
def judged(working_point, vessel):
    """The findings on the physical values of a fit."""

    def judge(identification, point=working_point):
        return found(identification, physical_quantities(identification, point, vessel))

    return judge


def test_sharp_fit_of_a_good_line_says_only_that_it_is_stable(sharp):
    assert found(sharp) == ("The governed line is stable; its gain margin of 1.60 at 8.1 rad/s is small.",)


@pytest.mark.parametrize(
    ("gain", "words"), [(5.7, "small"), (2.5, "ample"), (8.0, "very small")], ids=["small", "ample", "very small"]
)
def test_gain_margin_in_words(gauge_fit, put_by_hand, gain, words):
    stable = one(found(put_by_hand(gauge_fit, values={"K_p": gain})), "The governed line is stable")
    assert stable.endswith(f"rad/s is {words}.")


def test_a_margin_that_is_not_known_is_not_called_small_beside_a_verdict_that_says_so(fit, take, truth):
    """With two in a hundred of noise the gain margin may be small or not; a sharp test knows."""
    settings = Settings(starts=20, priors={"g": Prior(0.0, 0.1)})
    for share, known in ((0.02, False), (0.001, True)):
        fingerprint = take(fit("GAUGE-CLOSED", truth, share=share, settings=settings))
        assert ("gain margin" not in fingerprint.verdict.not_trusted) is known
        stable = one(fingerprint.findings, "The governed line is stable; its gain margin of 1.6")
        assert stable.endswith("is small." if known else "is not known well enough to call it small or ample.")
        assert any("is small is not known" in text for text in fingerprint.verdict.cautions) is not known


def test_a_sentence_has_the_interval_of_the_table(fit, take, truth):
    """A load that wanders by a fifth widens what the noise alone would leave, in both."""
    wandering = known_signals(replace(known_working_point(), load_std=0.2, shaft_torque_std_nm=345.0))
    settings = Settings(starts=20, priors={"g": Prior(0.0, 0.1)})
    fingerprint = take(fit("GAUGE-CLOSED", truth, share=0.03, settings=settings), signals=wandering)
    told = [search(r"^(\S+) = \S+ \(95 % interval (-?[\d.]+) to (-?[\d.]+)", text) for text in fingerprint.findings]
    compared = {found[1]: found.groups()[1:] for found in told if found}
    assert {"tau_up", "t_d"} <= set(compared)
    for name, ends in compared.items():
        (number,) = (one for one in fingerprint.parameters if one.name == name)
        last = 10.0 ** -max(len(end.partition(".")[2]) for end in ends)
        assert [float(end) for end in ends] == pytest.approx(number.interval_95, abs=0.51 * last), name


def test_how_a_file_was_read_is_told_and_is_no_remark_on_the_signals(gauge_fit, take):
    read, cut = Note("The text is no UTF-8 and was read as cp1252 (--encoding)."), "channel M_s: 3 samples are cut off"
    fingerprint = take(gauge_fit, signals=replace(known_signals(known_working_point()), findings=(read, cut)))
    assert fingerprint.quality.remarks == (cut,)
    assert read in fingerprint.findings


def test_unstable_line(gauge_fit, put_by_hand):
    unstable = put_by_hand(gauge_fit, values={"K_p": 11.0})
    assert found(unstable)[0] == "The identified line is unstable: 2 poles in the right half plane."


def test_line_that_no_gain_makes_hunt(fit):
    first = found(fit("CL1", {"tau_n": 0.39, "K_p": 3.0, "K_i": 4.0}))[0]
    assert first == "The governed line is stable, and no gain of the governor makes it hunt."


def test_no_word_on_stability_without_feedback(fit):
    assert found(fit("OL1", {"tau_n": 0.39})) == ()


def test_misfit(sharp):
    # of chi-square with 46 degrees of freedom 66 is exceeded in 2.8 % of the tests, 92 in 0.0066 %
    def judged(chi_square, freedom=46, **changes):
        tested = replace(sharp.fit_test, chi_square=chi_square, degrees_of_freedom=freedom, mean=46.0, variance=92.0)
        return found(replace(sharp, fit_test=tested, **changes))

    assert none(judged(66.0), "explain")
    worse = one(judged(92.0), "The structure does not explain the data")
    assert "chi-square is 92 for 46 degrees of freedom (p = 6.6e-5)" in worse
    assert none(judged(92.0, settings=replace(sharp.settings, weighting=Unweighted())), "explain")
    assert none(judged(92.0, freedom=0), "explain")


def test_bound(sharp, put_by_hand):
    stopped = put_by_hand(sharp, values={"omega_n": 60.0})
    assert one(found(stopped), "omega_n stopped") == (
        "omega_n stopped at its bound 60 rad/s: use its 95 % interval, a standard deviation means little there; "
        "the test does not determine it, or the structure does not fit."
    )
    assert none(found(sharp), "bound")


def test_search(sharp):
    winner = sharp.clusters[0]
    for starts, few in ((2, True), (3, False)):
        searched = replace(sharp, clusters=(replace(winner, starts=starts),))
        assert none(found(searched), "starts reached") is not few
    few = replace(sharp, clusters=(replace(winner, starts=2),))
    assert "Only 2 of 20 starts reached the optimum: use more starts." in found(few)


def test_delays_that_only_their_sum_is_known_of(fit, truth):
    """At 0.3 % of noise t_d and t_sp trade against each other, together with the lag."""
    settings = Settings(starts=20, priors={"g": Prior(0.0, 0.1)})
    vague = fit("GAUGE-CLOSED", truth, share=0.005, settings=settings)
    findings = found(vague)
    for name, value in (("t_d", r"0\.070\d?"), ("t_sp", r"0\.05(2|18)")):
        text = one(findings, f"{name} = ")
        assert match(rf"{name} = {value} \+/- 0\.0\d+ s is poorly determined by this test; better determined: ", text)
        assert search(r"better determined: .*t_d \+ t_sp = 0\.1221\d? \+/- 0\.000\d+ s", text)
        assert "K_p / K_i" not in text


def test_parameter_without_a_better_known_combination(sharp, put_by_hand):
    vague = one(found(put_by_hand(sharp, std={"zeta": 0.2})), "zeta")
    assert vague == "zeta = 0.47 +/- 0.20 is poorly determined by this test."


def test_parameter_of_which_nothing_is_known(sharp, put_by_hand):
    assert one(found(put_by_hand(sharp, std={"zeta": np.inf})), "zeta").endswith(
        "(not known) is poorly determined by this test."
    )


def test_known_to_a_tenth_is_known(sharp, put_by_hand):
    assert none(found(put_by_hand(sharp, std={"zeta": 0.0469})), "poorly determined")
    assert not none(found(put_by_hand(sharp, std={"zeta": 0.0471})), "poorly determined")


def test_a_prior_is_not_complained_of(sharp, put_by_hand):
    assert none(found(put_by_hand(sharp, std={"g": 1.0})), "poorly determined")
    without = replace(sharp, settings=Settings(starts=20, priors={"tau_up": Prior(1.016, 0.1)}))
    assert not none(found(put_by_hand(without, std={"g": 1.0})), "poorly determined")


def test_parameter_of_either_sign_is_compared_with_its_range(sharp, put_by_hand):
    """g is 0 +/- 0.1 in a range from -3 to 0.9: known well, although every deviation is large beside 0."""
    without = replace(sharp, settings=Settings(starts=20))
    assert none(found(put_by_hand(without, std={"g": 0.1})), "poorly determined")
    assert not none(found(put_by_hand(without, std={"g": 0.4})), "poorly determined")


@pytest.mark.parametrize(
    ("share", "std", "said"),
    [(3.0, 0.2, True), (-3.0, 0.2, True), (0.39, 0.2, False), (0.41, 0.2, True), (3.0, 2.0, False)],
)
def test_zero_of_the_gauge_is_told_from_two_standard_deviations_on(sharp, share, std, said):
    zero = Estimate(name="gauge zero share", unit="%", value=share, std=std)
    told = [finding for finding in found(sharp, (zero,)) if finding.startswith("gauge zero share")]
    assert bool(told) is said
    if said:
        assert told[0] == (
            f"gauge zero share = {share:.2f} +/- 0.20 %: the torque gauge has a zero offset, there is constant "
            "friction, or the inflow is not zero."
        )


def test_numbers_that_rest_on_priors(sharp):
    """Of the variance of ``K_p`` 60 % is that of the prior of ``g``; of ``zeta`` 40 %."""
    rows = tuple(
        BudgetRow(name=name, unit="-", value=1.0, variances={"noise of n": 1.0 - share, "prior of g": share})
        for name, share in (("g", 0.99), ("K_p", 0.6), ("zeta", 0.4), ("gain margin", 0.51))
    )
    text = one(found(sharp, stated=Budget(sources=("noise of n", "prior of g"), rows=rows)), "More than half")
    assert text == (
        "More than half of the variance of K_p (60 %), gain margin (51 %) is not from the noise of this test but from "
        "what is assumed, most of it the prior g = 0.00 +/- 0.10."
    )
    assert none(found(sharp, stated=Budget(sources=("noise of n", "prior of g"), rows=rows[2:3])), "More than half")


def test_many_numbers_that_rest_on_priors_are_counted(sharp):
    shares = {"a": 0.51, "b": 0.61, "c": 0.71, "d": 0.81, "e": 0.91}
    rows = tuple(
        BudgetRow(name=name, unit="-", value=1.0, variances={"noise of n": 1.0 - share, "gauge scale": share})
        for name, share in shares.items()
    )
    text = one(found(sharp, stated=Budget(sources=("noise of n", "gauge scale"), rows=rows)), "More than half")
    assert text == (
        "More than half of the variance of 5 numbers, the largest parts e (91 %), d (81 %), c (71 %), b (61 %), is not "
        "from the noise of this test but from what is assumed, most of it gauge scale."
    )


def test_the_working_point_and_the_set_point_are_measured(sharp, gauge_fit):
    variances = {"noise of n": 0.1, "working-point torque": 0.6, "set-point calibration": 0.3}
    rows = (BudgetRow(name="K_Q", unit="-", value=1.0, variances=variances),)
    common = {"set-point calibration": np.zeros(gauge_fit.response.response.shape)}
    part = replace(gauge_fit.experiments[0], response=replace(gauge_fit.response, common=common))
    told = replace(sharp, parts=(part,))
    assert none(found(told, stated=Budget(sources=tuple(variances), rows=rows)), "priors")


def test_a_fit_without_priors_rests_on_nothing(fit, truth):
    free = fit("GAUGE-CLOSED", truth)
    assert none(found(free, stated=budget(free)), "priors")


def test_inertia_off_the_torsional_vibration_calculation(sharp, put_by_hand, judged):
    """Three times the downstream inertia: 51 against 17.0 +/- 1.6 kg m2."""
    heavy = judged(put_by_hand(sharp, values={"tau_dn": 0.96}))
    assert one(heavy, "I_dn") == "I_dn = 51.03 kg m2 against 17 kg m2 of the vessel file: a factor 3.00."
    light = judged(put_by_hand(sharp, values={"tau_dn": 0.16}))
    assert one(light, "I_dn").endswith("a factor 2.00.")
    assert none(judged(put_by_hand(sharp, values={"tau_dn": 0.36})), "I_dn")


def test_a_value_of_nothing_has_no_factor(sharp, working_point, vessel):
    """An inertia at its bound of zero, with the standard deviation of its fit."""
    values = physical_quantities(sharp, working_point, vessel)
    nothing = [replace(value, value=0.0) if value.name == "I_dn" else value for value in values]
    assert one(found(sharp, tuple(nothing)), "I_dn") == "I_dn = 0 kg m2 against 17 kg m2 of the vessel file."


def test_inertia_of_the_thesis_is_explained(fit, judged):
    assert one(judged(fit("OL1", {"tau_n": 0.3897})), "I ") == (
        "I = 20.71 kg m2 against 54.01 kg m2 of the vessel file: a factor 2.61. A torque gauge shows only the "
        "inertia downstream of it: compare with that, or fit a gauge-aware structure."
    )


def test_torque_coefficient_off_the_vessel_file(sharp, judged, working_point):
    """12 % more torque at the same speed; gauge scale and zero allow 2.5 %."""
    fouled = judged(sharp, replace(working_point, shaft_torque_nm=1.12 * 1725.0))
    assert one(fouled, "K_Q").startswith("K_Q = 0.05536 against 0.04943 of the vessel file: a factor 1.12.")
    assert none(judged(sharp, replace(working_point, shaft_torque_nm=1.05 * 1725.0)), "K_Q")


@pytest.mark.slow
def test_lines_left_out_are_named_with_their_reason(sharp, fit, take, fingerprint):
    assert found(sharp, left_out={"S15": "aliased"})[-1] == "Line S15 is left out: aliased."
    used = np.arange(14) != 13
    part = take(fit("OL1", {"tau_n": 0.39}, used=used, remarks={"S14": "above 2.6 Hz: aliased"}))
    assert part.findings[-1] == "Line S14 is left out: above 2.6 Hz: aliased."
    assert none(fingerprint.findings, "left out")


@pytest.mark.parametrize(
    ("ship", "found_value", "way", "other"),
    [("stan-tug-1205", 0.0440, "astern", 0.0440), ("stan-tug-1205-astern", 0.0561, "ahead", 0.05606)],
)
def test_torque_coefficient_of_the_other_direction(gauge_fit, ship, found_value, way, other):
    vessel = load_vessel(ship)
    if way == "astern":
        stated = vessel.propeller.model_copy(update={"astern_torque_coefficient": other})
        vessel = vessel.model_copy(update={"propeller": stated})
    number = Estimate(
        name="K_Q",
        unit="-",
        value=found_value,
        std=0.001,
        expected=vessel.torque_coefficient,
        meaning="torque coefficient",
        role=ShipRole.TORQUE,
    )
    finding = one(findings_of(gauge_fit, (number,), NO_BUDGET, {}, vessel=vessel), "K_Q = ")
    assert finding.endswith(f"Of a shaft that turns {way} it states {other:.4g}: check direction of its working point.")
    # without the other coefficient the propeller may have changed
    bare = vessel.propeller.model_copy(update={"astern_torque_coefficient": None, "torque_coefficient": 0.07})
    bare_vessel = vessel.model_copy(update={"propeller": bare})
    finding = one(findings_of(gauge_fit, (number,), NO_BUDGET, {}, vessel=bare_vessel), "K_Q = ")
    assert finding.endswith("The propeller, its inflow or the torque gauge has changed.")
