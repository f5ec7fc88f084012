import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.identify import Estimate
from shaftprint.markup._html import sentence_html, symbol_html
from shaftprint.report.sections._results import fit_section
from shaftprint.tables import Table, parameter_table, texts
from shaftprint.tables._fingerprint import combination_table, expected_text, fit_table, truth_of_combinations
from shaftprint.tables._signals import calibration_table, repair_table, step_table, strip_table, window_table


def with_parameters(fingerprint, *quantities):
    return fingerprint.model_copy(update={"parameters": quantities})


def test_intervals_of_the_profile_and_open_ends(fingerprint):
    profiled = Estimate(
        name="t_d", unit="s", value=0.0655, std=0.051, interval_95=(0.0, 0.0991), interval_open=(True, False)
    )
    upper = Estimate(name="K_p", unit="-", value=5.0, std=0.5, interval_95=(4.0, 20.0), interval_open=(False, True))
    unknown = Estimate(name="v", unit="-", value=1.0, std=math.inf, at_bound=True)
    table = parameter_table(with_parameters(fingerprint, profiled, upper, unknown), {})
    assert [row[2] for row in table.rows] == ["0.000* to 0.099", "4.0 to 20.0*", "not known"]
    assert table.rows[2][1] == "1.000 (at its bound)"
    # a deviation that would reach below a bound, or stop far from an open end, is not what the interval says
    assert not any("±" in row[1] or "+/-" in row[1] for row in table.rows)
    assert table.rows[0][3] == "s"
    assert Estimate(name="a", unit="-", value=1.0, std=1.0).ends_95 == pytest.approx((-0.959964, 2.959964))


def test_truth_within_and_not(fingerprint):
    a = Estimate(name="K_p", unit="-", value=5.0, std=0.5)
    b = Estimate(name="K_i", unit="1/s", value=5.0, std=0.5)
    c = Estimate(name="g", unit="-", value=0.0, std=0.1)
    rows = parameter_table(with_parameters(fingerprint, a, b, c), {"K_p": 5.9, "K_i": 6.1}).rows
    assert [row[3:5] for row in rows] == [("5.90", "yes"), ("6.10", "no"), ("–", "–")]
    assert rows[1][5] == "s⁻¹"


def test_truth_of_combinations_follows_from_the_parameters(identification):
    truth = {"t_d": 0.07, "t_sp": 0.05, "K_p": 5.7, "K_i": 4.27, "k_q": 2.0, "g": 0.0}
    found = truth_of_combinations(identification, truth)
    assert found["t_d + t_sp"] == pytest.approx(0.12)
    assert found["v K_i / (k_q - g)"] == pytest.approx(2.135)
    assert "v K_p / (tau_up + tau_dn)" not in found


def test_combinations_of_a_fingerprint(fingerprint):
    names = [str(row[0]) for row in combination_table(fingerprint, {}).rows]
    assert names[0] == "t_d + t_sp"


def explained(fingerprint, identification):
    return fit_section(
        SimpleNamespace(fingerprint=fingerprint, identification=identification, validations=())
    ).paragraphs[0]


def test_fit_table_without_a_likelihood(fingerprint, identification):
    quality = fingerprint.quality.model_copy(update={"chi_square": None})
    unweighted = fingerprint.model_copy(update={"quality": quality})
    assert fit_table(unweighted).note.startswith("10 of 10 starts") or "of 10 starts" in fit_table(unweighted).note
    assert "not weighted by the noise" in explained(unweighted, identification)
    bad = fingerprint.model_copy(update={"quality": fingerprint.quality.model_copy(update={"p_value": 0.009})})
    assert "does not explain" in explained(bad, identification)


def test_expected_values():
    assert expected_text(Estimate(name="I", unit="kg m2", value=1.0, std=0.1)) == "–"
    assert expected_text(Estimate(name="K_Q", unit="-", value=0.0491, std=0.0012, expected=0.04943)) == "0.0494"


def test_tables_of_the_signals(signals, spectra):
    steps = step_table(signals)
    assert [row[3] for row in steps.rows] == ["0.410", "0.380", "0.430", "0.420"]
    assert "Mean of St1: 0.410 ± 0.011 s." in steps.note
    hidden = step_table(replace(signals, step_delays=[replace(one, speed_time_s=None) for one in signals.step_delays]))
    assert [row[3] for row in hidden.rows] == ["hidden by noise"] * 4
    assert "Mean of" not in hidden.note
    strips = strip_table(signals)
    assert strips.rows[1][2:] == ("87.240 ± 0.030", "−3.07 %")
    assert strips.note == "The uneven angles are removed from the speed."
    even = replace(signals.strips[0], angle_rev=np.array([0.2501, 0.2499, 0.25, 0.25]), std_rev=np.full(4, 1e-4))
    assert strip_table(replace(signals, strips=[even])).note == f"The strips of {even.channel} are even within 0.04 %."
    levels = calibration_table(signals)
    assert [row[2] for row in levels.rows] == ["1.20", "−1.80", "0.60"]
    assert "slope −250.97 ± 0.60 rpm/V" in levels.note
    repairs = repair_table(signals)
    assert ("M_s", "outlier", "2", "5", "100.00", "600.00") in repairs.rows
    windows = window_table(spectra)
    assert windows.rows[14][5:] == ("no", "above 9.87 Hz, half the pulse rate of n_e: aliased")
    assert windows.rows[0][1] == "3"


def test_symbols_in_html():
    assert symbol_html("v K_p / (tau_up + tau_dn)") == (
        "<i>v</i> <i>K</i><sub>p</sub> / (<i>τ</i><sub>up</sub> + <i>τ</i><sub>dn</sub>)"
    )
    assert symbol_html("gain <margin>") == "gain &lt;margin&gt;"
    assert sentence_html("a line: t_d & zeta of my_file") == ("a line: <i>t</i><sub>d</sub> &amp; <i>ζ</i> of my_file")


def test_rows_must_fit_the_header():
    with pytest.raises(ValueError, match="expected 2 cells in a row, found 1"):
        Table(title="x", columns=texts("a", "b"), rows=(("1",),))


def test_meaning_is_that_of_the_structure(fingerprint):
    meanings = {p.name: p.meaning for p in structure("GAUGE-CLOSED").parameters}
    table = parameter_table(fingerprint, {})
    assert table.rows[0][-1] == meanings["K_p"]
