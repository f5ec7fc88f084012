"""Set point and torque before and after the repair of outliers (thesis figure 3.2)."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.report.charts._chart import Chart, Panel, Scale
from shaftprint.report.charts._marks import Line, Mark, Points
from shaftprint.report.figures._envelope import channel_envelope, extremes
from shaftprint.units import SECONDS_PER_MINUTE

if TYPE_CHECKING:
    from shaftprint.recording._recording import Recording
    from shaftprint.signals._signals import Signals
    from shaftprint.vessel._vessel import Vessel

# Kinds of repair of a voltage or torque channel; pulses are repaired elsewhere.
KINDS = ("outlier", "dropout", "saturated")
# Where the marks of repaired places stand above all that is drawn, as a share of its range.
MARKS_AT = 0.05


def outlier_chart(recording: "Recording", signals: "Signals", vessel: "Vessel") -> Chart:
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
    set_point, torque = (recording.channel(sensor.channel) for sensor in (sensors.set_point, sensors.shaft_torque))
    set_point_s, volts = channel_envelope(set_point)
    torque_s, reading = channel_envelope(torque)
    rates = (f"raw, {set_point.rate_hz:g} Hz", f"prepared, {signals.rate_hz:g} Hz")
    demanded = SECONDS_PER_MINUTE * _demanded(signals, volts)
    torque_nm = vessel.driving_torque_nm(reading)
    return Chart(
        panels=(
            Panel(
                title="engine-speed set point",
                marks=_marks(
                    signals, set_point.name, (set_point_s, demanded), signals.set_point_rev_s, rates, SECONDS_PER_MINUTE
                ),
                x=Scale(title="time in the recording [s]"),
                y=Scale(title="set point [rpm]"),
            ),
            Panel(
                title="shaft torque at the gauge",
                marks=_marks(signals, torque.name, (torque_s, torque_nm), signals.shaft_torque_nm, rates),
                x=Scale(title="time in the recording [s]"),
                y=Scale(title="shaft torque [N·m]"),
            ),
        ),
        heights_px=(220,),
    )


def _demanded(signals: "Signals", volts: FloatArray) -> FloatArray:
    """Return the set point [rev/s] that a raw voltage stands for, DC scale included."""
    line = signals.calibration.slope_rev_s_per_v * volts + signals.calibration.intercept_rev_s
    middle = signals.working_point.engine_speed_rev_s
    return middle + signals.dc_scale * (line - middle)


def _repaired_s(signals: "Signals", channel: str) -> FloatArray:
    return np.array([r.time_s for r in signals.repairs if r.channel == channel and r.kind in KINDS])


def _marks(
    signals: "Signals",
    channel: str,
    before: tuple[FloatArray, FloatArray],
    after: FloatArray,
    rates: tuple[str, str],
    unit: float = 1.0,
) -> list[Mark]:
    """Return a channel before its repair, and after it in the unit of the former."""
    drawn = extremes(after)
    time, values = signals.start_s + drawn / signals.rate_hz, unit * after[drawn]
    marks: list[Mark] = [
        Line(x=before[0], y=before[1], name=rates[0], shade="early", width=1.2),
        Line(x=time, y=values, name=rates[1], width=1.2),
    ]
    repaired = _repaired_s(signals, channel)
    if repaired.size:
        high, low = float(np.nanmax(before[1])), float(np.nanmin(before[1]))
        at = np.full(repaired.size, high + MARKS_AT * (high - low))
        marks.append(Points(x=repaired, y=at, name="repaired place", marker="triangle-down", filled=False))
    return marks
