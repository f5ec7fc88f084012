"""What the signals and the test lines of a recording tell, as tables on the terminal."""

from collections import Counter

import numpy as np

from shaftprint.cli._numbers import with_uncertainty
from shaftprint.cli._tables import print_table
from shaftprint.cli._terminal import echo
from shaftprint.signals import Signals, SpeedSignal
from shaftprint.spectra import Spectra
from shaftprint.units import rpm_from_rev_s

DEGREES_PER_REVOLUTION = 360.0


def print_signals(signals: Signals) -> None:
    """Print working point, calibration, speed sensors, strip angles, step delays and repairs."""
    _print_steady_state(signals)
    _print_speeds(signals)
    _print_strips(signals)
    _print_delays(signals)
    _print_repairs(signals)


def print_lines(spectra: Spectra) -> None:
    """Print local and overall signal-to-noise ratios of every line and channel, and what speaks against a line."""
    ratios, response = spectra.signal_to_noise, spectra.response
    rows = []
    for place, line in enumerate(ratios.lines):
        number = response.lines.index(line)
        frequency = response.frequency_hz[number]
        decibels = [f"{value:.1f}" for value in ratios.local_db[place]]
        used = "yes" if response.used[number] else "no"
        rows.append((line, f"{frequency:g}", f"{2.0 * np.pi * frequency:.3g}", *decibels, used))
    rows.append(("overall [-]", "", "", *(f"{value:.3f}" for value in ratios.overall), ""))
    columns = ("line", "[Hz]", "[rad/s]", *(f"{channel} [dB]" for channel in ratios.channels), "used")
    print_table("Signal-to-noise ratio of the test lines", columns, rows, numbers=range(1, len(columns) - 1))
    for line, remark in spectra.remarks.items():
        echo(f"  {line}: {remark}")
    if spectra.remarks:
        echo()


def _print_steady_state(signals: Signals) -> None:
    point, line = signals.working_point, signals.calibration
    speed = with_uncertainty(rpm_from_rev_s(point.engine_speed_rev_s), rpm_from_rev_s(point.engine_speed_std_rev_s))
    torque = with_uncertainty(point.shaft_torque_nm, point.shaft_torque_std_nm)
    slope_std, intercept_std = rpm_from_rev_s(np.sqrt(np.diag(line.covariance)))
    slope = with_uncertainty(rpm_from_rev_s(line.slope_rev_s_per_v), float(slope_std))
    intercept = with_uncertainty(rpm_from_rev_s(line.intercept_rev_s), float(intercept_std))
    echo("Steady state")
    echo(f"  working point: n_0 = {speed} rpm, M_s0 = {torque} N m at {point.set_point_v:.4g} V")
    echo(f"  set-point line from {line.level_v.size} levels: n_set = ({slope}) rpm/V U + ({intercept}) rpm")
    echo(f"  scale that makes n / n_set go to 1: {with_uncertainty(signals.dc_scale, signals.dc_scale_std)}\n")


def _print_speeds(signals: Signals) -> None:
    columns = (
        "sensor", "channel", "mean [rpm]", "off the first [%]", "pulses [1/s]", "aliased above [Hz]", "mean over [ms]",
        "delay [ms]",
    )  # fmt: skip
    rows = [_speed_row(speed, signals.engine_speed) for speed in signals.speeds.values()]
    print_table("Engine-speed channels; the first is identified", columns, rows, numbers=range(2, len(columns)))


def _speed_row(speed: SpeedSignal, first: SpeedSignal) -> tuple[str, ...]:
    mean = float(np.mean(speed.speed_rev_s))
    return (
        speed.name,
        speed.channel,
        f"{rpm_from_rev_s(mean):.2f}",
        f"{100.0 * (mean / float(np.mean(first.speed_rev_s)) - 1.0):+.3f}",
        f"{speed.pulse_rate_hz:.2f}",
        f"{speed.nyquist_hz:.2f}",
        f"{1000.0 * speed.averaging_s:.1f}",
        f"{1000.0 * speed.delay_s:.1f}",
    )


def _print_strips(signals: Signals) -> None:
    for strips in signals.strips:
        angles = [
            with_uncertainty(DEGREES_PER_REVOLUTION * angle, DEGREES_PER_REVOLUTION * std)
            for angle, std in zip(strips.angle_rev.tolist(), strips.std_rev.tolist(), strict=True)
        ]
        echo(f"Strip angles of {strips.channel} [deg]: {', '.join(angles)}")
    if signals.strips:
        echo()


def _print_delays(signals: Signals) -> None:
    rows = [
        (
            delay.staircase,
            "up" if delay.rising else "down",
            f"{delay.set_point_time_s:.3f}",
            f"{delay.speed_time_s:.3f}",
            f"{delay.delay_s:.3f}",
        )
        for delay in signals.step_delays
    ]
    columns = ("staircase", "step", "set point [s]", "speed [s]", "delay [s]")
    if rows:
        print_table("Time from set point to speed, both at the middle of the step", columns, rows, numbers=(2, 3, 4))


def _print_repairs(signals: Signals) -> None:
    places = Counter((repair.channel, repair.kind) for repair in signals.repairs)
    if not places:
        echo("Repairs: none.\n")
        return
    rows = []
    for (channel, kind), count in sorted(places.items()):
        chosen = [repair for repair in signals.repairs if (repair.channel, repair.kind) == (channel, kind)]
        samples = sum(repair.count for repair in chosen)
        first, last = min(r.time_s for r in chosen), max(r.time_s for r in chosen)
        rows.append((channel, kind, str(count), str(samples), f"{first:.2f}", f"{last:.2f}"))
    columns = ("channel", "kind", "places", "samples or pulses", "first [s]", "last [s]")
    print_table("Repairs; the raw file is as it was", columns, rows, numbers=(2, 3, 4, 5))
