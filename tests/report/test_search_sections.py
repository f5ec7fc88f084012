"""Verdict, search and comparison in the report: what they say and show."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.identify import Settings, Unweighted, compare_fits, identify, scan
from shaftprint.markup import cell_html
from shaftprint.reasons import Reason
from shaftprint.report import scan_chart
from shaftprint.report.charts._text import as_plain
from shaftprint.report.sections._engineer import number_section, verdict_section
from shaftprint.report.sections._results import summary_section
from shaftprint.report.sections._search import comparison_section, search_section


def cells(table):
    return [[str(cell) for cell in row] for row in table.rows]


# ---- verdict ----


@pytest.mark.slow
def test_the_verdict_comes_in_words_the_reason_first(fingerprint):
    section = verdict_section(SimpleNamespace(fingerprint=fingerprint))
    assert section.title == "Verdict: the fit is trustworthy, but not governor gains and margins"
    assert section.paragraphs[1:] == (fingerprint.verdict.reason,)
    assert section.points == fingerprint.verdict.cautions
    assert summary_section(SimpleNamespace(fingerprint=fingerprint)).paragraphs[0] == fingerprint.verdict.reason


def test_the_table_of_numbers_says_what_the_verdict_says(fingerprint):
    """One rule for what is known: a number may be used where the verdict trusts it, and else the verdict says why."""
    verdict = fingerprint.verdict
    (table,) = number_section(SimpleNamespace(fingerprint=fingerprint)).tables
    told = {str(row[0]): row[-2:] for row in table.rows}
    # as many as page one counts, those of the working point too
    assert {name for name, (words, _) in told.items() if words == "yes"} == {*verdict.trusted}
    assert {*told} == {*verdict.trusted, *verdict.not_trusted}
    assert {"n_0", "M_s0"} < {*told}
    assert verdict.not_trusted
    for name, doubt in verdict.not_trusted.items():
        words, meaning = told[name]
        assert words == "no"
        assert meaning.endswith(f". Not to be used: {doubt}")
    refused = fingerprint.model_copy(update={"verdict": replace(verdict, trustworthy=False)})
    (table,) = number_section(SimpleNamespace(fingerprint=refused)).tables
    assert {row[-2] for row in table.rows} == {"no"}


def test_a_fit_that_is_not_trustworthy_says_so_in_the_heading(fingerprint):
    verdict = replace(
        fingerprint.verdict,
        trustworthy=False,
        reason="It fails.",
        reasons=(Reason(kind="misfit", sentence="It fails."), Reason(kind="suspect", sentence="A hint: look there.")),
        cautions=(),
    )
    section = verdict_section(SimpleNamespace(fingerprint=fingerprint.model_copy(update={"verdict": verdict})))
    assert section.title == "Verdict: the fit is not trustworthy"
    assert (section.paragraphs[1:], section.points) == (("It fails.",), ("A hint: look there.",))


# ---- search ----


def test_a_value_of_nothing_is_not_printed_with_its_rounding_error(fits):
    """The known line has no zero, but an optimum may lie at one: what the deviation leaves of it is nought."""
    fit = fits["OL3"]
    name, std = fit.parameters[0].name, fit.parameters[0].std
    place = fit.objective.names.index(name)
    winner = fit.clusters[0]
    values = winner.values.copy()
    values[place] = -6.7e-13 * std
    at_zero = replace(fit, clusters=(replace(winner, values=values), *fit.clusters[1:]))
    (table,) = search_section(SimpleNamespace(identification=at_zero)).tables
    (row,) = (row for row in table.rows if str(row[0]).startswith(f"{name} ["))
    assert float(row[1]) == 0.0
    assert len(row[1]) < 8


def test_every_optimum_has_a_column_with_its_parameters(fits):
    section = search_section(SimpleNamespace(identification=fits["OL3"]))
    (table,) = section.tables
    assert [column.heading for column in table.columns[:3]] == ["optimum", "the result", "2"]
    rows = cells(table)
    assert [row[0] for row in rows[:4]] == ["starts", "cost", "deviance above the result", "stable"]
    assert [cell_html(row[0], table) for row in table.rows[4:]] == [
        "<i>K</i><sub>p</sub> [-]", "<i>K</i><sub>i</sub> [s⁻¹]", "<i>t</i><sub>d</sub> [s]"
    ]  # fmt: skip
    assert rows[2][1] == "–"
    assert sum(map(int, rows[0][1:])) <= fits["OL3"].settings.starts
    assert float(rows[4][1]) == pytest.approx(fits["OL3"].value("K_p"), rel=1e-3)
    assert section.points[0].endswith(".")


def test_more_optima_than_fit_on_a_page_are_counted(fits, monkeypatch):
    monkeypatch.setattr("shaftprint.report.sections._search.MOST_OPTIMA", 1)
    table = search_section(SimpleNamespace(identification=fits["OL3"])).tables[0]
    assert len(table.columns) == 2
    assert "more of higher cost are not shown" in table.note


def test_the_cost_along_every_free_delay_is_drawn(fits):
    names = {
        name: [p.name for p in search_section(SimpleNamespace(identification=fits[name])).pictures] for name in fits
    }
    assert names["OL1"] == names["OL2"] == names["CL1"] == []
    assert names["OL3"] == names["OL5"] == names["CL4"] == ["scan_t_d"]
    chart = search_section(SimpleNamespace(identification=fits["OL3"])).pictures[0].chart()
    assert as_plain(chart.panels[0].x.title) == "t_d [s]"


def test_the_curve_is_the_root_of_the_deviance_and_its_optima_lie_on_it(fits):
    fit = fits["OL3"]
    scanned = scan(fit, "t_d")
    limit, curve, optima = scan_chart(scanned, fit).panels[0].marks
    assert curve.y == pytest.approx(np.sqrt(np.maximum(2.0 * (scanned.cost - scanned.best.cost), 0.0)), abs=1e-9)
    assert optima.y[0] == 0.0
    assert list(optima.x) == [minimum.value for minimum in scanned.minima]
    assert limit.at == pytest.approx(1.96, abs=1e-4)


def test_without_weights_the_curve_is_that_of_one_unknown_variance(response, open_responses):
    governor, _ = open_responses
    settings = Settings(weighting=Unweighted(), starts=12)
    fit = identify(structure("OL3"), governor, rng=np.random.default_rng(3), settings=settings)
    scanned = scan(fit, "t_d", grid=[0.0, 0.2])
    curve = scan_chart(scanned, fit).panels[0].marks[1]
    expected = np.sqrt(24.0 * np.log(scanned.cost / scanned.best.cost))
    assert curve.y == pytest.approx(expected, rel=1e-9)


# ---- which structure ----


def test_structures_of_the_same_channels_are_compared_in_words_and_numbers(fits):
    compared = compare_fits([fits["OL2"], fits["OL3"]], rng=np.random.default_rng(1))
    (section,) = comparison_section(SimpleNamespace(comparisons=(compared,)))
    assert section.title == "Which structure"
    assert list(section.points) == list(compared.sentences)
    criteria, nested = section.tables
    rows = cells(criteria)
    assert [row[0] for row in rows] == [candidate.name for candidate in compared.candidates]
    assert criteria.title == "Structures of M_s from e, lowest BIC first"
    assert "24 data" in criteria.note
    (ratio,) = cells(nested)
    assert ratio[:3] == ["OL2", "OL3", "1"]


def test_what_is_not_known_of_a_structure_is_left_blank(fits, open_responses):
    governor, _ = open_responses
    settings = Settings(weighting=Unweighted(), starts=5)
    plain = [
        identify(structure(name), governor, rng=np.random.default_rng(3), settings=settings) for name in ("OL2", "OL4")
    ]
    compared = compare_fits(plain, rng=np.random.default_rng(1), folds=0)
    (section,) = comparison_section(SimpleNamespace(comparisons=(compared,)))
    assert len(section.tables) == 1
    for row in cells(section.tables[0]):
        assert row[2] == row[4] == "–"
    assert section.tables[0].columns[-1].heading == "FPE"


def test_without_comparisons_there_is_no_section():
    assert comparison_section(SimpleNamespace(comparisons=())) == []


def test_where_a_p_value_comes_from_is_told(fits, open_responses):
    governor, _ = open_responses
    settings = Settings(weighting=Unweighted(), starts=5)
    pair = [
        identify(structure(name), governor, rng=np.random.default_rng(3), settings=settings) for name in ("OL2", "OL3")
    ]
    compared = compare_fits(pair, rng=np.random.default_rng(1), folds=0, draws=9)
    (section,) = comparison_section(SimpleNamespace(comparisons=(compared,)))
    assert cells(section.tables[1])[0][-1] == "9 drawn tests"
    bound = replace(compared.ratios[0], draws=0)
    (section,) = comparison_section(SimpleNamespace(comparisons=(replace(compared, ratios=(bound,)),)))
    assert cells(section.tables[1])[0][-1] == "an upper bound"
    law = replace(bound, reason="")
    (section,) = comparison_section(SimpleNamespace(comparisons=(replace(compared, ratios=(law,)),)))
    assert cells(section.tables[1])[0][-1] == "chi-square"
