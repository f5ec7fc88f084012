"""The verb of the room: from signals and campaign to responses, signal-to-noise ratios and harmonics."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arguments import refusing_none
from shaftprint.errors import ResponseError
from shaftprint.notebook._shown import Shown
from shaftprint.reasons import Reason
from shaftprint.spectra._aliases import alias_remarks
from shaftprint.spectra._frequency_response import FrequencyResponse
from shaftprint.spectra._line_responses import HIGHEST_SHARE_OF_RATE, channels_on_grid, response_of_lines
from shaftprint.spectra._shift_check import shift_reasons
from shaftprint.spectra._speed_ratios import SpeedRatio, speed_ratios
from shaftprint.spectra.lines._clock_check import clock_reasons
from shaftprint.spectra.lines._harmonics import Harmonics, collect_harmonics
from shaftprint.spectra.lines._input_band import band_of_lines, band_reasons
from shaftprint.spectra.lines._input_clock import drift_of_input, jump_of_input
from shaftprint.spectra.lines._line_fit import SineMethod, WindowSamples, cut_window, window_slice
from shaftprint.spectra.lines._line_measurement import LineMeasurement, measure_line
from shaftprint.spectra.lines._load_drift import LoadDrift, load_drift
from shaftprint.spectra.lines._message_line import cut_messages
from shaftprint.spectra.lines._set_point_check import (
    amplitude_remark,
    check_frequency_unit,
    check_set_point,
    shape_reasons,
)
from shaftprint.spectra.lines._signal_to_noise import SignalToNoise, signal_to_noise
from shaftprint.spectra.lines._sine_fit import WholePeriodSine
from shaftprint.spectra.lines._window_orders import left_in_remark, without_orders
from shaftprint.spectra.lines._windows import Window, plan_windows

if TYPE_CHECKING:
    from shaftprint.arrays import BoolArray, FloatArray
    from shaftprint.campaign._campaign import Campaign
    from shaftprint.signals._channel_signals import ExcitationSignal, SpeedSignal
    from shaftprint.signals._signals import Signals

_WHOLE_PERIOD_SINE = WholePeriodSine()

_SILENT_SHARE = 1e-3


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class Spectra(Shown):
    """All that the sines of a campaign tell about one shaft line."""

    response: FrequencyResponse
    """Response from what was moved, such as ``n_set``, to ``n`` and ``M_s``, and to the other channels that answer."""
    windows: tuple[Window, ...]
    """Window of each line (thesis table 3.5)."""
    signal_to_noise: SignalToNoise
    """Signal-to-noise ratios of every channel."""
    harmonics: Harmonics
    """Harmonics 2 and 3 of the outputs."""
    load_drift: LoadDrift
    """Propeller load of each window."""
    speed: str
    """Name of the speed sensor in the response."""
    remarks: Mapping[str, str] = field(default_factory=dict)
    """What was found, by name of the line: also lines that the recording does not hold."""
    speed_ratios: tuple[SpeedRatio, ...] = ()
    """What the other speed sensors show over that of the response."""


@refusing_none(ResponseError)
def estimate_response(
    signals: "Signals",
    campaign: "Campaign",
    *,
    method: SineMethod = _WHOLE_PERIOD_SINE,
    speed: str | None = None,
    excitation: str = "n_set",
) -> FrequencyResponse:
    """Estimate the response from set point to speed, torque and rack with full covariance.

    Parameters, result and errors are those of `estimate_spectra`, of which this is the response.
    """
    return estimate_spectra(signals, campaign, method=method, speed=speed, excitation=excitation).response


@refusing_none(ResponseError)
def estimate_spectra(
    signals: "Signals",
    campaign: "Campaign",
    *,
    method: SineMethod = _WHOLE_PERIOD_SINE,
    speed: str | None = None,
    excitation: str = "n_set",
) -> Spectra:
    """Measure every sine of a campaign in every channel.

    All values are divided by the working point of the whole recording: set point and speed by ``n_0``, torque by
    ``M_s0``, speed of the ship by ``v_0``, fuel rack by ``X_0``; the propeller load of each window relative to it
    goes with the response as ``load``. Orders of engine, shaft and propeller near a line are taken out of the torque by
    the angle of the shaft; a line that cannot be told from one has a remark and a large deviation. Lines above half the
    pulse rate of the speed sensor are aliased and not used by default; neither are lines whose set point is not a sine
    of the stated frequency. A line may be too fast for the messages of the control unit: its response to ``X`` is then
    unknown (see `measured`), that to speed and torque is not. In thesis mode all lines are used, each divided by its
    own mean instead of the working point, as the thesis did (section 3.3), orders stay in, and the remarks say what
    speaks against them.

    Parameters
    ----------
    signals
        The prepared recording.
    campaign
        What was asked of the ship; only its sines are used.
    method
        The way to measure a sine: `WholePeriodSine`, or for comparison `ExactBin` or `HighestPeak`.
    speed
        Name of the speed sensor to use, by default the first of the vessel.
    excitation
        Name of what was moved, the input of the response.

    Returns
    -------
    Response, signal-to-noise ratios, harmonics and load drift.

    Raises
    ------
    ResponseError
        If the speed sensor is unknown, a channel holds values that are not numbers or a torque or speed that does
        not move, no sine of the campaign is in the recording, or frequencies are in rad/s.
    """
    sensor = _speed_signal(signals, speed)
    moved = _excitation(signals, excitation)
    campaign = campaign.of_input(moved.input)
    names = channels_on_grid(signals, moved.name)
    windows, left_out = _windows_inside(signals, campaign, names)
    measurements = [_measure(signals, cut, moved, method) for cut in _cuts(signals, windows, names)]
    check_frequency_unit(measurements)
    measurements, silent = _without_silent(moved, campaign, measurements)
    ratios = signal_to_noise(
        [line.variances_with(*signals.messages) for line in measurements],
        lines=tuple(line.window.line for line in measurements),
        channels=(*names, *signals.messages),
    )
    remarks, usable = _judge(
        signals, campaign, measurements, sensor, moved, ratios.local_db[:, names.index(moved.name)]
    )
    drift = load_drift(measurements, speed=sensor.name)
    thesis = signals.mode == "thesis"
    load = np.ones(len(measurements)) if thesis else 1.0 + drift.delta
    response = replace(
        response_of_lines(signals, measurements, excitation=moved, sensor=sensor, load=load),
        used=np.ones_like(usable) if thesis else usable,
        remarks=remarks | silent | left_out,
        load=load,
    )
    against = () if thesis else _against(_cuts(signals, windows, names), measurements, sensor, moved, response)
    expected = np.array([_expected_amplitude(moved, campaign, line) for line in measurements])
    band = None if thesis else band_of_lines(measurements, expected, moved)
    of_band = band_reasons(band, channel=moved.channel, symbol=moved.name)
    # what lags behind the campaign file by itself is on no clock of its own
    is_timed = not (thesis or moved.is_reached)
    return Spectra(
        response=replace(
            response,
            reasons=(*signals.reasons, *against, *of_band),
            input_late_s=None if band is None or band.late_s else band.widest_s,
            input_drift=drift_of_input(measurements, campaign.sines, moved) if is_timed else None,
            input_jump_s=jump_of_input(measurements, campaign.sines, moved) if is_timed else np.empty(0),
        ),
        windows=tuple(line.window for line in measurements),
        signal_to_noise=ratios,
        harmonics=collect_harmonics(measurements, speed=sensor.name),
        load_drift=drift,
        speed=sensor.name,
        remarks=remarks | silent | left_out,
        speed_ratios=() if thesis else speed_ratios(measurements, sensor, signals.speeds.values()),
    )


def _against(
    cuts: Iterable[WindowSamples],
    lines: Sequence[LineMeasurement],
    sensor: "SpeedSignal",
    moved: "ExcitationSignal",
    response: FrequencyResponse,
) -> tuple[Reason, ...]:
    """Return what the sines say against clocks, set point and latencies."""
    channels = {f"the {moved.words}": moved.name, f"the speed {sensor.name}": sensor.name, "the shaft torque": "M_s"}
    shifted = shift_reasons(response) if moved.from_engine else ()
    return (*clock_reasons(cuts, lines, channels=channels), *shape_reasons(lines), *shifted)


def _excitation(signals: "Signals", name: str) -> "ExcitationSignal":
    if name not in signals.excitations:
        raise ResponseError(
            f"excitation {name}: expected one of {', '.join(signals.excitations)}, found no such channel in the "
            "signals; name its sensor in the vessel file."
        )
    return signals.excitations[name]


def _speed_signal(signals: "Signals", speed: str | None) -> "SpeedSignal":
    if speed is None:
        return signals.engine_speed
    if speed not in signals.speeds:
        raise ResponseError(
            f"Speed sensor {speed}: expected one of {', '.join(signals.speeds)}, found no such sensor in the signals."
        )
    return signals.speeds[speed]


def _cuts(signals: "Signals", windows: Sequence[Window], names: Sequence[str]) -> Iterator[WindowSamples]:
    """Cut one line after the other out of the normalised channels: all together would need much memory."""
    channels = {name: signals.channels[name].values for name in names}
    scale = np.array([[1.0 / signals.channels[name].reference] for name in names])
    for window in windows:
        cut = cut_window(window, channels, rate_hz=signals.rate_hz, start_s=signals.start_s)
        if cut is not None:
            np.multiply(cut.values, scale, out=cut.values)
            yield cut


def _windows_inside(
    signals: "Signals", campaign: "Campaign", names: Sequence[str]
) -> tuple[list[Window], dict[str, str]]:
    """Return the window of every line that the recording holds, and why others are left out."""
    count = min(signals.channels[name].values.size for name in names)
    windows, left_out = [], {}
    for window in plan_windows(campaign):
        if window.frequency_hz > HIGHEST_SHARE_OF_RATE * signals.rate_hz:
            left_out[window.line] = (
                f"left out: {window.frequency_hz:g} Hz is above "
                f"{HIGHEST_SHARE_OF_RATE * signals.rate_hz:g} Hz, what signals of "
                f"{signals.rate_hz:g} Hz show"
            )
            continue
        missing = signals.coverage.missing(window.start_s, window.stop_s)
        if missing:
            left_out[window.line] = f"left out: {missing}"
            continue
        if window_slice(window, count, rate_hz=signals.rate_hz, start_s=signals.start_s) is None:
            left_out[window.line] = (
                f"left out: its window from {window.start_s:g} to {window.stop_s:g} s is not inside the recording"
            )
            continue
        windows.append(window)
    if not windows:
        line, remark = next(iter(left_out.items()))
        raise ResponseError(
            f"{signals.recording_name}: expected at least one sine of campaign {campaign.name}, "
            f"found none ({line} {remark}): check that campaign and recording belong together."
        )
    return windows, left_out


def _measure(signals: "Signals", cut: WindowSamples, moved: "ExcitationSignal", method: SineMethod) -> LineMeasurement:
    window = cut.window
    finite = np.isfinite(cut.values)
    if not finite.all():
        channel, sample = np.argwhere(~finite)[0]
        raise ResponseError(
            f"{window.line}: expected numbers in {cut.channels[channel]}, found one that is not finite at "
            f"{window.start_s + cut.time_s[sample]:.3f} s: repair the signal before."
        )
    for name in cut.channels:
        if name != moved.name and np.ptp(cut.of(name)) == 0.0:
            raise ResponseError(
                f"{window.line}: expected {name} to move, found a constant between {window.start_s:g} and "
                f"{window.stop_s:g} s: the sensor or its channel is dead."
            )
    references = {name: signals.channels[name].reference for name in cut.channels}
    if signals.mode == "thesis":
        cost, remark = None, left_in_remark(cut, signals.orders, references)
    else:
        cut, cost = without_orders(cut, signals.orders, references, speed=signals.engine_speed.name)
        remark = ""
    line = measure_line(
        cut,
        method,
        excitation=moved.name,
        speed=signals.engine_speed.name,
        from_engine=moved.from_engine,
        messages={name: cut_messages(signal, window) for name, signal in signals.messages.items()},
        orders=cost,
    )
    return replace(line, order_remark=remark or line.order_remark)


def _expected_amplitude(moved: "ExcitationSignal", campaign: "Campaign", line: LineMeasurement) -> float:
    """Amplitude that the campaign asks for, over the working point."""
    amplitude_v = next(sine.amplitude_v for sine in campaign.sines if sine.name == line.window.line)
    return amplitude_v * abs(moved.per_volt) / moved.reference


def _without_silent(
    moved: "ExcitationSignal", campaign: "Campaign", measurements: Sequence[LineMeasurement]
) -> tuple[list[LineMeasurement], dict[str, str]]:
    """Leave out lines whose excitation does not move: they have no response, not even a bad one."""
    heard, silent = [], {}
    for line in measurements:
        expected = _expected_amplitude(moved, campaign, line)
        if line.excited < _SILENT_SHARE * expected:
            silent[line.window.line] = f"left out: {amplitude_remark(line.excited, expected, moved)}"
        else:
            heard.append(line)
    return heard, silent


def _judge(
    signals: "Signals",
    campaign: "Campaign",
    measurements: Sequence[LineMeasurement],
    sensor: "SpeedSignal",
    moved: "ExcitationSignal",
    local_db: "FloatArray",
) -> tuple[dict[str, str], "BoolArray"]:
    """Collect remarks on each line and say which lines have a clean excitation and a speed without aliasing."""
    remarks = {}
    usable = np.ones(len(measurements), dtype=bool)
    for row, line in enumerate(measurements):
        frequency = line.window.frequency_hz
        expected = _expected_amplitude(moved, campaign, line)
        finding = check_set_point(line, expected=expected, local_db=local_db, place=row, moved=moved)
        aliased = alias_remarks(frequency, signals, sensor, moved)
        lines = [*finding.remarks, *aliased]
        lines += [line.order_remark] if line.order_remark else []
        lines += line.message_remarks.values()
        lines += [
            f"{name} is not measured: a value every {signals.channels[name].cycle_s:g} s is too seldom for "
            f"{frequency:g} Hz"
            for name in line.channels
            if signals.channels[name].is_side and frequency > signals.channels[name].highest_hz
        ]
        if lines:
            remarks[line.window.line] = "; ".join(lines)
        usable[row] = finding.usable and not aliased
    return remarks, usable
