"""Arbitrary excitation: the local polynomial method in bands that do not overlap."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import BoolArray, ComplexArray, FloatArray
from shaftprint.errors import ResponseError
from shaftprint.spectra._response_covariance import products, rounding_floor
from shaftprint.spectra.records._excitation import Excitation, LineEstimates
from shaftprint.spectra.records._local_polynomial import Bands, Transform, is_smooth, misfit

if TYPE_CHECKING:
    from shaftprint.spectra.records._records import Records

_FEWEST_SAMPLES = 64
_MOST_SPLITS = 4
# Mean square of the response beside a line over the variance at it, below which the line is lost; 1 is noise alone.
_LEAST_SEEN = 4.0
_LEAST_ALONE = 25.0
_NEIGHBOURS = 2


@dataclass(frozen=True, kw_only=True, slots=True)
class _Band:
    """The band of a line."""

    low_hz: float
    high_hz: float
    smooth: bool
    """Whether a band twice as wide was tested and found smooth."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Arbitrary(Excitation):
    """The inputs move in any way: noise, a chirp, steps, a trapezoid, manual control.

    The Fourier transforms of the records are cut into bands that do not overlap, so that the noise of different lines
    is independent. Each band gives one line in its middle, by the local polynomial method: response and transient are
    polynomials within the band, and the noise is what they leave. A band in which two orders more would find something
    is split, and every band is halved once more, so that what was just not found does not bias the middle: lines stand
    close where the response turns quickly. Splitting costs little, since every bin is used in one line. Details
    narrower than about 14 over the duration of a record cannot be seen: where the response turns as quickly as that,
    the covariance is widened by what two more orders change.

    The inputs are taken as exactly known and must not depend on the noise of the outputs: see ``response_from_arrays``
    for closed loops.
    """

    lines_per_decade: float = 20.0
    """Number of lines in a decade where the response is smooth and the record long enough."""
    lines_hz: Sequence[float] | None = None
    """Frequencies of the lines [Hz], ascending; chosen from the data when not given. Their bands reach half way to the
    next line at most."""
    order: int = 2
    """Order of the polynomials."""

    def __post_init__(self) -> None:
        """Check the numbers.

        Raises ResponseError if the number of lines is not positive, the lines are not positive and ascending, or the
        order is negative.
        """
        if not (np.isfinite(self.lines_per_decade) and self.lines_per_decade > 0.0):
            raise ResponseError(f"lines_per_decade = {self.lines_per_decade}: expected a positive number.")
        if self.order < 0 or self.order != int(self.order):
            raise ResponseError(f"order = {self.order}: expected a whole number, 0 or more.")
        if self.lines_hz is not None:
            lines = np.asarray(self.lines_hz, dtype=np.float64)
            if lines.ndim != 1 or not lines.size or not np.all(lines > 0.0) or not np.all(np.diff(lines) > 0.0):
                raise ResponseError("lines_hz: expected positive, ascending frequencies in Hz.")

    def estimate(self, records: "Records", *, drift: bool, band_hz: tuple[float, float]) -> LineEstimates:
        """Return the responses in the middle of the bands."""
        transforms = tuple(
            _transform(run, values, records.rate_hz, drift=drift) for run, values in enumerate(records.values)
        )
        bands = Bands(transforms=transforms, inputs=len(records.inputs), order=self.order)
        step = min(transform.resolution_hz for transform in transforms)
        limits = max(band_hz[0], 0.5 * step), min(band_hz[1], 0.5 * records.rate_hz)
        if self.lines_hz is None:
            parents = self._parents(bands, limits, step)
            chosen = [band for low, high in parents for band in _split(bands, low, high, _MOST_SPLITS)]
        else:
            chosen = [self._around(bands, line, limits) for line in range(len(self.lines_hz))]
        return _fitted(bands, chosen)

    def _parents(self, bands: Bands, limits: tuple[float, float], step: float) -> list[tuple[float, float]]:
        """Return wide bands: of two lines, or as wide as the fit needs where bins are few."""
        ratio = 10.0 ** (2.0 / self.lines_per_decade)
        low, parents = limits[0], []
        while low < limits[1]:
            high = min(low * ratio, limits[1])
            while high < limits[1] and not bands.wide_enough(low, high):
                high = min(high + step, limits[1])
            if bands.wide_enough(low, high):
                parents.append((low, high))
            low = high
        if not parents:
            raise ResponseError(
                f"found too few frequencies for one line between {limits[0]:g} and {limits[1]:g} Hz, since the records "
                f"last {1.0 / step:g} s at most: record longer, or widen band_hz."
            )
        return parents

    def _around(self, bands: Bands, place: int, limits: tuple[float, float]) -> _Band:
        """Return the band around a chosen line."""
        lines = np.asarray(self.lines_hz, dtype=np.float64)
        middle = float(lines[place])
        nearest = 0.5 * np.diff(lines)[max(place - 1, 0) : place + 1]
        widest = min(middle - limits[0], limits[1] - middle, *nearest)
        half = min(middle * (10.0 ** (1.0 / self.lines_per_decade) - 1.0), widest)
        while half < widest and not bands.wide_enough(middle - half, middle + half):
            half = min(1.1 * half, widest)
        if half <= 0.0 or not bands.wide_enough(middle - half, middle + half):
            raise ResponseError(
                f"line {middle:g} Hz: its band from {middle - widest:g} to {middle + widest:g} Hz, half way to the "
                "next lines or borders, holds too few frequencies of the records: choose fewer lines, or record longer."
            )
        smooth = False
        for _ in range(_MOST_SPLITS + 1):
            if smooth or not bands.wide_enough(middle - 0.5 * half, middle + 0.5 * half):
                break
            smooth = is_smooth(bands, middle - half, middle + half)
            half *= 0.5
        return _Band(low_hz=middle - half, high_hz=middle + half, smooth=smooth)


def _transform(run: int, values: FloatArray, rate_hz: float, *, drift: bool) -> Transform:
    count = values.shape[1]
    if count < _FEWEST_SAMPLES:
        raise ResponseError(f"record {run + 1}: expected at least {_FEWEST_SAMPLES} samples, found {count}.")
    deviation = values - values.mean(axis=1, keepdims=True)
    if drift:
        centred = np.arange(count) - 0.5 * (count - 1)
        deviation -= np.outer(deviation @ centred / (centred @ centred), centred)
    spectrum = np.fft.rfft(deviation, axis=1)[:, 1 : (count + 1) // 2] / np.sqrt(count)
    return Transform(resolution_hz=rate_hz / count, values=spectrum)


def _split(bands: Bands, low: float, high: float, splits: int) -> list[_Band]:
    """Return the bands of lines within a band: both halves, each split again where the whole is not smooth."""
    middle = 0.5 * (low + high)
    if not (bands.wide_enough(low, middle) and bands.wide_enough(middle, high)):
        return [_Band(low_hz=low, high_hz=high, smooth=False)]
    smooth = is_smooth(bands, low, high)
    if smooth or splits == 0:
        halves = ((low, middle), (middle, high))
        return [_Band(low_hz=first, high_hz=last, smooth=smooth) for first, last in halves]
    return _split(bands, low, middle, splits - 1) + _split(bands, middle, high, splits - 1)


def _fitted(bands: Bands, chosen: list[_Band]) -> LineEstimates:
    fits = [(band, bands.fit(band.low_hz, band.high_hz)) for band in chosen]
    identified = [(band, fit) for band, fit in fits if fit.known]
    if not identified:
        raise ResponseError(
            "found no line at which every input moves, apart from the others and from transients: excite the inputs "
            "more, and differently from each other."
        )
    excess = np.array([float(fit.excess) for _, fit in identified])
    noise = np.stack([fit.noise for _, fit in identified]) / excess[:, np.newaxis, np.newaxis]
    power = np.stack([fit.power for _, fit in identified]) / excess[:, np.newaxis]
    response = np.stack([fit.response for _, fit in identified], axis=2)
    spread = products(noise + rounding_floor(power), np.stack([fit.inverse for _, fit in identified]))
    for row, (band, _) in enumerate(identified):
        if not band.smooth:
            spread[row] = _widened(spread[row], misfit(bands, band.low_hz, band.high_hz).reshape(-1))
    variance = np.diagonal(spread, axis1=1, axis2=2).real.T
    return LineEstimates(
        frequency_hz=np.array([0.5 * (band.low_hz + band.high_hz) for band, _ in identified]),
        response=response,
        spread=spread,
        complex_samples=excess,
        lost=~_seen(np.abs(response.reshape(len(variance), -1)) ** 2, variance),
    )


def _widened(spread: ComplexArray, missed: ComplexArray) -> ComplexArray:
    """Return the covariance with a difference between two fits, less what noise alone makes of such a difference."""
    std = np.sqrt(spread.diagonal().real)
    relative = missed / std
    square = np.vdot(relative, np.linalg.solve(spread / np.outer(std, std), relative)).real
    if square <= missed.size:
        return spread
    widened: ComplexArray = spread + (1.0 - missed.size / square) * np.outer(missed, missed.conj())
    return widened


def _seen(power: FloatArray, variance: FloatArray) -> BoolArray:
    """Return where an output shows something of an input, from squared magnitudes and variances (channels, lines).

    What counts is the response beside the line against the noise at it, not the line itself: to keep a line because
    noise has made it large would bias all that is kept. Only what no noise can be stands for itself.
    """
    ratio = power / variance
    seen: BoolArray = np.any(ratio > _LEAST_ALONE, axis=0)
    lines = power.shape[1]
    for line in range(lines):
        first = min(max(line - _NEIGHBOURS, 0), max(lines - 2 * _NEIGHBOURS - 1, 0))
        neighbours = [index for index in range(first, min(first + 2 * _NEIGHBOURS + 1, lines)) if index != line]
        if neighbours:
            mean = ratio[:, neighbours].mean(axis=1)
            level = ratio[:, neighbours].sum(axis=1) / (1.0 / variance[:, neighbours]).sum(axis=1)
            seen[line] |= bool(np.any((mean > _LEAST_SEEN) & (level > _LEAST_SEEN * variance[:, line])))
    return seen
