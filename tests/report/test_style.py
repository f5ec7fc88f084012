import matplotlib as mpl
import pytest

from shaftprint.catalogue import structure
from shaftprint.report import Curve, plot_bode, save_figure
from shaftprint.report.figures import LOOKS, house_style, legend_below, new_figure
from shaftprint.report.notation import mathtext, with_unit


def test_matplotlib_is_left_as_it_was():
    before = dict(mpl.rcParams)
    plot_bode([Curve.at(structure("OL1"), {})])
    assert dict(mpl.rcParams) == before


def test_no_letter_is_smaller_than_eight_points_at_sixteen_centimetres():
    figure = plot_bode([Curve.at(structure("OL1"), {})])
    figure.draw_without_rendering()
    assert figure.get_size_inches()[0] * 2.54 == pytest.approx(16.0)
    axes = figure.axes[0]
    texts = [axes.yaxis.label, *axes.get_yticklabels(), *figure.legends[0].get_texts()]
    assert min(text.get_fontsize() for text in texts) >= 8.0


def test_lines_differ_without_colour():
    assert len({str(look.dashes) for look in LOOKS}) == len(LOOKS)
    assert len({look.marker for look in LOOKS}) == len(LOOKS)


@pytest.mark.parametrize("suffix", [".svg", ".png", ".pdf"])
def test_the_same_figure_gives_the_same_file(tmp_path, suffix):
    for name in ("one", "two"):
        save_figure(plot_bode([Curve.at(structure("OL1"), {})]), tmp_path / f"{name}{suffix}")
    assert (tmp_path / f"one{suffix}").read_bytes() == (tmp_path / f"two{suffix}").read_bytes()


def test_a_legend_takes_no_more_columns_than_fit():
    with house_style():
        figure = new_figure(6.0)
        axes = figure.subplots()
        lines = {f"a rather long label of line {i}": axes.plot([0, 1], [0, i])[0] for i in range(8)}
        legend_below(figure, lines)
    figure.draw_without_rendering()
    extent = figure.legends[0].get_window_extent()
    assert len(figure.legends) == 1
    assert extent.x0 >= 0.0
    assert extent.x1 <= figure.bbox.width
    assert extent.y1 <= axes.get_tightbbox().y0 + 1.0


def test_no_legend_without_entries():
    with house_style():
        figure = new_figure(5.0)
        legend_below(figure, {})
    assert not figure.legends


def test_two_and_five_are_labelled_within_a_decade():
    figure = plot_bode([Curve.at(structure("OL1"), {})], zoom_rad_s=(1.0, 10.0))
    figure.draw_without_rendering()
    minor = [label.get_text() for label in figure.axes[3].get_xticklabels(minor=True)]
    assert {"2", "5"} <= set(minor)
    assert not any(label.get_text() for label in figure.axes[2].get_xticklabels(minor=True))


def test_names_become_symbols():
    assert mathtext("tau_dn") == r"$\tau_{\mathrm{dn}}$"
    assert mathtext("v K_i / (k_q - g)") == r"$v$ $K_{\mathrm{i}}$ / ($k_{\mathrm{q}}$ - $g$)"
    assert mathtext("gain margin") == "gain margin"
    assert mathtext("zeta") == r"$\zeta$"
    assert with_unit("inertia", "kg m2") == "inertia [kg m²]"
    assert with_unit("ratio", "-") == "ratio [-]"
