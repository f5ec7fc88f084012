"""Signal-to-noise ratios of every line and channel (thesis section 3.3.2)."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray, frozen_float

NEIGHBOUR_BINS = 20
"""Number of DFT bins on each side of a line that count as its local noise."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class SignalToNoise:
    """Local and overall signal-to-noise ratios (thesis tables 3.6 and 3.7)."""

    lines: tuple[str, ...]
    """Names of the lines."""
    channels: tuple[str, ...]
    """Names of the channels: ``n_set``, every speed sensor, ``M_s``, and ``X`` where it was logged."""
    local_db: FloatArray
    """``10 log10(Var(line) / Var(20 bins on each side))`` [dB], thesis eq. 3.10, shape (lines, channels); not a number
    where a channel does not show the line."""
    overall: FloatArray
    """``sqrt(sum Var(line) / sum Var(everything))`` over all windows [-] in which a channel shows the line, thesis
    eq. 3.9, shape (channels,)."""

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        object.__setattr__(self, "local_db", frozen_float(self.local_db))
        object.__setattr__(self, "overall", frozen_float(self.overall))

    def with_lines_of(self, others: Sequence["SignalToNoise"]) -> "SignalToNoise":
        """Return the ratios with those of further lines of the same channels; overall ratios stay these."""
        return replace(
            self,
            lines=(*self.lines, *(line for other in others for line in other.lines)),
            local_db=np.concatenate([self.local_db, *(other.local_db for other in others)]),
        )


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LineVariances:
    """Variances of one window, channel by channel, in squared units of the channels."""

    signal: FloatArray
    """Variance of the line, half its squared amplitude, shape (channels,)."""
    local: FloatArray
    """Variance of the residual in the bins beside the line, shape (channels,)."""
    overall: FloatArray
    """Variance of all samples about their mean, shape (channels,)."""

    @property
    def local_db(self) -> FloatArray:
        """Local signal-to-noise ratio [dB], shape (channels,), at most 300 dB."""
        tiny = np.finfo(np.float64).tiny
        local = np.maximum(self.local, 1e-30 * self.signal + tiny)
        ratio_db: FloatArray = 10.0 * np.log10(np.maximum(self.signal, tiny) / local)
        return ratio_db


def line_variances(
    amplitude: ComplexArray, values: FloatArray, spectrum: ComplexArray, *, periods: int
) -> LineVariances:
    """Return the variances of one window.

    ``amplitude``: complex amplitude of the line, shape (channels,). ``values``: all samples of the window, shape
    (channels, samples). ``spectrum``: Fourier amplitudes of the residual, shape (channels, bins). ``periods``: bin of
    the line. Returns variances of the line, of its neighbours and of everything. A line of fewer than 20 periods has
    fewer neighbours below it; the mean is not one of them.
    """
    lowest = max(1, periods - NEIGHBOUR_BINS)
    power = 0.5 * np.abs(spectrum[:, lowest : periods + NEIGHBOUR_BINS + 1]) ** 2
    power[:, periods - lowest] = 0.0
    return LineVariances(
        signal=0.5 * np.abs(amplitude) ** 2,
        local=power.sum(axis=1),
        overall=values.var(axis=1),
    )


def signal_to_noise(
    variances: Sequence[LineVariances], *, lines: tuple[str, ...], channels: tuple[str, ...]
) -> SignalToNoise:
    """Collect the ratios of all windows (thesis eqs 3.9 and 3.10).

    Parameters
    ----------
    variances
        One entry a line.
    lines
        Names of the lines.
    channels
        Names of the channels.

    Returns
    -------
    The table; a channel that never moves has an overall ratio of 0.
    """
    signal = np.nansum([line.signal for line in variances], axis=0)
    overall = np.nansum([line.overall for line in variances], axis=0)
    return SignalToNoise(
        lines=lines,
        channels=channels,
        local_db=np.stack([line.local_db for line in variances]),
        # a window of whole periods is not one of whole samples: without noise the ratio may exceed 1 by a sample
        overall=np.sqrt(np.minimum(signal / np.maximum(overall, np.finfo(np.float64).tiny), 1.0)),
    )
