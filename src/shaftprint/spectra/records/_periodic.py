"""Periodic excitation: means over whole periods, and the scatter between them as the noise."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import BoolArray, ComplexArray, FloatArray, IntArray
from shaftprint.errors import ResponseError
from shaftprint.spectra._response_covariance import products, rounding_floor
from shaftprint.spectra.lines._noise import Neighbours, equivalent_samples, levelled
from shaftprint.spectra.records._excitation import Excitation, LineEstimates

if TYPE_CHECKING:
    from shaftprint.spectra.records._records import Records

# At five standard deviations of the input's noise, terms of second order add 8 % to the variance of the response.
_LEAST_INPUT_STD = 5.0
_LEAST_INPUT_SHARE = 1e-4
_LEVEL_REACH = 10
_LEAST_LEVEL_REACH = 5
_FEWEST_SAMPLES_A_PERIOD = 4


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Spectrum:
    """Fourier coefficients of whole periods, times the root of their number: with the noise of one period."""

    periods: int
    lines: ComplexArray
    """At multiples of the period's frequency, shape (lines, channels)."""
    beside: ComplexArray
    """Between them, where there is noise alone, shape (channels, bins)."""
    beside_place: FloatArray
    """Place of those bins in multiples of the period's frequency, shape (bins,)."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Periodic(Excitation):
    """The inputs repeat themselves: a multisine, repeated steps, a repeated trapezoid.

    Each record is cut into whole periods after its settling periods. The mean over periods is the response's, their
    scatter its noise, that of measured inputs and its correlation with the outputs included (Pintelon and Schoukens,
    "System Identification: A Frequency Domain Approach", chapter on non-parametric noise models from periodic
    excitation). Noise needs no settled phase between records, and several inputs need as many records, in which they
    are moved differently (for two inputs, for instance, the second with its sign changed).

    Only lines are taken at which every input stands five standard deviations of its noise above zero and has at least
    1e-4 of its strongest amplitude.
    """

    period_s: float
    """Period [s]; a whole number of samples."""
    settling_periods: int = 1
    """Periods at the beginning of every record that still hold transients, and are left out."""
    lines_hz: Sequence[float] | None = None
    """Frequencies to take [Hz], multiples of ``1 / period_s``; all excited ones when not given."""
    between_records: bool = False
    """Take the scatter between records, not between periods, as the noise: of records that differ in the phases of
    their lines, what friction or another nonlinearity adds then counts as noise."""

    def __post_init__(self) -> None:
        """Check the numbers.

        Raises ResponseError if the period is not positive, or the number of settling periods is negative or not whole.
        """
        if not (np.isfinite(self.period_s) and self.period_s > 0.0):
            raise ResponseError(f"period_s = {self.period_s}: expected a positive, finite time in seconds.")
        if self.settling_periods < 0 or self.settling_periods != int(self.settling_periods):
            raise ResponseError(f"settling_periods = {self.settling_periods}: expected a whole number, 0 or more.")

    def estimate(self, records: "Records", *, drift: bool, band_hz: tuple[float, float]) -> LineEstimates:
        """Return the responses at the excited lines."""
        inputs = len(records.inputs)
        runs = len(records.values)
        if runs < inputs:
            raise ResponseError(
                f"{inputs} inputs: expected at least {inputs} records in which they are moved differently, found "
                f"{runs}; without a known period use Arbitrary()."
            )
        if self.between_records and runs <= inputs:
            raise ResponseError(
                f"between_records: expected more records than inputs, found {runs} for {inputs}: leave it out."
            )
        length = self._samples_a_period(records.rate_hz)
        periods = [self._whole_periods(run, values, length, drift=drift) for run, values in enumerate(records.values)]
        frequency: FloatArray = np.arange(1.0, (length + 1) // 2) * (records.rate_hz / length)
        return self._combined([_spectrum(values) for values in periods], inputs, frequency, band_hz)

    def _samples_a_period(self, rate_hz: float) -> int:
        exact = self.period_s * rate_hz
        if abs(exact - round(exact)) > 1e-6 * exact:
            raise ResponseError(
                f"period_s = {self.period_s:g}: expected a whole number of samples at {rate_hz:g} Hz, found "
                f"{exact:.8g}: give several periods as one, or resample."
            )
        if round(exact) < _FEWEST_SAMPLES_A_PERIOD:
            raise ResponseError(
                f"period_s = {self.period_s:g}: expected at least {_FEWEST_SAMPLES_A_PERIOD} samples a period, found "
                f"{round(exact)} at {rate_hz:g} Hz."
            )
        return round(exact)

    def _whole_periods(self, run: int, values: FloatArray, length: int, *, drift: bool) -> FloatArray:
        """Return the samples of whole periods after settling, shape (channels, periods, samples)."""
        least = 1 if self.between_records and not drift else 2
        periods = values.shape[1] // length - self.settling_periods
        if periods < least:
            raise ResponseError(
                f"record {run + 1}: expected at least {least} whole period{'s' * (least > 1)} of {self.period_s:g} s "
                f"after {self.settling_periods} settling, found {max(periods, 0)} in {values.shape[1]} samples."
            )
        begin = self.settling_periods * length
        samples = values[:, begin : begin + periods * length].reshape(-1, periods, length)
        if drift:
            centred = np.arange(periods) - 0.5 * (periods - 1)
            slope = samples.mean(axis=2) @ centred / (centred @ centred * length)
            samples = samples - (centred[:, np.newaxis] * length + np.arange(length)) * slope[:, np.newaxis, np.newaxis]
        return samples

    def _places(self, frequency: FloatArray, excited: BoolArray, band_hz: tuple[float, float]) -> IntArray:
        """Return the bins of the lines to take."""
        if self.lines_hz is None:
            places = np.flatnonzero(excited & (frequency >= band_hz[0]) & (frequency <= band_hz[1]))
            if not places.size:
                raise ResponseError(
                    f"found no line between {band_hz[0]:g} and {band_hz[1]:g} Hz at which the inputs stand above their "
                    "noise, differently in each record: excite them more, or check period_s."
                )
            return places
        order = np.round(np.asarray(self.lines_hz) * self.period_s).astype(np.int64)
        for line, number in zip(self.lines_hz, order, strict=True):
            if abs(line * self.period_s - number) > 1e-3 or not 1 <= number <= frequency.size:
                raise ResponseError(
                    f"line {line:g} Hz: expected a multiple of {1.0 / self.period_s:g} Hz, below "
                    f"{(frequency.size + 1) * frequency[0]:g} Hz."
                )
            if not excited[number - 1]:
                raise ResponseError(
                    f"line {line:g} Hz: the input does not stand above its noise there, or is the same in each record: "
                    "leave the line out."
                )
        return np.unique(order) - 1

    def _combined(
        self, spectra: list[_Spectrum], inputs: int, frequency: FloatArray, band_hz: tuple[float, float]
    ) -> LineEstimates:
        mean = np.stack([spectrum.lines for spectrum in spectra], axis=2)
        excited = _excited(mean[:, :inputs], _level(spectra)[:, :inputs])
        places = self._places(frequency, excited, band_hz)
        u, y = mean[places, :inputs], mean[places, inputs:]
        gram = mean[places] @ _adjoint(u)
        between_lines = np.concatenate([spectrum.beside for spectrum in spectra], axis=1)
        if between_lines.size:
            where = np.concatenate([spectrum.beside_place for spectrum in spectra]) * frequency[0]
            order = np.argsort(where, kind="stable")
            fewest = sum(spectrum.periods - 1 for spectrum in spectra)
            noise, samples = pooled_noise(between_lines[:, order], where[order], frequency[places], fewest=fewest)
            # products of noisy means hold their noise; as many records as inputs fit exactly, without such an error
            gram -= (len(spectra) - inputs) * noise[:, :, :inputs]
        inverse: ComplexArray = np.asarray(np.linalg.inv(gram[:, :inputs]), dtype=np.complex128)
        response = gram[:, inputs:] @ inverse
        if self.between_records:
            residual = _without_inputs(y, u)
            where = np.repeat(frequency[places], len(spectra) - inputs)
            error, samples = pooled_noise(residual, where, frequency[places], fewest=len(spectra) - inputs)
        else:
            outputs = y.shape[1]
            identity = np.broadcast_to(np.eye(outputs), (places.size, outputs, outputs))
            change = np.concatenate([-response, identity], axis=2)
            error = change @ noise @ _adjoint(change)
        error = error + rounding_floor((np.abs(y) ** 2).sum(axis=2))
        return LineEstimates(
            frequency_hz=frequency[places],
            response=np.moveaxis(response, 0, 2),
            spread=products(error, inverse.conj()),
            complex_samples=samples,
            lost=np.zeros(places.size, dtype=np.bool_),
        )


def _spectrum(whole: FloatArray) -> _Spectrum:
    channels, periods, length = whole.shape
    lines = (length + 1) // 2 - 1
    bins = np.fft.rfft(whole.reshape(channels, -1), axis=1)[:, : (periods * length + 1) // 2]
    bins /= length * np.sqrt(periods)
    number = np.arange(bins.shape[1])
    between = number % periods != 0
    return _Spectrum(
        periods=periods,
        lines=bins[:, periods : (lines + 1) * periods : periods].T,
        beside=bins[:, between],
        beside_place=number[between] / periods,
    )


def _adjoint(matrices: ComplexArray) -> ComplexArray:
    adjoint: ComplexArray = np.swapaxes(matrices.conj(), 1, 2)
    return adjoint


def _without_inputs(y: ComplexArray, u: ComplexArray) -> ComplexArray:
    """Return what the inputs leave of the outputs, shape (outputs, lines times (runs - inputs))."""
    null_space = np.linalg.qr(_adjoint(u), mode="complete").Q[:, :, u.shape[1] :]
    residual: ComplexArray = np.moveaxis(y @ null_space, 0, 1).reshape(y.shape[1], -1)
    return residual


def _excited(u: ComplexArray, noise: FloatArray) -> BoolArray:
    """Return where every input stands above its noise and apart from the others, shape (lines,)."""
    gram = u @ _adjoint(u)
    power = np.diagonal(gram, axis1=1, axis2=2).real
    least = np.maximum(_LEAST_INPUT_STD**2 * u.shape[2] * noise, _LEAST_INPUT_SHARE**2 * power.max(axis=0))
    scaled = gram / np.sqrt(least[:, :, np.newaxis] * least[:, np.newaxis])
    excited: BoolArray = np.linalg.eigvalsh(scaled)[:, 0] > 1.0
    return excited


def _level(spectra: list[_Spectrum]) -> FloatArray:
    """Return the level of the noise near every line, shape (lines, channels); 0 from single periods.

    The mean of logarithms over ten lines on each side does not bend where noise falls steeply with frequency.
    """
    lines, channels = spectra[0].lines.shape
    power = np.zeros((lines, channels))
    for spectrum in spectra:
        below = spectrum.beside[:, : lines * (spectrum.periods - 1)].reshape(channels, lines, -1)
        power += np.add.reduce(np.abs(below) ** 2, axis=2).T
    count = sum(spectrum.periods - 1 for spectrum in spectra)
    if not count:
        return power
    log = np.log(power / count + np.finfo(np.float64).tiny)
    total = np.concatenate([np.zeros((1, channels)), np.cumsum(log, axis=0)])
    line = np.arange(lines)
    reach = np.clip(np.minimum(line, lines - 1 - line), _LEAST_LEVEL_REACH, _LEVEL_REACH)
    first, stop = np.maximum(line - reach, 0), np.minimum(line + reach + 1, lines)
    mean = (total[stop] - total[first]) / (stop - first)[:, np.newaxis]
    # the logarithm of a mean of so many squared magnitudes lies this much below that of its expectation
    level: FloatArray = np.exp(mean + 0.5 / count + 1.0 / (12.0 * count**2))
    return level


_FEWEST_SAMPLES = 12
_SAMPLES_A_CHANNEL = 3
# Within this distance in octaves times ln 2, noise is taken as flat: at a slope of f^-2 it errs by less than 1 %.
_FLAT = 0.1


def pooled_noise(
    samples: ComplexArray, frequency_hz: FloatArray, lines_hz: FloatArray, *, fewest: int
) -> tuple[ComplexArray, FloatArray]:
    """Return the covariance of the noise at lines, with the number of complex samples behind each.

    The samples nearest to a line are averaged as a matrix; where they reach far in terms of octaves, each channel is
    brought to the line first by the slope ``S ~ f^-a`` found among them.

    ``samples``: independent complex samples of the noise, shape (channels, samples). ``frequency_hz``: frequency of
    each sample [Hz], ascending, shape (samples,). ``lines_hz``: frequency of each line [Hz], shape (lines,).
    ``fewest``: number of samples to take; never less than 12, nor than three a channel, where there are so many.
    Returns ``E[e e^H]``, shape (lines, channels, channels), and the number of complex samples, shape (lines,).
    """
    channels, total = samples.shape
    count = min(max(fewest, _FEWEST_SAMPLES, _SAMPLES_A_CHANNEL * channels), total)
    middle = (np.searchsorted(frequency_hz, lines_hz) + np.searchsorted(frequency_hz, lines_hz, side="right")) // 2
    first = np.clip(middle - count // 2, 0, total - count)
    covariance = np.empty((lines_hz.size, channels, channels), dtype=np.complex128)
    number = np.full(lines_hz.size, float(count))
    for line, (start, line_hz) in enumerate(zip(first, lines_hz, strict=True)):
        near = slice(start, start + count)
        chosen, frequency = samples[:, near], frequency_hz[near]
        log_ratio = np.log(frequency / line_hz)
        if np.abs(log_ratio).max() > _FLAT:
            neighbours = Neighbours(bins=frequency, log_ratio=log_ratio, weight=np.ones(count))
            chosen = levelled(chosen, neighbours)
            number[line] = equivalent_samples(neighbours)
        covariance[line] = chosen @ chosen.conj().T / count
    return covariance, number
