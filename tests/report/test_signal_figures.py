from dataclasses import replace

import numpy as np
import pytest

from shaftprint.report import (
    plot_calibration,
    plot_campaign,
    plot_chirp,
    plot_excitation,
    plot_outliers,
    plot_signal_to_noise,
    plot_staircase,
    plot_step_delays,
    plot_strip_angles,
)
from shaftprint.report.figures import spread


def legend_of(figure):
    return [text.get_text() for text in figure.legends[0].get_texts()]


def test_every_test_of_the_campaign_is_named_above_its_time(recording, vessel, campaign):
    figure = plot_campaign(recording, vessel, campaign)
    names = [text for axes in figure.axes for text in axes.texts]
    assert [text.get_text() for text in names] == ["S1", "S2", "S3", "St1", "C11", "C21", "C22"]
    at = {text.get_text(): text.get_position()[0] for text in names}
    assert at["St1"] == pytest.approx(260.0)
    assert at["C22"] == pytest.approx(630.0)
    assert figure.axes[1].get_xlabel() == "time in the recording [s]"
    assert figure.axes[0].get_ylabel() == "set point [V]"


def test_a_spike_beyond_the_picture_is_marked(recording, vessel, campaign):
    """The raw set point has one sample of 3 V at 300 s; the campaign stays between -6 and -4 V."""
    first = plot_campaign(recording, vessel, campaign).axes[0]
    (marked,) = [line for line in first.get_lines() if line.get_label() == "spike that leaves the picture"]
    np.testing.assert_allclose(marked.get_xdata(), [300.0])
    assert marked.get_marker() == "^"


def test_names_keep_their_distance_and_order():
    places = spread([10.0, 11.0, 12.0, 50.0], 5.0, (0.0, 60.0))
    np.testing.assert_allclose(places, [6.0, 11.0, 16.0, 50.0])
    at_the_edge = spread([0.0, 1.0], 5.0, (0.0, 60.0))
    assert at_the_edge[0] >= 2.5
    assert np.diff(at_the_edge)[0] == pytest.approx(5.0)


def test_calibration_shows_levels_and_residuals_in_rpm(signals):
    figure = plot_calibration(signals.calibration)
    left, right = figure.axes
    line = left.get_lines()[0]
    np.testing.assert_allclose(line.get_ydata(), -250.97 * line.get_xdata() - 83.467)
    np.testing.assert_allclose(right.containers[0].lines[0].get_ydata(), [1.2, -1.8, 0.6], atol=1e-9)
    assert left.get_ylabel() == "engine speed n [rpm]"
    assert left.get_xlabel() == "set-point voltage U [V]"
    assert "n = −250.97 rpm/V · U − 83.5 rpm" in legend_of(figure)


def test_calibration_band_is_that_of_slope_and_intercept(signals):
    right = plot_calibration(signals.calibration).axes[1]
    vertices = right.collections[0].get_paths()[0].vertices
    upper = vertices[np.isclose(vertices[:, 0], vertices[:, 0].min()), 1].max()
    volts = -6.3
    variance = volts**2 * 1e-4 + 2.0 * volts * 5e-4 + 2.6e-3
    assert upper == pytest.approx(1.959964 * 60.0 * np.sqrt(variance), rel=1e-6)


def test_outliers_before_and_after(recording, signals, vessel):
    figure = plot_outliers(recording, signals, vessel)
    set_point, torque = figure.axes
    before, after, marked = torque.get_lines()
    assert before.get_ydata().max() == pytest.approx(9.5 * 500.0)
    assert after.get_ydata().max() < 4000.0
    np.testing.assert_allclose(marked.get_xdata(), [100.0, 600.0])
    assert legend_of(figure) == ["raw, 50 Hz", "prepared, 50 Hz", "repaired place"]
    raw = set_point.get_lines()[0].get_ydata()
    spike = 60.0 * 19.53 + 1.004 * (-250.97 * 3.0 - 83.467 - 60.0 * 19.53)
    assert raw.min() == pytest.approx(spike)
    assert (set_point.get_ylabel(), torque.get_ylabel()) == ("set point [rpm]", "shaft torque [N·m]")


def test_steps_with_delays(signals):
    figure = plot_step_delays(signals)
    zoom, delays = figure.axes[1:]
    assert [text.get_text() for text in zoom.texts if text.get_text()] == ["0.410 s"]
    points = np.concatenate([line.get_ydata() for line in delays.get_lines() if line.get_marker() in ("^", "v")])
    np.testing.assert_allclose(points, [0.41, 0.38, 0.43, 0.42])
    assert "mean 0.410 s" in legend_of(figure)
    crossings = [line.get_xdata()[0] for line in zoom.get_lines()[2:]]
    assert crossings == pytest.approx([230.0, 230.41])


def test_steps_that_are_not_there_are_refused(signals):
    with pytest.raises(ValueError, match="expected steps of St9, found none"):
        plot_step_delays(signals, staircase="St9")


def test_chirps_of_one_name_are_joined(signals, campaign):
    figure = plot_chirp(signals, campaign, name="C2")
    top, bottom = figure.axes
    assert top.get_xlim()[1] == pytest.approx(200.0, abs=0.1)
    joint = top.get_lines()[-1]
    assert joint.get_xdata()[0] == pytest.approx(100.0)
    set_point = next(line for line in bottom.get_lines() if "set point" in str(line.get_label()))
    assert np.abs(set_point.get_ydata()).max() == pytest.approx(0.6 * 250.97 / 60.0 / 19.53, rel=4e-3)
    assert top.get_ylabel() == "deviation over\nworking point [-]"


def test_torque_is_drawn_under_the_set_point_and_speed_over_it(signals, campaign):
    top, bottom = plot_staircase(signals, campaign).axes
    assert [str(line.get_label())[:8] for line in top.get_lines()] == ["set poin", "response"]
    assert [str(line.get_label())[:8] for line in bottom.get_lines()] == ["response", "set poin"]


def test_tests_outside_of_the_recording_are_refused(signals, campaign):
    late = campaign.chirps[0].model_copy(update={"start_s": 1000.0, "stop_s": 1100.0})
    with pytest.raises(ValueError, match="found none of C11"):
        plot_excitation(signals, [late])
    with pytest.raises(ValueError, match="found none of no test"):
        plot_chirp(signals, campaign, name="X")


def test_strip_angles_against_an_even_spacing(signals, vessel):
    axes = plot_strip_angles(signals.strips, vessel).axes[0]
    heights = [patch.get_height() for patch in axes.patches]
    np.testing.assert_allclose(heights, [0.40, -2.76, 0.74, 1.62], atol=1e-9)
    segments = axes.containers[1].lines[2][0].get_segments()
    assert np.ptp(segments[0][:, 1]) == pytest.approx(2.0 * 1.959964 * 0.03, rel=1e-5)
    assert axes.get_ylabel() == "angle minus 90° [deg]"
    assert len(plot_strip_angles(signals.strips).axes[0].get_lines()) < len(axes.get_lines())


def test_strips_counted_from_another_one_are_turned_to_those_of_the_vessel_file(signals, vessel):
    """A recording that begins two strips later must not look like a shaft with other strips."""
    strips = signals.strips[0]
    later = replace(strips, angle_rev=np.roll(strips.angle_rev, 2))
    first, second = (plot_strip_angles((one,), vessel).axes[0].get_lines() for one in (strips, later))
    earlier = [next(line for line in lines if line.get_label() == "vessel file") for lines in (first, second)]
    np.testing.assert_allclose(np.roll(earlier[0].get_ydata(), 2), earlier[1].get_ydata())


def test_angles_of_a_single_strip_are_refused(signals):
    single = replace(signals.strips[0], angle_rev=np.ones(1), std_rev=np.zeros(1))
    with pytest.raises(ValueError, match="more than one pulse"):
        plot_strip_angles((single,))


def test_a_pick_up_the_vessel_file_knows_no_angles_of(signals, vessel):
    other = replace(signals.strips[0], channel="PTM_1")
    assert plot_strip_angles((other,), vessel).axes[0].get_title(loc="left") == "channel PTM_1"


def test_signal_to_noise_of_every_channel(spectra):
    figure = plot_signal_to_noise(spectra, aliasing_limit_hz=9.87)
    axes = figure.axes[0]
    lines = [line for line in axes.get_lines() if line.get_linestyle() != "None" and line.get_xdata().__len__() == 16]
    for place, line in enumerate(lines):
        np.testing.assert_allclose(line.get_ydata(), spectra.signal_to_noise.local_db[:, place])
    hollow = [line for line in axes.get_lines() if line.get_markerfacecolor() == "white"]
    assert [line.get_xdata().size for line in hollow] == [2] * 5
    assert axes.get_ylabel() == "local signal-to-noise ratio [dB]"
    assert "3 dB, the thesis' limit" in legend_of(figure)
