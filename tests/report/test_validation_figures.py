"""Figures of a validation: every line that is promised, the data it is drawn from, and what is refused."""

import numpy as np
import pytest
from tests.report.marks import mark, marks, names

from shaftprint.report import validation_chart, validation_summary_chart
from shaftprint.report.charts._marks import Band
from shaftprint.report.charts._text import as_plain
from shaftprint.validation import ValidationSettings, validate
from shaftprint.validation._thesis_models import thesis_models


@pytest.fixture(scope="module")
def validations(identification, signals, campaign):
    models = (identification, *thesis_models()[:2])
    settings = ValidationSettings(rest_s=6.0, zoom_after_s=8.0)
    return [
        validate(model, signals, campaign, rng=np.random.default_rng(1), records=("C11", "St1"), settings=settings)
        for model in models
    ]


def test_models_over_the_data_of_a_chirp_band(validations):
    speed, torque = validation_chart(validations, "C11", "1 to 5").panels
    for panel in (speed, torque):
        assert names(panel) == ["measured", "95 % band of GAUGE-CLOSED", "GAUGE-CLOSED", "CL4", "OL1+OL5"]
    assert as_plain(speed.title) == "engine speed n, C11, 1 to 5 rad/s"
    excerpt = validations[0].of("C11", "1 to 5").excerpt
    assert speed.x.span == pytest.approx((excerpt.start_s, excerpt.stop_s))


def test_a_model_line_is_the_model(validations):
    line = mark(validation_chart(validations[1:2], "C11", "5 to 10").panels[1], "CL4")
    traces = validations[1].of("C11", "5 to 10").traces
    # not every sample is drawn, but each that is stands where it belongs
    assert line.y.size > 100
    assert line.y == pytest.approx(np.interp(line.x, traces.time_s, traces.model[1]))


def test_the_band_is_two_deviations_wide(validations):
    band = mark(validation_chart(validations[:1], "St1", "step at 230").panels[0], "95 % band of", Band)
    traces = validations[0].of("St1", "step at 230").traces
    at = np.searchsorted(traces.time_s, band.x)
    np.testing.assert_allclose(band.upper - band.lower, 2.0 * 1.959964 * traces.model_std[0, at], rtol=1e-5)
    np.testing.assert_allclose(0.5 * (band.upper + band.lower), traces.model[0, at], atol=1e-12)


def test_the_band_with_noise_is_as_wide_as_model_and_noise_together(validations):
    """The made torque has white noise of 5 % at 50 Hz: below 4 Hz the root of 4 in 25 of it, 2 %."""
    traces = validations[0].of("St1", "whole").traces
    band = mark(validation_chart(validations[:1], "St1", "whole").panels[1], "95 % band with noise", Band)
    model = np.interp(band.x, traces.time_s, traces.model_std[1])
    noise = np.sqrt((0.5 * (band.upper - band.lower) / 1.959964) ** 2 - model**2)
    np.testing.assert_allclose(noise, 0.02, rtol=0.3)
    assert not marks(validation_chart(validations, "St1", "whole").panels[1], "95 % band with noise")


def test_the_set_point_stands_beside_the_speed_only(validations):
    chart = validation_chart(validations, "St1", "step at 230", set_point=True, around_step_s=(0.5, 4.0))
    speed, torque = chart.panels
    assert "set point n_set" in names(speed)
    assert "set point n_set" not in names(torque)
    assert speed.x.span == pytest.approx((229.5, 234.0))
    assert "−4 to −5 V" in as_plain(speed.title)


def test_with_a_working_point_speed_is_in_rpm_and_torque_in_newton_metres(validations, signals):
    point = signals.working_point
    speed, torque = validation_chart(validations[:1], "St1", "step at 230", working_point=point).panels
    assert (speed.y.title, torque.y.title) == ("[rpm]", "[N·m]")
    deviation = validation_chart(validations[:1], "St1", "step at 230").panels
    for panel, plain, level in zip(
        (speed, torque), deviation, (60.0 * point.engine_speed_rev_s, point.shaft_torque_nm), strict=True
    ):
        for name in ("measured", "GAUGE-CLOSED"):
            np.testing.assert_allclose(mark(panel, name).y / level, 1.0 + mark(plain, name).y, rtol=1e-9)
        band, of_plain = mark(panel, "95 % band of", Band), mark(plain, "95 % band of", Band)
        np.testing.assert_allclose(band.upper - band.lower, level * (of_plain.upper - of_plain.lower), rtol=1e-6)


def test_bands_one_after_the_other(validations):
    chart = validation_chart(validations, "C11", "5 to 10", "above 10")
    assert chart.panels[0].x.span == pytest.approx(
        (validations[0].of("C11", "5 to 10").excerpt.start_s, validations[0].of("C11", "above 10").excerpt.stop_s)
    )


def test_the_summary_has_a_row_for_every_excerpt(validations):
    validation = validations[0]
    (panel,) = validation_summary_chart(validation).panels
    assert len(panel.y.names) == len(validation.comparisons)
    assert panel.y.names[0] == "C11, up to 1 rad/s"
    shown = mark(panel, "engine speed")
    assert shown.x == pytest.approx([100.0 * c.misfits[0].error for c in validation.comparisons])


@pytest.mark.parametrize(
    ("record", "titles", "words"),
    [
        ("C11", (), "at least one validation and one title"),
        ("C9", ("whole",), "expected an excerpt C9, whole, found none"),
    ],
)
def test_what_is_not_there_is_refused(validations, record, titles, words):
    with pytest.raises(ValueError, match=words):
        validation_chart(validations, record, *titles)


def test_a_model_without_uncertainty_has_no_band(validations):
    panel = validation_chart(validations[1:], "C11", "1 to 5").panels[0]
    assert names(panel) == ["measured", "CL4", "OL1+OL5"]
