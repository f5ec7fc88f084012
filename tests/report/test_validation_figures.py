"""Figures of a validation: every line that is promised, the data it is drawn from, and what is refused."""

import numpy as np
import pytest

from shaftprint.report import plot_validation, plot_validation_summary, save_figure
from shaftprint.validation import ValidationSettings, thesis_models, validate


@pytest.fixture(scope="module")
def validations(identification, signals, campaign):
    models = (identification, *thesis_models()[:2])
    settings = ValidationSettings(rest_s=6.0, zoom_after_s=8.0)
    return [
        validate(model, signals, campaign, rng=np.random.default_rng(1), records=("C11", "St1"), settings=settings)
        for model in models
    ]


def labels(axes):
    return axes.get_legend_handles_labels()[1]


def test_models_over_the_data_of_a_chirp_band(validations):
    figure = plot_validation(validations, "C11", "1 to 5")
    speed, torque = figure.axes
    for axes in (speed, torque):
        assert labels(axes) == ["measured", "95 % band of GAUGE-CLOSED", "GAUGE-CLOSED", "CL4", "OL1+OL5"]
    assert speed.get_title(loc="left") == "(a) engine speed, C11, 1 to 5 rad/s"
    excerpt = validations[0].of("C11", "1 to 5").excerpt
    assert speed.get_xlim() == pytest.approx((excerpt.start_s, excerpt.stop_s))


def test_a_model_line_is_the_model(validations):
    figure = plot_validation(validations[1:2], "C11", "5 to 10")
    traces = validations[1].of("C11", "5 to 10").traces
    line = next(line for line in figure.axes[1].lines if line.get_label() == "CL4")
    time_s, drawn = line.get_data()
    # not every sample is drawn, but each that is stands where it belongs
    assert drawn.size > 100
    assert drawn == pytest.approx(np.interp(time_s, traces.time_s, traces.model[1]))


def test_the_band_is_two_deviations_wide(validations):
    figure = plot_validation(validations[:1], "St1", "step at 230")
    traces = validations[0].of("St1", "step at 230").traces
    band = figure.axes[0].collections[0].get_paths()[0].vertices[:, 1]
    assert band.max() == pytest.approx((traces.model[0] + 1.96 * traces.model_std[0]).max(), rel=1e-4)


def test_the_set_point_stands_beside_the_speed_only(validations):
    figure = plot_validation(validations, "St1", "step at 230", set_point=True, around_step_s=(0.5, 4.0))
    speed, torque = figure.axes
    assert any("set point" in label for label in labels(speed))
    assert not any("set point" in label for label in labels(torque))
    assert speed.get_xlim() == pytest.approx((229.5, 234.0))
    assert "−4 to −5 V" in speed.get_title(loc="left")


def test_bands_one_after_the_other(validations):
    figure = plot_validation(validations, "C11", "5 to 10", "above 10")
    assert figure.axes[0].get_xlim() == pytest.approx(
        (validations[0].of("C11", "5 to 10").excerpt.start_s, validations[0].of("C11", "above 10").excerpt.stop_s)
    )


def test_the_summary_has_a_row_for_every_excerpt(validations, tmp_path):
    validation = validations[0]
    figure = plot_validation_summary(validation)
    axes = figure.axes[0]
    rows = [label.get_text() for label in axes.get_yticklabels()]
    assert len(rows) == len(validation.comparisons)
    assert rows[0] == "C11, up to 1 rad/s"
    shown = axes.containers[0].lines[0].get_xdata()
    assert shown == pytest.approx([100.0 * c.misfits[0].error for c in validation.comparisons])
    save_figure(figure, tmp_path / "summary.svg")
    assert (tmp_path / "summary.svg").stat().st_size > 10_000


@pytest.mark.parametrize(
    ("record", "titles", "words"),
    [
        ("C11", (), "at least one validation and one title"),
        ("C9", ("whole",), "expected an excerpt C9, whole, found none"),
    ],
)
def test_what_is_not_there_is_refused(validations, record, titles, words):
    with pytest.raises(ValueError, match=words):
        plot_validation(validations, record, *titles)


def test_a_model_without_uncertainty_has_no_band(validations):
    figure = plot_validation(validations[1:], "C11", "1 to 5")
    assert labels(figure.axes[0]) == ["measured", "CL4", "OL1+OL5"]
