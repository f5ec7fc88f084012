"""Set point and torque before and after the repair of outliers (thesis figure 3.2)."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.report.figures._envelope import channel_envelope, envelope
from shaftprint.report.figures._style import house_style, legend_below, legend_entries, letter_panels, look, new_figure
from shaftprint.units import SECONDS_PER_MINUTE

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from shaftprint.recording import Recording
    from shaftprint.signals import Signals
    from shaftprint.vessel import Vessel

BEFORE = "#e08a4a"
# Kinds of repair of a voltage or torque channel; pulses are repaired elsewhere.
KINDS = ("outlier", "dropout", "saturated")


def plot_outliers(recording: "Recording", signals: "Signals", vessel: "Vessel") -> "Figure":
    """Return set point and shaft torque before and after repair: what figure 3.2 of the thesis shows.

    Both are drawn with the smallest and largest sample of each stretch; a triangle marks every repaired place.

    Parameters
    ----------
    recording
        Raw recording, open.
    signals
        The same recording, prepared.
    vessel
        Names the channels and the scale of the torque gauge.
    """
    sensors = vessel.sensors
    time = signals.start_s + np.arange(signals.samples) / signals.rate_hz
    with house_style():
        figure = new_figure(10.5)
        panels = figure.subplots(2, 1, sharex=True)
        raw = recording.channel(sensors.set_point.channel)
        rates = (f"raw, {raw.rate_hz:g} Hz", f"prepared, {signals.rate_hz:g} Hz")
        before_s, volts = channel_envelope(raw)
        _draw(
            panels[0],
            (before_s, SECONDS_PER_MINUTE * _demanded(signals, volts)),
            envelope(time, SECONDS_PER_MINUTE * signals.set_point_rev_s),
            _repaired_s(signals, sensors.set_point.channel),
            rates,
        )
        before_s, reading = channel_envelope(recording.channel(sensors.shaft_torque.channel))
        _draw(
            panels[1],
            (before_s, sensors.shaft_torque.torque_nm(reading)),
            envelope(time, signals.shaft_torque_nm),
            _repaired_s(signals, sensors.shaft_torque.channel),
            rates,
        )
        panels[0].set_ylabel("set point [rpm]")
        panels[1].set_ylabel("shaft torque [N·m]")
        panels[1].set_xlabel("time in the recording [s]")
        panels[1].set_xlim(time[0], time[-1])
        letter_panels(panels, ("engine-speed set point", "shaft torque at the gauge"))
        legend_below(figure, legend_entries(panels))
        return figure


def _demanded(signals: "Signals", volts: FloatArray) -> FloatArray:
    """Return the set point [rev/s] that a raw voltage stands for, DC scale included."""
    line = signals.calibration.slope_rev_s_per_v * volts + signals.calibration.intercept_rev_s
    middle = signals.working_point.engine_speed_rev_s
    return middle + signals.dc_scale * (line - middle)


def _repaired_s(signals: "Signals", channel: str) -> FloatArray:
    return np.array([r.time_s for r in signals.repairs if r.channel == channel and r.kind in KINDS])


def _draw(
    axes: "Axes",
    before: tuple[FloatArray, FloatArray],
    after: tuple[FloatArray, FloatArray],
    repaired_s: FloatArray,
    rates: tuple[str, str],
) -> None:
    axes.plot(*before, color=BEFORE, linewidth=0.7, label=rates[0])
    axes.plot(*after, color=look(0).colour, linewidth=0.7, label=rates[1])
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + 0.08 * (high - low))
    axes.plot(
        repaired_s,
        np.full(repaired_s.size, high + 0.03 * (high - low)),
        linestyle="none",
        marker="v",
        markersize=4.0,
        markerfacecolor="white",
        color="black",
        label="repaired place",
    )
