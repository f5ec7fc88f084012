"""The verb of the room: from signals and campaign to responses, signal-to-noise ratios and harmonics."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arguments import refusing_none
from shaftprint.errors import ResponseError
from shaftprint.reasons import Reason
from shaftprint.signals import MessageSignal
from shaftprint.spectra._clock_check import clock_reasons
from shaftprint.spectra._frequency_response import FrequencyResponse
from shaftprint.spectra._harmonics import Harmonics, collect_harmonics
from shaftprint.spectra._line_fit import SineMethod, WindowSamples, cut_window
from shaftprint.spectra._line_measurement import LineMeasurement, measure_line
from shaftprint.spectra._line_responses import response_of_lines
from shaftprint.spectra._load_drift import LoadDrift, load_drift
from shaftprint.spectra._rack_line import cut_rack
from shaftprint.spectra._set_point_check import amplitude_remark, check_frequency_unit, check_set_point, shape_reasons
from shaftprint.spectra._shift_check import shift_reasons
from shaftprint.spectra._signal_to_noise import SignalToNoise, signal_to_noise
from shaftprint.spectra._sine_fit import WholePeriodSine
from shaftprint.spectra._windows import Window, plan_windows
from shaftprint.units import rpm_from_rev_s

if TYPE_CHECKING:
    from shaftprint.arrays import BoolArray, FloatArray
    from shaftprint.campaign import Campaign
    from shaftprint.signals import Signals, SpeedSignal

_WHOLE_PERIOD_SINE = WholePeriodSine()

# A line this close to half the rate of the grid has no neighbours above it and is bent by the anti-alias filter.
_HIGHEST_SHARE_OF_RATE = 0.45
_SILENT_SHARE = 1e-3


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Spectra:
    """All that the sines of a campaign tell about one shaft line."""

    response: FrequencyResponse
    """Response from ``n_set`` to ``n`` and ``M_s``; to ``v_s`` where the speed of the ship was logged, to ``X`` where
    the rack was."""
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


@refusing_none(ResponseError)
def estimate_response(
    signals: "Signals",
    campaign: "Campaign",
    *,
    method: SineMethod = _WHOLE_PERIOD_SINE,
    speed: str | None = None,
) -> FrequencyResponse:
    """Estimate the response from set point to speed, torque and rack with full covariance.

    Parameters, result and errors are those of `estimate_spectra`, of which this is the response.
    """
    return estimate_spectra(signals, campaign, method=method, speed=speed).response


@refusing_none(ResponseError)
def estimate_spectra(
    signals: "Signals",
    campaign: "Campaign",
    *,
    method: SineMethod = _WHOLE_PERIOD_SINE,
    speed: str | None = None,
) -> Spectra:
    """Measure every sine of a campaign in every channel.

    All values are divided by the working point of the whole recording: set point and speed by ``n_0``, torque by
    ``M_s0``, speed of the ship by ``v_0``, fuel rack by ``X_0``; the propeller load of each window relative to it
    goes with the response as ``load``. Lines above half the pulse rate of the speed sensor are aliased and not used
    by default; neither are lines whose set point is not a sine of the stated frequency. A line may be too fast for
    the messages of the control unit: its response to ``X`` is then unknown (see `measured`), that to speed and
    torque is not. In thesis mode all lines are used, each divided by its own mean instead of the working point, as the
    thesis did (section 3.3), and the remarks say what speaks against them.

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
    ship = () if "v_s" not in signals.channels else ("v_s",)
    names = ("n_set", *signals.speeds, *ship, "M_s")
    used_channels = [0, names.index(sensor.name), len(names) - 1, *(names.index(name) for name in ship)]
    cuts, left_out = _cut_windows(signals, campaign, names)
    measurements = [_measure(signals, cut, names, method) for cut in cuts]
    check_frequency_unit(measurements)
    measurements, silent = _without_silent(signals, campaign, measurements)
    ratios = signal_to_noise(
        [line.variances if signals.channels.get("X") is None else line.variances_with_rack for line in measurements],
        lines=tuple(line.window.line for line in measurements),
        channels=names if signals.channels.get("X") is None else (*names, "X"),
    )
    remarks, usable = _judge(signals, campaign, measurements, sensor, ratios.local_db[:, 0])
    drift = load_drift(measurements, speed=used_channels[1], torque=used_channels[2])
    thesis = signals.mode == "thesis"
    against = () if thesis else _against(cuts, measurements, sensor, used_channels)
    used = np.ones_like(usable) if thesis else usable
    load = np.ones(len(measurements)) if thesis else 1.0 + drift.delta
    response = replace(
        response_of_lines(signals, measurements, channels=used_channels, sensor=sensor, load=load),
        used=used,
        remarks=remarks | silent | left_out,
        load=load,
        averaging_s=sensor.averaging_s,
        hold_s=sensor.hold_s,
        pick_up_delay_s=sensor.delay_s,
    )
    shifted = () if thesis else shift_reasons(response)
    return Spectra(
        response=replace(response, reasons=(*signals.reasons, *against, *shifted)),
        windows=tuple(line.window for line in measurements),
        signal_to_noise=ratios,
        harmonics=collect_harmonics(measurements, speed=used_channels[1], torque=used_channels[2]),
        load_drift=drift,
        speed=sensor.name,
        remarks=remarks | silent | left_out,
    )


def _against(
    cuts: Sequence[WindowSamples], lines: Sequence[LineMeasurement], sensor: "SpeedSignal", places: Sequence[int]
) -> tuple[Reason, ...]:
    """Return what the sines say against clocks and set point."""
    channels = {"the set point": places[0], f"the speed {sensor.name}": places[1], "the shaft torque": places[2]}
    return (*clock_reasons(cuts, lines, channels=channels), *shape_reasons(lines))


def _speed_signal(signals: "Signals", speed: str | None) -> "SpeedSignal":
    if speed is None:
        return signals.engine_speed
    if speed not in signals.speeds:
        raise ResponseError(
            f"Speed sensor {speed}: expected one of {', '.join(signals.speeds)}, found no such sensor in the signals."
        )
    return signals.speeds[speed]


def _cut_windows(
    signals: "Signals", campaign: "Campaign", names: Sequence[str]
) -> tuple[list[WindowSamples], dict[str, str]]:
    """Cut every line out of the normalised channels; say which lines the recording does not hold."""
    rows = [signals.channels[name] for name in names]
    channels = tuple(row.values for row in rows)
    scale = np.array([[1.0 / row.reference] for row in rows])
    cuts, left_out = [], {}
    for window in plan_windows(campaign):
        if window.frequency_hz > _HIGHEST_SHARE_OF_RATE * signals.rate_hz:
            left_out[window.line] = (
                f"left out: {window.frequency_hz:g} Hz is above "
                f"{_HIGHEST_SHARE_OF_RATE * signals.rate_hz:g} Hz, what signals of "
                f"{signals.rate_hz:g} Hz show"
            )
            continue
        missing = signals.coverage.missing(window.start_s, window.stop_s)
        if missing:
            left_out[window.line] = f"left out: {missing}"
            continue
        cut = cut_window(window, channels, rate_hz=signals.rate_hz, start_s=signals.start_s)
        if cut is None:
            left_out[window.line] = (
                f"left out: its window from {window.start_s:g} to {window.stop_s:g} s is not inside the recording"
            )
            continue
        np.multiply(cut.values, scale, out=cut.values)
        cuts.append(cut)
    if not cuts:
        line, remark = next(iter(left_out.items()))
        raise ResponseError(
            f"{signals.recording_name}: expected at least one sine of campaign {campaign.name}, "
            f"found none ({line} {remark}): check that campaign and recording belong together."
        )
    return cuts, left_out


def _measure(signals: "Signals", cut: WindowSamples, names: Sequence[str], method: SineMethod) -> LineMeasurement:
    window = cut.window
    finite = np.isfinite(cut.values)
    if not finite.all():
        channel, place = np.argwhere(~finite)[0]
        raise ResponseError(
            f"{window.line}: expected numbers in {names[channel]}, found one that is not finite at "
            f"{window.start_s + cut.time_s[place]:.3f} s: repair the signal before."
        )
    still = np.ptp(cut.values[1:], axis=1) == 0.0
    if still.any():
        raise ResponseError(
            f"{window.line}: expected {names[1 + int(np.argmax(still))]} to move, found a constant "
            f"between {window.start_s:g} and {window.stop_s:g} s: the sensor or its channel is dead."
        )
    rack = signals.channels.get("X")
    return measure_line(cut, method, cut_rack(rack, window) if isinstance(rack, MessageSignal) else None)


def _expected_amplitude(signals: "Signals", campaign: "Campaign", line: LineMeasurement) -> float:
    """Amplitude that the campaign asks of the set point, over the working point."""
    amplitude_v = next(sine.amplitude_v for sine in campaign.sines if sine.name == line.window.line)
    return amplitude_v * abs(signals.calibration.slope_rev_s_per_v) / signals.working_point.engine_speed_rev_s


def _without_silent(
    signals: "Signals", campaign: "Campaign", measurements: Sequence[LineMeasurement]
) -> tuple[list[LineMeasurement], dict[str, str]]:
    """Leave out lines whose set point does not move: they have no response, not even a bad one."""
    heard, silent = [], {}
    rpm = rpm_from_rev_s(signals.working_point.engine_speed_rev_s)
    for line in measurements:
        expected = _expected_amplitude(signals, campaign, line)
        found = float(np.abs(line.amplitude[0]))
        if found < _SILENT_SHARE * expected:
            silent[line.window.line] = f"left out: {amplitude_remark(found, expected, rpm)}"
        else:
            heard.append(line)
    return heard, silent


def _judge(
    signals: "Signals",
    campaign: "Campaign",
    measurements: Sequence[LineMeasurement],
    sensor: "SpeedSignal",
    local_db: "FloatArray",
) -> tuple[dict[str, str], "BoolArray"]:
    """Collect remarks on each line and say which lines have a clean set point and a speed without aliasing."""
    remarks = {}
    usable = np.ones(len(measurements), dtype=bool)
    for place, line in enumerate(measurements):
        name = line.window.line
        finding = check_set_point(
            line,
            expected=_expected_amplitude(signals, campaign, line),
            local_db=local_db,
            place=place,
            rpm=rpm_from_rev_s(signals.working_point.engine_speed_rev_s),
        )
        found = list(finding.remarks)
        aliased = line.window.frequency_hz > sensor.nyquist_hz
        if aliased:
            found.append(f"above {sensor.nyquist_hz:.2f} Hz, half the pulse rate of {sensor.name}: aliased")
        if line.rack_remark:
            found.append(line.rack_remark)
        if "v_s" in signals.channels and not line.window.frequency_hz <= signals.channels["v_s"].highest_hz:
            cycle = signals.channels["v_s"].cycle_s
            found.append(
                f"v_s is not measured: a value every {cycle:g} s is too seldom for {line.window.frequency_hz:g} Hz"
            )
        if found:
            remarks[name] = "; ".join(found)
        usable[place] = finding.usable and not aliased
    return remarks, usable
