"""The verb for legs: from signals and campaign to the response of each leg about its own working point."""

from dataclasses import replace
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from shaftprint.arguments import refusing_none
from shaftprint.errors import ResponseError
from shaftprint.spectra._aliases import alias_remarks
from shaftprint.spectra._line_responses import HIGHEST_SHARE_OF_RATE, channels_on_grid, response_of_lines
from shaftprint.spectra._shift_check import shift_reasons
from shaftprint.spectra._spectra import Spectra
from shaftprint.spectra._speed_ratios import speed_ratios
from shaftprint.spectra.legs._leg_check import check_leg, leg_clock_reasons, leg_shape_reasons
from shaftprint.spectra.legs._leg_lines import measure_leg
from shaftprint.spectra.legs._leg_window import cut_leg
from shaftprint.spectra.legs._pitch_shifts import pitch_shift_reasons
from shaftprint.spectra.lines._clock_check import channel_clock_reasons, offsets_of_lines
from shaftprint.spectra.lines._harmonics import collect_harmonics
from shaftprint.spectra.lines._input_band import band_of_lines, band_reasons
from shaftprint.spectra.lines._load_drift import LoadDrift
from shaftprint.spectra.lines._signal_to_noise import signal_to_noise

if TYPE_CHECKING:
    from collections.abc import Sequence

    from shaftprint.arrays import BoolArray
    from shaftprint.campaign._campaign import Campaign
    from shaftprint.campaign._leg import Leg
    from shaftprint.campaign._multisine import Multisine
    from shaftprint.reasons import Reason
    from shaftprint.signals._channel_signals import ExcitationSignal, SpeedSignal
    from shaftprint.signals._signals import Signals
    from shaftprint.signals._working_points import LegState
    from shaftprint.spectra.legs._leg_check import LegFinding
    from shaftprint.spectra.legs._leg_lines import LegLines
    from shaftprint.spectra.lines._line_measurement import LineMeasurement

SPEED = "n_set"
"""Symbol of the set point of the speed."""
_Lines: TypeAlias = tuple[tuple[int, ...], tuple[int, ...]]


@refusing_none(ResponseError)
def estimate_inputs_of_legs(signals: "Signals", campaign: "Campaign") -> dict[str, dict[str, Spectra]]:
    """Measure every leg of a campaign that the recording holds, each about its own working point.

    Set point and speed are divided by the mean speed ``n_0`` of the leg, the torque by ``M_0`` (see ``LegState``). The
    load of each line is 1 by definition. A leg that was cut off gives a result of its whole periods. What was moved
    beside the speed in the same periods has lines of its own and is told apart line by line, as if each had been moved
    alone: what is nonlinear in both falls between the lines where all harmonics are odd.

    ``signals``: the prepared recording. ``campaign``: what was asked of the ship; only its legs are used. Returns of
    each leg by its name, in order of time, response, signal-to-noise ratios and remarks of its inputs by their symbols,
    that of the speed first. Raises ResponseError if a channel holds values that are not numbers or does not move, the
    set point of a leg stands still, or the vessel file names no sensor of what was moved.
    """
    by_name = {leg.name: leg for leg in campaign.legs}
    found, of_speed = {}, []
    for state in signals.legs:
        about, leg = signals.about(state.name), by_name[state.name]
        beside = campaign.beside(leg)
        moved = tuple(leg.lines), tuple(sorted(harmonic for one in beside for harmonic in one.lines))
        excitations = {SPEED: leg, **{_symbol_of(one, signals): one for one in beside}}
        measured = {
            symbol: _measured(about, one, replace(state, name=one.name), symbol, moved)
            for symbol, one in excitations.items()
        }
        of_speed.append(measured[SPEED])
        found[state.name] = {
            symbol: _leg(about, one, measured[symbol], about.excitations[symbol]) for symbol, one in excitations.items()
        }
    against = _channel_clocks(of_speed, signals.engine_speed.name)
    return {
        name: {symbol: _with_reasons(one, against) for symbol, one in by_input.items()}
        for name, by_input in found.items()
    }


def _with_reasons(spectra: Spectra, reasons: "Sequence[Reason]") -> Spectra:
    response = spectra.response
    return replace(spectra, response=replace(response, reasons=(*reasons, *response.reasons)))


def _channel_clocks(legs: "Sequence[LegLines]", speed: str) -> "tuple[Reason, ...]":
    """Return what the lines of all legs together say against the clocks of speed and torque."""
    offsets = [offsets_of_lines(leg.lines, (speed, "M_s")) for leg in legs]
    if not offsets:
        return ()
    offset, std = (np.concatenate(rows) for rows in zip(*offsets, strict=True))
    return channel_clock_reasons(offset, std, channels=(f"the speed {speed}", "the shaft torque"))


def _symbol_of(multisine: "Multisine", signals: "Signals") -> str:
    for name, moved in signals.excitations.items():
        if moved.input == multisine.input:
            return name
    raise ResponseError(
        f"{multisine.name}: expected [sensors.{multisine.input}] in the vessel file, which {multisine.name} moves, "
        "found none."
    )


def _leg(signals: "Signals", leg: "Leg", measured: "LegLines", moved: "ExcitationSignal") -> Spectra:
    """Return what one input of a leg shows."""
    sensor = signals.engine_speed
    expected = np.array([leg.lines[harmonic] for harmonic in measured.harmonics]) * abs(moved.per_volt)
    finding = check_leg(measured, expected=expected / moved.reference, moved=moved)
    band = band_of_lines(measured.lines, expected / moved.reference, moved)
    kept = [place for place, line in enumerate(measured.lines) if line.window.line not in finding.silent]
    lines = [measured.lines[place] for place in kept]
    if not lines:
        raise ResponseError(
            f"{leg.name}: expected a {moved.words} that moves at the lines of the campaign, found none of them between "
            f"{measured.window.state.start_s:g} and {measured.window.state.stop_s:g} s: check that campaign and "
            "recording belong together."
        )
    remarks, used = _judged(lines, finding, signals, moved)
    missing = leg.periods - measured.window.state.periods
    if missing > 0:
        remarks[leg.name] = f"{measured.window.state.periods} of {leg.periods} periods are in the recording"
    load = np.array([_load(line, measured.square[place], sensor) for place, line in zip(kept, lines, strict=True)])
    response = replace(
        response_of_lines(signals, lines, excitation=moved, sensor=sensor, load=np.ones(len(lines))),
        used=used,
        load=load,
        remarks=remarks | finding.silent,
    )
    of_response = shift_reasons(response) if moved.from_engine else ()
    of_band = band_reasons(band, channel=moved.channel, symbol=moved.name)
    pitch = signals.channels.get("theta")
    of_pitch = () if pitch is None else pitch_shift_reasons(measured, moved=moved.channel, shown=pitch.channel)
    against = (*leg_clock_reasons(measured), *leg_shape_reasons(measured), *of_response, *of_band, *of_pitch)
    return Spectra(
        response=replace(
            response,
            reasons=(*signals.reasons, *against),
            input_late_s=None if band is None or band.late_s else band.widest_s,
            input_drift=measured.window.clock_ratio,
        ),
        windows=tuple(line.window for line in lines),
        signal_to_noise=signal_to_noise(
            [line.variances_with(*signals.messages) for line in lines],
            lines=tuple(line.window.line for line in lines),
            channels=(*measured.window.channels, *signals.messages),
        ),
        harmonics=collect_harmonics(lines, speed=sensor.name),
        load_drift=LoadDrift(delta=np.zeros(len(lines)), standard_deviation=0.0),
        speed=sensor.name,
        remarks=remarks | finding.silent,
        speed_ratios=speed_ratios(lines, sensor, signals.speeds.values()),
    )


def _load(line: "LineMeasurement", square: complex, sensor: "SpeedSignal") -> complex:
    """Return the load slope at a line over that of the linear propeller, 2: what the square of the speed adds to it."""
    speed = line.amplitude[line.channels.index(sensor.name)] / sensor.gain(line.window.frequency_hz)
    return complex(1.0 + 0.5 * square / speed)


def _judged(
    lines: "Sequence[LineMeasurement]",
    finding: "LegFinding",
    signals: "Signals",
    moved: "ExcitationSignal",
) -> tuple[dict[str, str], "BoolArray"]:
    """Return remarks on lines, and which of them have a clean set point and a speed without aliasing."""
    remarks, used = dict(finding.remarks), np.ones(len(lines), dtype=np.bool_)
    for row, line in enumerate(lines):
        name = line.window.line
        aliased = alias_remarks(line.window.frequency_hz, signals, signals.engine_speed, moved)
        for remark in filter(None, (*aliased, line.order_remark, *line.message_remarks.values())):
            remarks[name] = "; ".join(part for part in (remarks.get(name), remark) if part)
        used[row] = not aliased and name not in finding.unusable
    return remarks, used


def _below(harmonics: "Sequence[int]", highest: float) -> list[int]:
    return [harmonic for harmonic in harmonics if harmonic <= highest]


def _measured(
    signals: "Signals",
    leg: "Leg",
    state: "LegState",
    excitation: str,
    lines_of: "_Lines",
) -> "LegLines":
    """Return the lines of one input of a leg in every channel that answers it.

    ``lines_of`` are the harmonics of the speed, and those of all else.
    """
    highest = HIGHEST_SHARE_OF_RATE * signals.rate_hz * leg.length_of_period_s
    harmonics = _below(tuple(leg.lines), highest)
    channels = {name: signals.channels[name] for name in channels_on_grid(signals, excitation)}
    window = cut_leg(
        {name: signal.values for name, signal in channels.items()},
        {name: signal.reference for name, signal in channels.items()},
        state,
        harmonics,
        excitation=excitation,
        rate_hz=signals.rate_hz,
        start_s=signals.start_s,
    )
    for name in window.channels:
        values = window.of(name)
        if not np.isfinite(values).all():
            raise ResponseError(f"{leg.name}: expected numbers in {name}, found some that are not: repair the signal.")
        if name != excitation and np.ptp(values) == 0.0:
            raise ResponseError(
                f"{leg.name}: expected {name} to move, found a constant from {state.start_s:g} to {state.stop_s:g} "
                "s: the sensor or its channel is dead."
            )
    return measure_leg(
        window,
        harmonics,
        excitation=excitation,
        speed=signals.engine_speed.name,
        of_speed=_below(lines_of[0], highest),
        beside=_below(lines_of[1], highest),
        orders=signals.orders,
        references={name: signal.reference for name, signal in channels.items()},
        messages=signals.messages,
    )
