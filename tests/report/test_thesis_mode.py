from dataclasses import replace

import numpy as np
import pytest

from shaftprint.report.thesis._thesis_mode import calculated_inertia_time_s, thesis_findings, thesis_fit_table
from shaftprint.survey import ThesisMode


def test_inertia_time_of_eq_5_1(signals, spectra, vessel):
    """2 pi 54.006 (1183.8 / 3.82 / 60) / 1725 = 1.016 s."""
    point = replace(signals.working_point, engine_speed_rev_s=1183.8 / 60.0)
    thesis = ThesisMode(signals=replace(signals, working_point=point), spectra=spectra, identifications={})
    assert calculated_inertia_time_s(thesis, vessel) == pytest.approx(1.016, abs=5e-4)


def test_nothing_is_said_of_fits_that_are_not_there(signals, spectra, vessel):
    thesis = ThesisMode(signals=signals, spectra=spectra, identifications={})
    assert thesis_findings(thesis, vessel) == ()


def test_weights_of_the_lowest_lines_are_those_of_the_squared_response(signals, spectra, fits, open_responses, vessel):
    thesis = ThesisMode(signals=signals, spectra=spectra, identifications={name: fits[name] for name in ("OL2", "OL4")})
    (finding,) = thesis_findings(thesis, vessel)
    share = np.abs(open_responses[0].response[0, 0]) ** 2
    assert f"S1 alone carries {100.0 * share[0] / share.sum():.0f} %" in finding
    assert f"together {100.0 * share[:2].sum() / share.sum():.0f} %" in finding


def test_fits_in_one_table(signals, spectra, fits):
    thesis = ThesisMode(signals=signals, spectra=spectra, identifications=fits)
    rows = {row[0]: row for row in thesis_fit_table(thesis).rows}
    assert rows["OL1"][2:7] == ("–",) * 5
    assert float(rows["OL1"][1]) == pytest.approx(fits["OL1"].value("tau_n"), rel=1e-3)
    assert rows["OL1"][-1] == "–"
    assert float(rows["CL4"][-1]) == pytest.approx(fits["CL4"].margins.gain_margin, abs=0.006)
