"""Whether the set point of a leg is what the campaign says: its lines, its periods, its clock, its shape."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.reasons import Reason
from shaftprint.spectra.legs._leg_lines import LegLines
from shaftprint.spectra.lines._set_point_check import amplitude_remark
from shaftprint.units import PERCENT

if TYPE_CHECKING:
    from shaftprint.arrays import FloatArray
    from shaftprint.signals._channel_signals import ExcitationSignal

# Of the amplitude that was asked for: no line at all, no usable line, and what is worth a remark.
_SILENT_SHARE, _UNEXCITED_SHARE, _AMPLITUDE_TOLERANCE = 1e-3, 0.1, 0.1
# Periods whose line differs by more from the middle one are disturbed; a line is lost where half of them are.
_PERIOD_TOLERANCE, _PERIOD_LIMIT = 0.25, 0.5
# Largest error of a clock that changes no number by more than its deviation; loggers keep to a tenth of it.
_CLOCK_TOLERANCE = 5e-4
# Held steps and the resolution of a generator stay far below this share of the lines.
_SHAPE_LIMIT = 0.03


@dataclass(frozen=True, kw_only=True, slots=True)
class LegFinding:
    """What was found on the set point of a leg."""

    silent: dict[str, str]
    """Lines that do not move at all, with the reason: they have no response."""
    remarks: dict[str, str]
    """What was found, by name of the line."""
    unusable: frozenset[str]
    """Lines that a fit should not use."""


def check_leg(measured: LegLines, *, expected: "FloatArray", moved: "ExcitationSignal") -> LegFinding:
    """Compare the set point of every line with the campaign.

    ``measured``: the lines. ``expected``: amplitude that the campaign asks for at each line, over the working point,
    shape (lines,). ``moved``: the signal that was moved, for messages.
    """
    silent, remarks, unusable = {}, {}, set()
    for line, asked in zip(measured.lines, expected.tolist(), strict=True):
        name, amplitude = line.window.line, line.excited
        if amplitude < _SILENT_SHARE * asked:
            silent[name] = f"left out: {amplitude_remark(amplitude, asked, moved)}"
            continue
        disturbed = line.disturbed_stretches(_PERIOD_TOLERANCE)
        if abs(amplitude - asked) > _AMPLITUDE_TOLERANCE * asked:
            remarks[name] = amplitude_remark(amplitude, asked, moved)
        elif disturbed.any():
            remarks[name] = f"set point is disturbed in {np.count_nonzero(disturbed)} of {disturbed.size} periods"
        if amplitude < _UNEXCITED_SHARE * asked or disturbed.mean() >= _PERIOD_LIMIT:
            unusable.add(name)
    return LegFinding(silent=silent, remarks=remarks, unusable=frozenset(unusable))


def leg_clock_reasons(measured: LegLines) -> tuple[Reason, ...]:
    """Return a reason where the period of the set point is not that of the campaign."""
    ratio = measured.window.clock_ratio
    if abs(ratio) <= _CLOCK_TOLERANCE:
        return ()
    return (
        Reason(
            kind="recording clock",
            where=measured.window.state.name,
            sentence=(
                f"The clock of the recording is in doubt: the periods of {measured.window.state.name} are "
                f"{PERCENT * ratio:+.2f} % longer than the campaign file says; check the sample rate that the file "
                "declares, or period_s of the campaign file."
            ),
        ),
    )


def leg_shape_reasons(measured: LegLines) -> tuple[Reason, ...]:
    """Return a reason where the recorded set point holds more than its lines: it was cut off, or limited in rate."""
    excitation = measured.lines[0].excitation
    window = measured.window
    spectrum = window.spectrum()[window.channels.index(excitation)]
    periods, highest = window.state.periods, measured.harmonics[-1]
    # above the fastest line a binary sequence has harmonics that are not measured
    power = np.abs(spectrum[periods : highest * periods + 1 : periods]) ** 2
    is_line = np.isin(np.arange(1, power.size + 1), measured.harmonics)
    share = float(np.sqrt(power[~is_line].sum() / max(power[is_line].sum(), np.finfo(np.float64).tiny)))
    if share <= _SHAPE_LIMIT:
        return ()
    name = window.state.name
    return (
        Reason(
            kind="set-point shape",
            where=name,
            sentence=(
                f"The set point of {name} is not the sum of lines that the campaign asks for: what lies beside them is "
                f"{PERCENT * share:.1f} % of it; check whether its channel is cut off at a highest or lowest value."
            ),
        ),
    )
