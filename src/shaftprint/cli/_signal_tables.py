"""The signals and test lines of a recording on the terminal."""

from __future__ import annotations

from shaftprint.cli._terminal import echo, say
from shaftprint.cli.output._tables import print_table, print_tables
from shaftprint.digits import plain_letters, with_deviation
from shaftprint.late import late

with late():
    import numpy as np

    from shaftprint.signals._inspect import ChannelReport, PulseReport
    from shaftprint.signals._signals import Signals
    from shaftprint.spectra._spectra import Spectra
    from shaftprint.tables._signals import (
        local_ratio_table,
        overall_ratio_table,
        repair_table,
        speed_table,
        step_table,
        strip_table,
    )
    from shaftprint.units import rpm_from_rev_s


# More strips than this are teeth, of which the worst is named.
_MOST_STRIPS = 12


def print_signals(signals: Signals) -> None:
    """Print working point, calibration, speed sensors, strip angles, step delays and repairs."""
    _print_steady_state(signals)
    print_tables([speed_table(signals), strip_table(signals), step_table(signals), repair_table(signals)])
    if not signals.repairs:
        echo("Repairs: none.\n")


def print_lines(spectra: Spectra) -> None:
    """Print local and overall signal-to-noise ratios of every line and channel, and what speaks against a line."""
    print_table(local_ratio_table(spectra))
    print_table(overall_ratio_table(spectra))
    for line, remark in spectra.remarks.items():
        say(f"{line}: {remark}", indent="  ")
    if spectra.remarks:
        echo()


def _print_steady_state(signals: Signals) -> None:
    point, line = signals.working_point, signals.calibration
    speed = with_deviation(rpm_from_rev_s(point.engine_speed_rev_s), rpm_from_rev_s(point.engine_speed_std_rev_s))
    torque = with_deviation(point.shaft_torque_nm, point.shaft_torque_std_nm)
    slope_std, intercept_std = rpm_from_rev_s(np.sqrt(np.diag(line.covariance)))
    slope = with_deviation(rpm_from_rev_s(line.slope_rev_s_per_v), float(slope_std))
    intercept = with_deviation(rpm_from_rev_s(line.intercept_rev_s), float(intercept_std))
    scale = with_deviation(signals.dc_scale, signals.dc_scale_std)
    echo("Steady state")
    for sentence in (
        f"working point: n_0 = {speed} rpm, M_s0 = {torque} N m at {point.set_point_v:.4g} V",
        f"set-point line from {line.level_v.size} levels: n_set = ({slope}) rpm/V U + ({intercept}) rpm",
        f"scale that makes n / n_set go to 1: {scale}\n",
    ):
        say(plain_letters(sentence), indent="  ")


def sensor_row(report: ChannelReport) -> tuple[str, ...]:
    """Return the row of a channel of the vessel file: what it is used for, and what it shows."""
    pulses = report.pulses
    between = (report.lowest, report.highest) if pulses is None else (pulses.low, pulses.high)
    kinds = sorted({fault.kind for fault in report.faults})
    counts = [f"{sum(fault.kind == kind for fault in report.faults)} x {kind}" for kind in kinds]
    return (
        report.channel,
        report.use,
        f"{between[0]:.3g} to {between[1]:.3g} {report.unit}",
        "" if pulses is None else f"{pulses.per_second:.3f}",
        "" if pulses is None else f"{pulses.speed_rpm:.2f}",
        "" if pulses is None else _strips_in_words(pulses),
        ", ".join(counts) or "none",
    )


def _strips_in_words(pulses: PulseReport) -> str:
    angles = pulses.strip_angles_deg
    if len(angles) > _MOST_STRIPS:
        return f"{len(angles)} teeth, errors up to {abs(pulses.largest_error_deg):.2f}"
    return "" if len(angles) == 1 else ", ".join(f"{angle:.2f}" for angle in angles)
