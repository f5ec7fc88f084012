"""Figures and table of the uncertainty: what they show is what the budget and the profiles say."""

import numpy as np
import pytest

from shaftprint.identify import profile_intervals
from shaftprint.identify.uncertainty import Budget, BudgetRow, budget, step_band
from shaftprint.report.figures import plot_budget, plot_profiles, plot_step_band
from shaftprint.tables import Column, Symbol, budget_table

STATED = Budget(
    sources=("noise of n", "noise of M_s", "TVC", "air"),
    rows=(
        BudgetRow(name="K_p", unit="-", value=5.0, variances={"noise of n": 0.5, "noise of M_s": 0.25, "TVC": 0.25}),
        BudgetRow(name="tau_dn", unit="s", value=0.32, variances={"noise of n": 1.5e-4, "noise of M_s": -0.5e-4}),
        BudgetRow(name="v", unit="-", value=1.0, variances={}),
    ),
)


def bars(figure):
    """Return left end and width of every bar by source, shape (numbers, 2)."""
    return {
        container.get_label(): np.array([(bar.get_x(), bar.get_width()) for bar in container])
        for container in figure.axes[0].containers
    }


def test_bars_are_the_shares_one_after_the_other():
    found = bars(plot_budget(STATED))
    np.testing.assert_allclose(found["noise of $n$"], [(0.0, 50.0), (0.0, 150.0)])
    np.testing.assert_allclose(found["noise of $M_{\\mathrm{s}}$"], [(50.0, 25.0), (0.0, -50.0)])
    np.testing.assert_allclose(found["TVC"], [(75.0, 25.0), (150.0, 0.0)])
    # a source that counts nowhere is not in the picture, nor is a number that is not known
    assert len(found) == 3
    assert plot_budget(STATED).axes[0].get_xlim() == pytest.approx((-50.0, 150.0))


def test_some_numbers_only_and_none():
    assert len(bars(plot_budget(STATED, ["K_p"]))["TVC"]) == 1
    with pytest.raises(ValueError, match="budget: expected a number whose uncertainty is known, found none"):
        plot_budget(STATED, ["v"])


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


def test_more_sources_than_colours_are_hatched():
    sources = tuple(f"source {number}" for number in range(8))
    row = BudgetRow(name="K_p", unit="-", value=1.0, variances=dict.fromkeys(sources, 1.0))
    hatches = [c[0].get_hatch() for c in plot_budget(Budget(sources=sources, rows=(row,))).axes[0].containers]
    assert hatches[:6] == [""] * 6
    assert all(hatches[6:])


def test_budget_of_a_fit_is_drawn_whole(identification):
    stated = budget(identification)
    found = bars(plot_budget(stated))
    np.testing.assert_allclose(sum(widths[:, 1] for widths in found.values()), 100.0 * np.ones(len(stated.rows)))


@pytest.mark.slow
def test_profiles_pass_the_limit_at_the_ends_of_the_intervals(identification):
    names = ["K_p", "zeta", "k_q"]
    figure = plot_profiles(identification, names)
    intervals = profile_intervals(identification)
    visible = [axes for axes in figure.axes if axes.get_visible()]
    assert len(visible) == 3
    for axes, name in zip(visible, names, strict=True):
        curve = next(line for line in axes.get_lines() if line.get_label() == "profile of the likelihood")
        values, rise = curve.get_data()
        interval = intervals[name]
        for end, is_open in ((interval.lower, interval.lower_open), (interval.upper, interval.upper_open)):
            if not is_open:
                assert np.interp(end, values, rise) == pytest.approx(1.9207, rel=0.05)
        assert axes.get_xlabel().endswith("[-]")


def test_every_free_parameter_has_a_panel(fits):
    figure = plot_profiles(fits["OL5"])
    assert [axes.get_visible() for axes in figure.axes] == [True] * 5 + [False] * 3


def test_a_profile_without_deviation_has_no_parabola(fits):
    """Of the benchmark's ``v`` only the product with the gains is known."""
    axes = plot_profiles(fits["BENCHMARK"], ["v"]).axes[0]
    assert [line.get_label() for line in axes.get_lines()][:2] == ["95 % interval below", "profile of the likelihood"]


def test_step_is_drawn_with_its_band_and_the_coverage_is_told(identification):
    figure = plot_step_band(identification, duration_s=3.0)
    band = step_band(identification, np.linspace(0.0, 3.0, 301))
    assert len(figure.axes) == 2
    for place, axes in enumerate(figure.axes):
        line = axes.get_lines()[0]
        np.testing.assert_allclose(line.get_ydata(), band.value[place])
        vertices = axes.collections[0].get_paths()[0].vertices
        assert vertices[:, 1].max() == pytest.approx(band.upper[place].max())
        assert vertices[:, 1].min() == pytest.approx(min(band.lower[place].min(), 0.0), abs=1e-9)
    assert "95 % band, at each time" in [text.get_text() for text in figure.legends[0].get_texts()]
    assert figure.axes[1].get_ylabel().endswith("after a step of 1 of $n_{\\mathrm{set}}$")
