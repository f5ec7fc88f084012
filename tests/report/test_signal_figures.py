from dataclasses import replace

import numpy as np
import pytest
from tests.report.marks import legend, mark, marks, names

from shaftprint.report import (
    calibration_chart,
    campaign_chart,
    chirp_chart,
    delay_chart,
    excitation_chart,
    outlier_chart,
    signal_to_noise_chart,
    staircase_chart,
    strip_chart,
)
from shaftprint.report.charts._marks import Band, Bars, Line, Points, Straight, Words
from shaftprint.report.charts._text import as_plain
from shaftprint.report.figures._campaign import spread


def test_every_test_of_the_campaign_is_named_above_its_time(recording, vessel, campaign):
    chart = campaign_chart(recording, vessel, campaign)
    found = [mark for panel in chart.panels for mark in panel.marks if isinstance(mark, Words)]
    assert [words.text for words in found] == ["S1", "S2", "S3", "St1", "C11", "C21", "C22"]
    at = {words.text: words.x for words in found}
    assert at["St1"] == pytest.approx(260.0)
    assert at["C22"] == pytest.approx(630.0)
    assert chart.panels[-1].x.title == "time in the recording [s]"
    assert chart.panels[0].y.title == "set point [V]"


def test_a_spike_beyond_the_picture_is_marked(recording, vessel, campaign):
    """The raw set point has one sample of 3 V at 300 s; the campaign stays between -6 and -4 V."""
    chart = campaign_chart(recording, vessel, campaign)
    (marked,) = [mark for panel in chart.panels for mark in marks(panel, "spike that leaves the picture")]
    np.testing.assert_allclose(marked.x, [300.0])
    assert marked.marker == "triangle-up"


def test_names_keep_their_distance_and_order():
    places = spread([10.0, 11.0, 12.0, 50.0], 5.0, (0.0, 60.0))
    np.testing.assert_allclose(places, [6.0, 11.0, 16.0, 50.0])
    at_the_edge = spread([0.0, 1.0], 5.0, (0.0, 60.0))
    assert at_the_edge[0] >= 2.5
    assert np.diff(at_the_edge)[0] == pytest.approx(5.0)


def test_calibration_shows_levels_and_residuals_in_rpm(signals):
    chart = calibration_chart(signals.calibration)
    left, right = chart.panels
    line = mark(left, "n = ")
    np.testing.assert_allclose(line.y, -250.97 * line.x - 83.467)
    np.testing.assert_allclose(mark(right, "steady levels").y, [1.2, -1.8, 0.6], atol=1e-9)
    assert left.y.title == "engine speed n [rpm]"
    assert left.x.title == "set-point voltage U [V]"
    assert "n = −250.97 rpm/V · U − 83.5 rpm" in legend(chart)


def test_calibration_band_is_that_of_slope_and_intercept(signals):
    band = mark(calibration_chart(signals.calibration).panels[1], "95 % band", Band)
    volts = -6.3
    variance = volts**2 * 1e-4 + 2.0 * volts * 5e-4 + 2.6e-3
    assert band.x[0] == pytest.approx(volts)
    assert band.upper[0] == pytest.approx(1.959964 * 60.0 * np.sqrt(variance), rel=1e-6)


def test_outliers_before_and_after(recording, signals, vessel):
    chart = outlier_chart(recording, signals, vessel)
    set_point, torque = chart.panels
    before, after, marked = torque.marks
    assert before.y.max() == pytest.approx(9.5 * 500.0)
    assert after.y.max() < 4000.0
    np.testing.assert_allclose(marked.x, [100.0, 600.0])
    assert legend(chart) == ["raw, 50 Hz", "prepared, 50 Hz", "repaired place"]
    spike = 60.0 * 19.53 + 1.004 * (-250.97 * 3.0 - 83.467 - 60.0 * 19.53)
    assert set_point.marks[0].y.min() == pytest.approx(spike)
    assert (set_point.y.title, torque.y.title) == ("set point [rpm]", "shaft torque [N·m]")


def test_steps_with_delays(signals):
    chart = delay_chart(signals)
    zoom, delays = chart.panels[1:]
    assert [words.text for words in zoom.marks if isinstance(words, Words)] == ["0.410 s"]
    found = sorted((x, y) for points in marks(delays, "speed", Points) for x, y in zip(points.x, points.y, strict=True))
    np.testing.assert_allclose([delay for _, delay in found], [0.41, 0.38, 0.43, 0.42])
    assert "mean 0.410 s" in legend(chart)
    assert [straight.at for straight in marks(zoom, "", Straight)] == pytest.approx([230.0, 230.41])


def test_steps_that_are_not_there_are_refused(signals):
    with pytest.raises(ValueError, match="expected steps of St9, found none"):
        delay_chart(signals, staircase="St9")


def test_chirps_of_one_name_are_joined(signals, campaign):
    top, bottom = chirp_chart(signals, campaign, name="C2").panels
    assert top.x.span[1] == pytest.approx(200.0, abs=0.1)
    (joint,) = marks(top, "", Straight)
    assert joint.at == pytest.approx(100.0)
    set_point = mark(bottom, "set point")
    assert np.abs(set_point.y).max() == pytest.approx(0.6 * 250.97 / 60.0 / 19.53, rel=4e-3)
    assert top.y.title == "deviation [-]"


def test_torque_is_drawn_under_the_set_point_and_speed_over_it(signals, campaign):
    top, bottom = staircase_chart(signals, campaign).panels
    assert names(top) == ["set point n_set", "response"]
    assert names(bottom) == ["response", "set point n_set"]
    assert len({line.shade for line in top.marks}) == 2


def test_a_test_is_drawn_as_it_was_measured(signals, campaign):
    line = mark(excitation_chart(signals, campaign.staircases).panels[0], "response")
    first = round((campaign.staircases[0].start_s - signals.start_s) * signals.rate_hz)
    speeds = signals.engine_speed.speed_rev_s[first:] / signals.working_point.engine_speed_rev_s - 1.0
    at = np.round(line.x * signals.rate_hz).astype(int)
    np.testing.assert_allclose(line.y, speeds[at], atol=1e-12)


def test_tests_outside_of_the_recording_are_refused(signals, campaign):
    late = campaign.chirps[0].model_copy(update={"start_s": 1000.0, "stop_s": 1100.0})
    with pytest.raises(ValueError, match="found none of C11"):
        excitation_chart(signals, [late])
    with pytest.raises(ValueError, match="found none of no test"):
        chirp_chart(signals, campaign, name="X")


def test_strip_angles_against_an_even_spacing(signals, vessel):
    (panel,) = strip_chart(signals.strips, vessel).panels
    (bars,) = marks(panel, "", Bars)
    np.testing.assert_allclose(bars.lengths, [0.40, -2.76, 0.74, 1.62], atol=1e-9)
    found = mark(panel, "found in this recording")
    np.testing.assert_allclose(found.bars, 1.959964 * 0.03 * np.ones((2, 4)), rtol=1e-5)
    assert panel.y.title == "angle minus 90° [deg]"
    assert not marks(strip_chart(signals.strips).panels[0], "vessel file")


def test_strips_counted_from_another_one_are_turned_to_those_of_the_vessel_file(signals, vessel):
    """A recording that begins two strips later must not look like a shaft with other strips."""
    strips = signals.strips[0]
    later = replace(strips, angle_rev=np.roll(strips.angle_rev, 2))
    first, second = (mark(strip_chart((one,), vessel).panels[0], "vessel file") for one in (strips, later))
    np.testing.assert_allclose(np.roll(first.y, 2), second.y)


def test_angles_of_a_single_strip_are_refused(signals):
    single = replace(signals.strips[0], angle_rev=np.ones(1), std_rev=np.zeros(1))
    with pytest.raises(ValueError, match="more than one pulse"):
        strip_chart((single,))


def test_a_pick_up_the_vessel_file_knows_no_angles_of(signals, vessel):
    other = replace(signals.strips[0], channel="PTM_1")
    assert strip_chart((other,), vessel).panels[0].title == "channel PTM_1"


def test_signal_to_noise_of_every_channel(spectra):
    chart = signal_to_noise_chart(spectra, aliasing_limit_hz=9.87)
    (panel,) = chart.panels
    lines = marks(panel, "", Line)
    for line, expected in zip(lines, spectra.signal_to_noise.local_db.T, strict=True):
        np.testing.assert_allclose(line.y, expected)
    assert [points.x.size for points in marks(panel, "", Points) if not points.filled] == [2] * 5
    assert as_plain(panel.y.title) == "local signal-to-noise ratio [dB]"
    assert "3 dB, the thesis' limit" in legend(chart)
    assert mark(panel, "aliasing").at == pytest.approx(62.015, abs=1e-2)
