"""What the uncertainty of other loggers' clocks does to a measured response and to what is fitted to it.

An error ``s`` of the clock by which an output ``H`` was logged, the set point by another, turns its phase by
``omega s``: to first order ``dH = -j omega s H``. Weighted least squares carry this to the parameters as
``(J^T C^-1 J)^-1 J^T C^-1 dH``, and by the inequality of Cauchy and Schwarz no parameter moves by more of its own
standard deviations than ``sqrt(dH^T C^-1 dH)``, summed over all lines: the error over the standard deviation with which
all lines together would tell such a delay.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.units import MILLI

if TYPE_CHECKING:
    from shaftprint.clocks._logger_clock import LoggerClock
    from shaftprint.signals._signals import Signals
    from shaftprint.spectra._frequency_response import FrequencyResponse
    from shaftprint.spectra._spectra import Spectra

NOTABLE_SHIFT = 0.3
"""Shift from which there is a remark: with it a standard deviation is a twentieth too small."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ClockInfluence:
    """What an error of one logger's clock of one standard deviation, the worst in the recording, does."""

    logger: str
    """Name of the logger's file."""
    std_s: float
    """Largest standard deviation of its clock map within the recording [s]."""
    moved: tuple[str, ...]
    """Outputs of the response that it moves against the set point; none where one logger has them all."""
    line: str
    """Highest line that a fit uses."""
    frequency_hz: float
    """Its frequency [Hz]."""
    phase_rad: float
    """By how much it turns the phase of these outputs there [rad]."""
    delay_std_s: float
    """Standard deviation with which all lines together tell a delay of these outputs [s]; infinite where none is
    moved."""

    @property
    def shift(self) -> float:
        """How many of its own standard deviations any parameter moves at most [-]."""
        return self.std_s / self.delay_std_s


def clock_influences(
    clocks: "Sequence[LoggerClock]", *, spectra: "Spectra", signals: "Signals"
) -> tuple[ClockInfluence, ...]:
    """Return what the uncertainty of every merged logger's clock does to the response; nothing if no line is used.

    ``clocks``: clock maps of the recording (see ``logger_clocks``). ``spectra``, ``signals``: what was measured from
    it.
    """
    if not spectra.response.used.any():
        return ()
    channels = _channels(spectra, signals)
    return tuple(_influence(clock, spectra.response, channels) for clock in clocks)


def clock_findings(influences: Sequence[ClockInfluence]) -> tuple[str, ...]:
    """Return a sentence on every clock that is known too badly for the standard deviations of a fit to stand."""
    return tuple(
        f"The clock of {influence.logger} is known to {MILLI * influence.std_s:.3g} ms only: parameters may be off by "
        f"up to {influence.shift:.1f} of their standard deviations, which do not include it; merge by a channel that "
        "shows faster movements, or a longer recording."
        for influence in influences
        if influence.shift > NOTABLE_SHIFT
    )


def _channels(spectra: "Spectra", signals: "Signals") -> dict[str, str]:
    """Return which channel of the recording each input and output of the response comes from."""
    channels = {name: signal.channel for name, signal in signals.channels.items()}
    return channels | {"n": channels[spectra.speed]}


def _influence(clock: "LoggerClock", response: "FrequencyResponse", channels: Mapping[str, str]) -> ClockInfluence:
    def is_own(name: str) -> bool:
        return channels[name] in clock.channels

    moved = tuple(name for name in response.outputs if is_own(name) != is_own(response.inputs[0]))
    line = int(np.flatnonzero(response.used)[-1])
    std_s = clock.alignment.worst_std_s
    return ClockInfluence(
        logger=clock.logger,
        std_s=std_s,
        moved=moved,
        line=response.lines[line],
        frequency_hz=float(response.frequency_hz[line]),
        phase_rad=float(response.omega_rad_s[line]) * std_s if moved else 0.0,
        delay_std_s=_delay_std(response, moved),
    )


def _delay_std(response: "FrequencyResponse", moved: Sequence[str]) -> float:
    """Return with which standard deviation all used lines tell one delay common to some outputs [s]; none: infinite."""
    chosen = np.array([name in moved for name in response.outputs])
    turned = -1j * response.omega_rad_s * response.response[:, 0, :] * chosen[:, None]
    change = np.concatenate([turned.real, turned.imag]).T[response.used]
    weighted = np.linalg.solve(response.covariance[response.used], change[:, :, None])[:, :, 0]
    information = float(np.sum(change * weighted))
    return information**-0.5 if information > 0.0 else math.inf
