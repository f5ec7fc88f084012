"""Which structure wins, and whether the report says why."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.errors import IdentificationError
from shaftprint.identify import GivenStarts, Prior, Settings, Unweighted, compare_fits, compare_structures, identify
from shaftprint.identify.comparison._hold_out import HoldOut
from shaftprint.identify.comparison._sentences import comparison_words
from shaftprint.models import Gain, Parameter, PIGovernor, Structure

CL3 = {"tau_n": 0.35, "K_p": 1.6, "K_i": 4.4, "omega_n": 9.8, "zeta": 0.5}
SETTINGS = Settings(starts=12)


def compared(response, *names, seed=1, **options):
    settings = options.pop("settings", SETTINGS)
    return compare_structures(
        [structure(name) for name in names], response, rng=np.random.default_rng(seed), settings=settings, **options
    )


def test_the_true_structure_wins_and_the_report_says_why(make_response):
    response = make_response("CL4", noise=0.02, correlation=0.3, rng=np.random.default_rng(3))
    found = compared(response, "CL1", "CL3", "CL4")
    assert [candidate.name for candidate in found.candidates] == ["CL4", "CL3", "CL1"]
    assert found.best.name == "CL4"
    text = found.sentences
    assert text[0].startswith("CL4 wins: its BIC is ")
    assert text[0].endswith("below that of CL3, the next (very strong evidence).")
    assert any(s.startswith("CL4 explains the data (chi-square ") for s in text)
    rejected = next(s for s in text if s.startswith("CL3 is rejected"))
    assert "p < 1e-12" in rejected
    assert "the misfit is largest" in rejected
    needed = next(s for s in text if s.startswith("CL4 holds CL3 as a special case: one more parameter lowers"))
    assert needed.endswith("is needed (p < 1e-12).")
    hold_out = next(s for s in text if s.startswith("Lines left out"))
    assert hold_out.index("by CL4") < hold_out.index("by CL3") < hold_out.index("by CL1")
    assert sum(found.weights.values()) == pytest.approx(1.0)
    assert found.weights["CL4"] > 1.0 - 1e-9


def test_a_parameter_too_many_is_not_needed(make_response):
    response = make_response("CL3", CL3, noise=0.02, correlation=0.3, rng=np.random.default_rng(5))
    found = compared(response, "CL4", "CL3")
    assert found.best.name == "CL3"
    assert all(any(s.startswith(f"{name} explains the data") for s in found.sentences) for name in ("CL3", "CL4"))
    ratio = found.ratios[0]
    assert (ratio.small, ratio.large, ratio.extra) == ("CL3", "CL4", 1)
    assert ratio.p_value > 0.05
    assert any("CL4 holds CL3" in s and "is not needed" in s for s in found.sentences)
    # ln 52 for the parameter, less what it gained
    gap = found.candidates[1].criteria.bic - found.best.criteria.bic
    assert gap == pytest.approx(np.log(52.0) - ratio.statistic, abs=1e-6)


def test_a_parameter_that_no_data_could_find_is_named_so(make_response):
    """A gain beside the governor's own two does nothing that they cannot do: its likelihood ratio has no freedom."""
    k_p, k_i = structure("OL2").parameters
    gain = Parameter("b", "-", 0.5, 2.0, 1.0, "test")
    more = Structure(name="PI+gain", title="", input="e", outputs={"M_s": PIGovernor(k_p, k_i) * Gain(gain)})
    response = make_response("OL2", noise=0.02, rng=np.random.default_rng(5))
    found = compare_structures(
        [structure("OL2"), more], response, rng=np.random.default_rng(1), settings=SETTINGS, folds=0
    )
    assert found.best.name == "OL2"
    assert "PI+gain holds OL2 as a special case: no parameter more that the data can find (p = 1)." in found.sentences


def test_structures_that_explain_alike_are_not_told_apart(make_response):
    """The Pade approximation of a short delay on slow lines is the delay."""
    response = make_response("CL4", noise=0.02, rng=np.random.default_rng(5))
    found = compared(response, "CL4", "CL4-PADE5")
    assert found.sentences[0].startswith(("CL4 and CL4-PADE5 cannot", "CL4-PADE5 and CL4 cannot"))
    assert found.ratios == ()


def test_where_none_explains_the_data_the_winner_is_the_least_wrong(make_response):
    response = make_response("OL5", noise=0.005, rng=np.random.default_rng(5))
    found = compared(response, "OL2", "OL3")
    assert "None of the structures explains the data within their noise" in found.sentences[1]
    assert f"{found.best.name} is only the least wrong" in found.sentences[1]


def test_a_structure_that_cannot_be_fitted_is_named_and_cannot_win(make_response):
    response = make_response("OL5", noise=0.02, rng=np.random.default_rng(5))
    found = compared(response, "OL2", "OL5", lines=["S9", "S12"])
    assert [candidate.name for candidate in found.candidates] == ["OL2"]
    assert set(found.failed) == {"OL5"}
    assert found.sentences[0] == "OL2 is the only structure that could be fitted."
    assert any(s.startswith("OL5 could not be fitted: structure OL5 has 5 free parameters") for s in found.sentences)
    assert found.candidate("OL5") is None
    assert found.candidate("OL2") is found.best
    with pytest.raises(IdentificationError, match=r"none of the structures could be fitted: .*OL4.*OL5"):
        compared(response, "OL4", "OL5", lines=["S9"])


def test_without_freedom_left_nothing_is_tested(make_response):
    response = make_response("OL2", noise=0.02, rng=np.random.default_rng(5))
    fit = identify(structure("OL2"), response, rng=np.random.default_rng(1), settings=SETTINGS, lines=["S9"])
    found = compare_fits([fit], rng=np.random.default_rng(1), folds=0)
    assert any("OL2 has as many parameters as there are data" in s for s in found.sentences)


def test_unweighted_fits_are_compared_by_fit_percent(make_response):
    response = make_response("OL5", noise=0.02, rng=np.random.default_rng(5))
    found = compared(response, "OL2", "OL5", settings=Settings(starts=12, weighting=Unweighted()))
    assert any(s.startswith("OL5 reaches a FitPercent of M_s 9") and "a perfect model" in s for s in found.sentences)


def test_settings_may_differ_by_name_and_hold_priors_of_others(make_response):
    response = make_response("OL5", noise=0.02, rng=np.random.default_rng(5))
    sharp = Settings(starts=12, priors={"t_d": Prior(0.2, 1e-6), "K_p": Prior(4.0, 2.0)})
    found = compared(response, "OL4", "OL5", settings=sharp, folds=0)
    assert found.candidate("OL5").identification.value("t_d") == pytest.approx(0.2, abs=1e-4)
    assert tuple(found.candidate("OL4").identification.settings.priors) == ("K_p",)
    found = compared(response, "OL4", "OL5", settings={"OL5": sharp}, folds=0)
    assert found.candidate("OL4").identification.settings == Settings()


def test_leaving_lines_out_may_speak_against_bic(make_response):
    response = make_response("OL5", noise=0.02, rng=np.random.default_rng(5))
    first, second = compared(response, "OL4", "OL5", folds=0).candidates
    first = replace(first, hold_out=HoldOut(square=1.3, expected=1.1, folds=5))
    second = replace(second, hold_out=HoldOut(square=1.2, expected=1.1, folds=5))
    *_, told, against = comparison_words([first, second], {}, [])
    assert told.endswith(f"of 1.2 by {second.name} (1.1 expected), 1.3 by {first.name} (1.1 expected).")
    assert against.startswith(f"{second.name} predicts left-out lines better than {first.name}, which BIC prefers")


@pytest.mark.parametrize(
    ("gap", "words"),
    [(1.9, "cannot be told apart"), (2.1, "(some evidence)"), (6.1, "(strong evidence)"), (10.1, "(very strong evi")],
)
def test_what_a_difference_of_bic_is_worth(make_response, gap, words):
    """Kass and Raftery, Bayes factors, 1995, section 3.2."""
    response = make_response("OL5", noise=0.02, rng=np.random.default_rng(5))
    first, second = compared(response, "OL4", "OL5", folds=0).candidates
    at = first.criteria.bic - second.criteria.bic + gap
    second = replace(second, criteria=replace(second.criteria, deviance=second.criteria.deviance + at))
    assert words in comparison_words([first, second], {}, [])[0]


def test_a_test_without_a_law_says_where_its_probability_comes_from(make_response):
    response = make_response("OL5", noise=0.02, rng=np.random.default_rng(5))
    settings = Settings(starts=12, weighting=Unweighted())
    found = compared(response, "OL4", "OL5", settings=settings, folds=0, draws=19)
    because = "from 19 drawn tests, since the fits are not weighted by maximum likelihood"
    assert any(because in s for s in found.sentences)


def test_a_structure_that_a_part_of_the_lines_cannot_fit_predicts_nothing(make_response):
    response = make_response("OL5", noise=0.02, rng=np.random.default_rng(5))
    found = compared(response, "OL2", "OL5", lines=["S9", "S10", "S12"], folds=3)
    assert found.candidate("OL5").hold_out is None
    assert found.candidate("OL2").hold_out.folds == 3
    assert not any(s.startswith("Lines left out") for s in found.sentences)


def test_a_seed_reproduces_the_comparison_and_order_of_the_structures_does_not_matter(make_response):
    response = make_response("OL5", noise=0.02, rng=np.random.default_rng(5))
    one, two = (compared(response, "OL4", "OL5") for _ in range(2))
    assert one.sentences == two.sentences
    turned = compared(response, "OL5", "OL4")
    assert turned.best.name == one.best.name
    assert turned.best.criteria.bic == pytest.approx(one.best.criteria.bic, rel=1e-9)


def test_what_cannot_be_compared_is_refused_in_one_sentence(make_response):
    response = make_response("OL5", noise=0.02, rng=np.random.default_rng(5))
    with pytest.raises(
        IdentificationError,
        match="structures OL3 and CL4 explain different data, M_s from e and n, M_s from n_set: only structures of the "
        "same input and outputs can be compared by likelihood",
    ):
        compared(response, "OL3", "CL4")
    with pytest.raises(IdentificationError, match="two structures have the name OL3"):
        compared(response, "OL3", "OL3")
    with pytest.raises(IdentificationError, match="expected 2 or more structures, found 1"):
        compared(response, "OL3")
    fits = [
        identify(structure("OL2"), response, rng=np.random.default_rng(1), settings=SETTINGS),
        identify(structure("OL3"), response, rng=np.random.default_rng(1), settings=SETTINGS, lines=["S3", "S9"]),
    ]
    with pytest.raises(IdentificationError, match="OL2 and OL3 were not fitted to the same lines of the same"):
        compare_fits(fits, rng=np.random.default_rng(1))


def test_fits_at_hand_are_compared_without_a_new_search(make_response):
    response = make_response("OL5", noise=0.02, rng=np.random.default_rng(5))
    fits = [
        identify(s, response, rng=np.random.default_rng(1), settings=SETTINGS)
        for s in (structure("OL5"), replace(structure("OL5").held_at(t_d=0.1), name="OL5 held"))
    ]
    found = compare_fits(fits, rng=np.random.default_rng(1), folds=0)
    assert {id(candidate.identification) for candidate in found.candidates} == {id(fit) for fit in fits}
    assert [(ratio.small, ratio.large) for ratio in found.ratios] == [("OL5 held", "OL5")]
    assert found.best.hold_out is None


def test_a_larger_structure_whose_search_ended_too_early_starts_from_the_smaller(make_response):
    """A search of two steps leaves the larger structure worse than the one it holds, which it cannot be."""
    response = make_response("CL3", CL3, noise=0.02, correlation=0.3, rng=np.random.default_rng(5))
    small = identify(structure("CL3"), response, rng=np.random.default_rng(1), settings=SETTINGS)
    middle = np.array([[0.5 * (p.lower + p.upper) for p in structure("CL4").free]])
    early = Settings(starts=1, draw=GivenStarts(middle), max_iterations=2)
    stopped = identify(structure("CL4"), response, rng=np.random.default_rng(1), settings=early)
    assert stopped.cost > 2.0 * small.cost
    found = compare_fits([small, replace(stopped, settings=SETTINGS)], rng=np.random.default_rng(1), folds=0)
    assert found.candidate("CL4").identification.cost <= small.cost
    assert [(ratio.small, ratio.large) for ratio in found.ratios] == [("CL3", "CL4")]
    assert 0.0 <= found.ratios[0].statistic < 10.0
    assert sum(cluster.starts for cluster in found.candidate("CL4").identification.clusters) == 2
