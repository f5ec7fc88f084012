"""Tables of the measurement: calibration, speeds, steps, strips, windows, signal-to-noise ratios, repairs."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.digits import plain, with_deviation
from shaftprint.plain_table import Column, Symbol, Table, numbers, texts
from shaftprint.units import MILLI, PERCENT, SECONDS_PER_MINUTE

if TYPE_CHECKING:
    from shaftprint.signals._channel_signals import SpeedSignal
    from shaftprint.signals._signals import Repair, Signals, StripAngles
    from shaftprint.spectra._spectra import Spectra

DEGREES_PER_REV = 360.0


def calibration_table(signals: "Signals") -> Table:
    """Return the steady levels of the set point and their distance from the line (thesis table 3.1)."""
    line = signals.calibration
    slope, intercept = SECONDS_PER_MINUTE * line.slope_rev_s_per_v, SECONDS_PER_MINUTE * line.intercept_rev_s
    std = SECONDS_PER_MINUTE * np.sqrt(np.diag(line.covariance))
    rows = []
    for volts, speed, spread in zip(line.level_v, line.level_rev_s, line.level_std_rev_s, strict=True):
        rpm = SECONDS_PER_MINUTE * float(speed)
        rows.append(
            (
                plain(float(volts), 3),
                with_deviation(rpm, SECONDS_PER_MINUTE * float(spread)),
                plain(rpm - slope * float(volts) - intercept, 2),
            )
        )
    return Table(
        title="Set-point voltage and engine speed at the steady levels (thesis, table 3.1)",
        columns=numbers("set point [V]", "engine speed [rpm]", "above the line [rpm]"),
        rows=tuple(rows),
        note=(
            f"Line: slope {with_deviation(slope, float(std[0]))} rpm/V, intercept "
            f"{with_deviation(intercept, float(std[1]))} rpm. DC scale on the deviation from the working point: "
            f"{with_deviation(signals.dc_scale, signals.dc_scale_std)}."
        ),
    )


def step_table(signals: "Signals") -> Table:
    """Return the delay of every step (thesis table 3.3)."""
    rows = tuple(
        (
            step.staircase,
            plain(step.set_point_time_s, 3),
            *("hidden by noise" if one is None else plain(one, 3) for one in (step.speed_time_s, step.delay_s)),
            "rising" if step.rising else "falling",
        )
        for step in signals.step_delays
    )
    note = "Level-crossing delays hold transport delay, rise time of the loop and delay of the sensor together."
    for name in dict.fromkeys(step.staircase for step in signals.step_delays):
        of_name = (step.delay_s for step in signals.step_delays if step.staircase == name)
        delays = np.array([delay for delay in of_name if delay is not None])
        if not delays.size:
            continue
        error = float(delays.std(ddof=1)) / np.sqrt(delays.size) if delays.size > 1 else 0.0
        note += f" Mean of {name}: {with_deviation(float(delays.mean()), error)} s."
    return Table(
        title="Delay between set point and speed at each step (thesis, table 3.3)",
        columns=(
            *texts("staircase"),
            *numbers("set point crosses at [s]", "speed crosses at [s]", "delay [s]"),
            *texts("speed"),
        ),
        rows=rows,
        note=note,
    )


def strip_table(signals: "Signals") -> Table:
    """Return the angles between the reflection strips (thesis table 3.4)."""
    rows = []
    for strip in signals.strips:
        count = strip.angle_rev.size
        for place in [strip.worst] if strip.are_many else range(count):
            angle, error = float(strip.angle_rev[place]), float(strip.error_rev[place])
            rows.append(
                (
                    strip.channel,
                    f"{place + 1} of {count}, the worst" if strip.are_many else str(place + 1),
                    with_deviation(DEGREES_PER_REV * angle, DEGREES_PER_REV * float(strip.std_rev[place])),
                    f"{plain(PERCENT * error / (angle - error), 2)} %",
                )
            )
    even = [one for one in signals.strips if one.are_even]
    removed = "not removed (thesis mode)" if signals.mode == "thesis" else "removed from the speed"
    return Table(
        title="Angles between the reflection strips (thesis, table 3.4)",
        columns=(*texts("channel"), *numbers("strip", "angle to the next [deg]", "error of an even spacing")),
        rows=tuple(rows),
        note=" ".join(
            [
                *(f"The strips of {one.channel} are even within {_largest(one)} %." for one in even),
                *([f"The uneven angles are {removed}."] if len(even) < len(signals.strips) else []),
            ]
        ),
    )


def _largest(strips: "StripAngles") -> str:
    """Return the largest error of the angles of a shaft, in percent of an even one."""
    error = float(strips.error_rev[strips.worst])
    return plain(abs(PERCENT * error / (float(strips.angle_rev[strips.worst]) - error)), 2)


def window_table(spectra: "Spectra") -> Table:
    """Return the analysis windows of whole periods (thesis table 3.5) with remarks."""
    response = spectra.response
    used = dict(zip(response.lines, response.used, strict=True))
    rows = tuple(
        (
            window.line,
            str(window.periods),
            plain(window.frequency_hz, 4),
            plain(window.start_s, 2),
            plain(window.stop_s, 2),
            "yes" if used.get(window.line, False) else "no",
            spectra.remarks.get(window.line, ""),
        )
        for window in spectra.windows
    )
    return Table(
        title="Analysis windows of whole periods (thesis, table 3.5)",
        columns=(
            *texts("line"),
            *numbers("periods i", "frequency [Hz]", "start [s]", "stop [s]"),
            *texts("used", "remark"),
        ),
        rows=rows,
    )


def overall_ratio_table(spectra: "Spectra") -> Table:
    """Return the overall signal-to-noise ratio of each channel (thesis table 3.6)."""
    ratios = spectra.signal_to_noise
    rows = tuple(
        (Symbol(channel), plain(float(value), 4))
        for channel, value in zip(ratios.channels, ratios.overall, strict=True)
    )
    return Table(
        title="Overall signal-to-noise ratio of each channel (thesis, table 3.6)",
        columns=(*texts("channel"), *numbers("ratio, 1 without noise")),
        rows=rows,
    )


def local_ratio_table(spectra: "Spectra") -> Table:
    """Return the local signal-to-noise ratio of each line and channel (thesis table 3.7)."""
    ratios, response = spectra.signal_to_noise, spectra.response
    rows = []
    for line, values in zip(ratios.lines, ratios.local_db, strict=True):
        index = response.lines.index(line)
        frequency = float(response.frequency_hz[index])
        rows.append(
            (
                line,
                plain(frequency, 4),
                plain(2.0 * np.pi * frequency, 2),
                *(plain(float(value), 1) for value in values),
                "yes" if response.used[index] else "no",
            )
        )
    channels = (Column(Symbol(channel), number=True) for channel in ratios.channels)
    return Table(
        title="Local signal-to-noise ratio [dB], 20 bins on each side (thesis, table 3.7)",
        columns=(*texts("line"), *numbers("[Hz]", "[rad/s]"), *channels, *texts("used")),
        rows=tuple(rows),
        note="0 dB means as much noise as signal; the thesis requires 3 dB. Weaker frequencies are kept: the "
        "fit weights each by its noise.",
    )


def repair_table(signals: "Signals") -> Table:
    """Return how many places of each channel were repaired, how, and between which seconds."""
    repairs: dict[tuple[str, str], list[Repair]] = {}
    for repair in signals.repairs:
        repairs.setdefault((repair.channel, repair.kind), []).append(repair)
    rows = tuple(
        (
            channel,
            kind,
            str(len(places)),
            str(sum(repair.count for repair in places)),
            plain(min(repair.time_s for repair in places), 2),
            plain(max(repair.time_s for repair in places), 2),
        )
        for (channel, kind), places in sorted(repairs.items())
    )
    return Table(
        title="Repairs of raw channels",
        columns=(*texts("channel", "kind"), *numbers("places", "samples or pulses", "first [s]", "last [s]")),
        rows=rows,
        note="The raw file is never changed; every repair with its time is kept in the prepared signals.",
    )


def speed_table(signals: "Signals") -> Table:
    """Return mean, pulse rate, averaging and delay of every pick-up."""
    return Table(
        title="Engine-speed channels; the first is identified",
        columns=(
            *texts("sensor", "channel"),
            *numbers("mean [rpm]", "off the first [%]", "pulses [1/s]"),
            *numbers("aliased above [Hz]", "mean over [ms]", "delay [ms]"),
        ),
        rows=tuple(_speed_row(speed, signals.engine_speed) for speed in signals.speeds.values()),
    )


def _speed_row(speed: "SpeedSignal", first: "SpeedSignal") -> tuple[str, ...]:
    mean = float(np.mean(speed.speed_rev_s))
    return (
        speed.name,
        speed.channel,
        plain(SECONDS_PER_MINUTE * mean, 2),
        plain(PERCENT * (mean / float(np.mean(first.speed_rev_s)) - 1.0), 3),
        plain(speed.pulse_rate_hz, 2),
        plain(speed.nyquist_hz, 2),
        plain(MILLI * speed.averaging_s, 1),
        plain(MILLI * speed.delay_s, 1),
    )
