"""Figures and table of the uncertainty: what they show is what the budget and the profiles say."""

from dataclasses import replace

import numpy as np
import pytest
from tests.report.marks import legend, mark, marks

from shaftprint.identify import Budget, BudgetRow, budget, profile_intervals
from shaftprint.identify.uncertainty._band import step_band
from shaftprint.report import budget_chart, profile_chart, step_chart
from shaftprint.report.charts._marks import Band, Bars, Line
from shaftprint.report.charts._text import as_plain
from shaftprint.tables import Column, Symbol
from shaftprint.tables._fingerprint import budget_table

STATED = Budget(
    sources=("noise of n", "noise of M_s", "TVC", "air"),
    rows=(
        BudgetRow(name="K_p", unit="-", value=5.0, variances={"noise of n": 0.5, "noise of M_s": 0.25, "TVC": 0.25}),
        BudgetRow(name="tau_dn", unit="s", value=0.32, variances={"noise of n": 1.5e-4, "noise of M_s": -0.5e-4}),
        BudgetRow(name="v", unit="-", value=1.0, variances={}),
    ),
)


def bars(chart):
    """Return start and length of every bar by source, shape (numbers, 2)."""
    drawn = marks(chart.panels[0], "", Bars)
    return {as_plain(bar.name): np.stack([bar.starts, bar.lengths], axis=-1) for bar in drawn}


def test_bars_are_the_shares_one_after_the_other():
    found = bars(budget_chart(STATED))
    np.testing.assert_allclose(found["noise of n"], [(0.0, 50.0), (0.0, 150.0)])
    np.testing.assert_allclose(found["noise of M_s"], [(50.0, 25.0), (0.0, -50.0)])
    np.testing.assert_allclose(found["TVC"], [(75.0, 25.0), (150.0, 0.0)])
    # a source that counts nowhere is not in the picture, nor is a number that is not known
    assert len(found) == 3
    assert budget_chart(STATED).panels[0].x.span == pytest.approx((-50.0, 150.0))


def test_some_numbers_only_and_none():
    assert len(bars(budget_chart(STATED, ["K_p"]))["TVC"]) == 1
    with pytest.raises(ValueError, match="budget: expected a number whose uncertainty is known, found none"):
        budget_chart(STATED, ["v"])


def test_table_has_shares_in_percent_and_leaves_out_what_is_not_known():
    table = budget_table(STATED)
    headings = [column.heading for column in table.columns]
    assert headings[:2] == ["quantity", "one std"]
    assert table.columns[3] == Column(Symbol("noise of M_s"), number=True)
    # a source that counts nowhere has no column
    assert headings[4:] == ["TVC"]
    assert [str(cell) for cell in table.rows[0][1:]] == ["1.0", "50 %", "25 %", "25 %"]
    assert [str(cell) for cell in table.rows[1][1:]] == ["0.010 s", "150 %", "−50 %", "–"]
    assert len(table.rows) == 2


def test_budget_of_a_fit_is_drawn_whole(identification):
    stated = budget(identification)
    found = bars(budget_chart(stated))
    np.testing.assert_allclose(sum(shares[:, 1] for shares in found.values()), 100.0 * np.ones(len(stated.rows)))


@pytest.mark.slow
def test_profiles_pass_the_limit_at_the_ends_of_the_intervals(identification):
    names = ["K_p", "zeta", "k_q"]
    chart = profile_chart(identification, names)
    intervals = profile_intervals(identification)
    for panel, name in zip(chart.panels, names, strict=True):
        curve = mark(panel, "profile of the likelihood")
        interval = intervals[name]
        for end, is_open in ((interval.lower, interval.lower_open), (interval.upper, interval.upper_open)):
            if not is_open:
                assert np.interp(end, curve.x, curve.y) == pytest.approx(1.9207, rel=0.05)
        assert as_plain(panel.x.title) == f"{name} [-]"


def test_every_free_parameter_has_a_panel(fits):
    assert len(profile_chart(fits["OL5"]).panels) == 5


def test_a_profile_without_deviation_has_no_parabola(fits):
    """Of the benchmark's ``v`` only the product with the gains is known."""
    assert legend(profile_chart(fits["BENCHMARK"], ["v"])) == ["95 % interval below", "profile of the likelihood"]


def test_step_is_drawn_with_its_band_and_the_coverage_is_told(identification):
    chart = step_chart(identification, duration_s=3.0)
    band = step_band(identification, np.linspace(0.0, 3.0, 301))
    assert len(chart.panels) == 2
    for place, panel in enumerate(chart.panels):
        drawn, line = mark(panel, "95 % band, at each time", Band), mark(panel, "GAUGE-CLOSED", Line)
        np.testing.assert_allclose(line.y, band.value[place])
        np.testing.assert_allclose(drawn.upper, band.upper[place, ::3])
        np.testing.assert_allclose(drawn.lower, band.lower[place, ::3])
    assert as_plain(chart.panels[1].y.title) == "M_s after a step of 1 [-]"


def test_the_smallest_measured_step_stands_beside_the_model_over_its_height(identification, signals):
    """All steps of the staircase are 1 V; the made speed follows 0.4 s later by exactly the step of the set point."""
    panel = step_chart(identification, signals=signals).panels[0]
    measured = mark(panel, "measured, smallest step")
    assert measured.x[0] == pytest.approx(0.0, abs=0.02)
    assert measured.y[measured.x > 1.0].mean() == pytest.approx(1.0, abs=0.02)
    assert measured.y[measured.x < 0.3].mean() == pytest.approx(0.0, abs=0.02)
    assert not marks(step_chart(identification, signals=replace(signals, step_delays=())).panels[0], "measured")


def test_the_step_that_is_shown_is_the_one_about_the_working_point(identification, signals):
    """The torque of a step from 1 to 1.4 rises by 2.4 for 1, that from 0.8 to 1.2 by 2, though it came later."""
    steps = [replace(signals.step_delays[0], set_point_time_s=at, speed_time_s=at + 0.4) for at in (230.0, 250.0)]
    time = signals.start_s + np.arange(signals.samples) / signals.rate_hz
    share = np.select([time < 230.0, time < 240.0, time < 250.0, time < 260.0], [1.0, 1.4, 0.8, 1.2], 1.0)
    moved = replace(signals, step_delays=tuple(steps))
    moved = moved.with_channel("n_set", values=share * signals.working_point.engine_speed_rev_s)
    moved = moved.with_channel("M_s", values=share**2 * signals.working_point.shaft_torque_nm)
    measured = mark(step_chart(identification, signals=moved).panels[1], "measured, smallest step")
    assert measured.y[-1] == pytest.approx(2.0, abs=0.01)


def test_a_measured_step_has_a_band_with_its_noise(identification, signals):
    """A torque that swings by 5 % at 2 Hz before a step of known height: 1.96 times the root of a half of that."""
    swing = np.sin(2.0 * np.pi * 2.0 * np.arange(signals.samples) / signals.rate_hz)
    noise = 0.05 * signals.working_point.shaft_torque_nm * swing
    noisy = signals.with_channel("M_s", values=signals.working_point.shaft_torque_nm + noise)
    step = min(noisy.step_delays, key=lambda one: one.set_point_time_s)
    at = round((step.set_point_time_s - noisy.start_s) * noisy.rate_hz)
    levels = noisy.set_point_rev_s[[at - 200, at + 200]] / noisy.working_point.engine_speed_rev_s
    panel = step_chart(identification, signals=noisy).panels[1]
    wide, model = mark(panel, "95 % band with noise", Band), mark(panel, "95 % band, at each time", Band)
    share = 1.959964 * 0.05 * np.sqrt(0.5) / abs(np.diff(levels)[0])
    expected = np.hypot(share, 0.5 * (model.upper - model.lower))
    np.testing.assert_allclose(0.5 * (wide.upper - wide.lower), expected, rtol=0.05)
    assert not marks(step_chart(identification).panels[1], "95 % band with noise")
