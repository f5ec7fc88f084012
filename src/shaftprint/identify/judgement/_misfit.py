"""Does the structure explain the data, and if not, where not."""

from typing import Protocol, runtime_checkable

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.judgement._phrases import probability, spans
from shaftprint.identify.likelihood._fitted_response import FittedResponse, channel_names, channels_of
from shaftprint.identify.likelihood._load_factors import load_factors

# Below this probability a fit is rejected, and a line where it is that of the worst of all lines (Bonferroni).
REJECTED = 0.01
# Without weights: how many times what the noise leaves may be left.
UNWEIGHTED_EXCESS = 2.0
# Of a record: parts and bands that are looked at, and how much more than others one that is named has.
PARTS, ABOVE = 20, 1.5
# A channel is named when its squared deviations are this many times those of every other.
STANDS_OUT = 3.0


def explained(identification: Identification, *, rejected: float = REJECTED) -> bool:
    """Return whether the structure explains the data within their noise.

    Weighted by the covariance, the whole must not be rejected, nor any single line against the worst of as many lines.
    Without weights, no output may miss more than twice what noise alone would: that is coarse.

    ``rejected``: probability below which a fit or line is rejected.
    """
    if not identification.is_likelihood:
        return all(
            100.0 - percent <= UNWEIGHTED_EXCESS * (100.0 - ceiling)
            for part in identification.parts
            for percent, ceiling in zip(part.fit_percent.values(), part.fit_ceiling.values(), strict=True)
        )
    p_value = identification.p_value
    return (p_value is None or p_value >= rejected) and not worst_lines(identification, rejected=rejected)


def worst_lines(identification: Identification, *, rejected: float = REJECTED) -> tuple[str, ...]:
    """Return the names of the lines of the first response that lie farther off than the worst of as many may.

    Where the first of the fitted data are records, those that do.
    """
    lines = identification.line_tests
    return tuple(line.name for line in lines if line.experiment == 0 and line.p_value * len(lines) < rejected)


def misfit_words(identification: Identification) -> str:
    """Return where the misfit is largest: in which channel, at which lines."""
    worst = worst_lines(identification)
    if not worst:
        return "the misfit is spread over all lines"
    if not isinstance(identification.parts[0], FittedResponse):
        named = {part.name: part for part in identification.parts if isinstance(part, LeavesResiduals)}
        told = [f"{name}{_in_record(named[name]) if name in named else ''}" for name in worst]
        return f"the misfit is largest in {'; '.join(told)}"
    response = identification.response
    places = [response.lines.index(name) for name in worst]
    omega = response.omega_rad_s[places]
    band = f"{omega[0]:.2g} rad/s" if len(worst) == 1 else f"{omega[0]:.2g} to {omega[-1]:.2g} rad/s"
    channel = _standing_out(identification, places)
    where = f"in {channel} " if channel else ""
    # the whole may look well: then the reader must see what does not
    chance = next(line.p_value for line in identification.line_tests if line.name == worst[0])
    alone = f", {probability(chance)} by itself" if len(worst) == 1 else ""
    return f"the misfit is largest {where}at {spans(worst, response.lines)} ({band}){alone}"


@runtime_checkable
class LeavesResiduals(Protocol):
    """Data in time: what a fit leaves of them, made white."""

    @property
    def name(self) -> str:
        """What messages call the data."""

    @property
    def whitened(self) -> FloatArray:
        """Residuals of the used samples, shape (used samples, outputs)."""

    @property
    def used_s(self) -> FloatArray:
        """When these are [s], shape (used samples,)."""

    @property
    def output_names(self) -> tuple[str, ...]:
        """Names of the outputs."""


def _in_record(part: LeavesResiduals) -> str:
    """Return where in a record the misfit is: in which output, and when or at which frequencies; empty where nowhere.

    What is left is white with a power of 1 where the structure holds.
    """
    squares = part.whitened**2
    order = np.argsort(squares.sum(axis=0))
    output = int(order[-1])
    stands_out = len(order) > 1 and squares[:, output].sum() > ABOVE * squares[:, order[-2]].sum()
    words = f", in {part.output_names[output]}" if stands_out else ""
    parts = np.array_split(squares[:, output], PARTS)
    power = np.array([one.mean() if one.size else 0.0 for one in parts])
    worst = int(np.argmax(power))
    if power[worst] > STANDS_OUT * np.median(power):
        first = sum(one.size for one in parts[:worst])
        times = part.used_s[[first, first + parts[worst].size - 1]]
        return f"{words}, from {times[0]:.3g} to {times[1]:.3g} s"
    spectrum = np.abs(np.fft.rfft(part.whitened[:, output])[1:]) ** 2
    bands = np.array_split(spectrum, PARTS)
    power = np.array([one.mean() if one.size else 0.0 for one in bands])
    worst = int(np.argmax(power))
    if power[worst] <= ABOVE * np.median(power):
        return words
    rate_hz = 1.0 / float(np.median(np.diff(part.used_s)))
    width_hz = 0.5 * rate_hz / PARTS
    return f"{words}, between {width_hz * worst:.3g} and {width_hz * (worst + 1):.3g} Hz"


def _standing_out(identification: Identification, places: list[int]) -> str:
    """Return the channel that is farther off than all others at some lines; nothing where none is or there is one."""
    squares = _squares(identification)[:, places].sum(axis=1)
    order = np.argsort(squares)
    if squares.size == 1 or squares[order[-1]] < STANDS_OUT * squares[order[-2]]:
        return ""
    return channel_names(identification.response)[int(order[-1])]


def _squares(identification: Identification) -> FloatArray:
    """Return the squared deviation of each channel at each line over its variance, shape (channels, lines)."""
    response = identification.response
    values, s = identification.structure_values(), 1j * response.omega_rad_s
    gap = channels_of(response) - identification.structure.response(
        values, s, factors=load_factors(identification.structure, response)
    )
    variance = np.diagonal(response.covariance, axis1=1, axis2=2).T
    half = gap.shape[0]
    return np.asarray(gap.real**2 / variance[:half] + gap.imag**2 / variance[half:])
