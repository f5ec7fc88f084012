"""The Fourier transform of a record at the lines that its input excites, with the noise of its outputs."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray, frozen_complex, frozen_float
from shaftprint.errors import SignalError
from shaftprint.spectra._frequency_response import FrequencyResponse
from shaftprint.time_domain._bands import NARROWEST, LineBands, bands_of
from shaftprint.time_domain._record import Record
from shaftprint.transforms import largest_quick_length

# Of the largest power in a share of the frequency, what makes a line excited.
EXCITED = 1e-2
# Lines over which the power of the input is averaged to tell that.
AVERAGED = 25
# Share of the sample rate up to which samples tell what happens between them.
HIGHEST = 0.4
# One over the share of the samples that may be left out for a quick transform.
SHORTENED = 500
# Share of the samples that may be missing, to be filled by straight lines.
MOST_MISSING = 0.005


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Spectrum:
    """Excited lines of a record, transforms over the root of the number of samples."""

    record: Record
    """What was transformed."""
    frequency_hz: FloatArray
    """Frequency of each line [Hz], all multiples of the first resolvable one between two borders, shape (lines,)."""
    source: ComplexArray
    """Transform of the input, shape (lines,)."""
    outputs: ComplexArray
    """Transforms of the outputs, in the order of ``names``, shape (outputs, lines)."""
    names: tuple[str, ...]
    """Names of the outputs."""
    noise: ComplexArray
    """Covariance of the noise ``E[V V^H]`` at each line, right as a weight, shape (lines, outputs, outputs)."""
    bands: LineBands
    """The lines in bands."""
    outside: FloatArray
    """Square sum of each output at all other lines but zero: noise, and what no line of the input explains; shape
    (outputs,)."""

    def response(self, input_name: str, *, most: int | None = None) -> FrequencyResponse:
        """Return the response in the middle of the bands, without leakage.

        ``most``: number of bands to keep, denser at low frequency, where a search needs them; all if not given.
        """
        bands = self.bands
        if most is not None and most < bands.middle.size:
            bands = bands.chosen(np.unique(np.geomspace(1.0, bands.middle.size, most).round().astype(np.int64)) - 1)
        weight = (bands.weight_factor * bands.spread)[:, None, None] * bands.noise
        real = np.concatenate([weight.real, -weight.imag], axis=2), np.concatenate([weight.imag, weight.real], axis=2)
        step = self.frequency_hz[1] - self.frequency_hz[0]
        return FrequencyResponse(
            frequency_hz=self.frequency_hz[0] + step * bands.middle,
            response=bands.response.T[:, None, :],
            covariance=0.5 * np.concatenate(real, axis=1),
            inputs=(input_name,),
            outputs=self.names,
            degrees_of_freedom=2.0 * bands.samples,
            load=np.full(bands.middle.size, self.record.load),
            averaging_s=self.record.averaging_s,
            hold_s=self.record.hold_s,
            pick_up_delay_s=self.record.pick_up_delay_s,
        )


def spectrum_of(
    record: Record, input_name: str, output_names: Sequence[str], *, band_hz: tuple[float, float] | None = None
) -> Spectrum:
    """Transform a record and find the noise of its outputs from the lines themselves.

    Parameters
    ----------
    band_hz
        Lowest and highest frequency to use [Hz]; where the input is strong for its frequency if not given.

    Raises
    ------
    SignalError
        If the record lacks a channel or too many samples, or the band holds too few lines.
    """
    missing = [n for n in (input_name, *output_names) if n not in {**record.inputs, **record.outputs}]
    if missing:
        raise SignalError(
            f"record {record.name}: expected channels {input_name}, {', '.join(output_names)}, found "
            f"{', '.join((*record.inputs, *record.outputs))}."
        )
    # the first samples are left out for it, one in five hundred at most
    count = record.samples - 1
    length = largest_quick_length(count, max(count - count // SHORTENED, 1))
    channels = np.stack([record.inputs[input_name], *(_filled(record, name) for name in output_names)])
    transformed = _transformed(channels[:, record.samples - 1 - length :])
    step = record.rate_hz / length
    first, stop = _borders(record, transformed[0], step, band_hz)
    lines = slice(first, stop)
    outputs = transformed[1:, lines]
    bands = bands_of(transformed[0, lines], outputs)
    # lines of positive frequency stand for those of negative frequency too
    everything = 2.0 * np.sum(np.abs(transformed[1:, 1:]) ** 2, axis=1)
    return Spectrum(
        record=record,
        frequency_hz=frozen_float(step * np.arange(first, stop)),
        source=frozen_complex(transformed[0, lines]),
        outputs=frozen_complex(outputs),
        names=tuple(output_names),
        noise=frozen_complex(bands.at_lines(stop - first)),
        bands=bands,
        outside=frozen_float(np.maximum(everything - 2.0 * np.sum(np.abs(outputs) ** 2, axis=1), 0.0)),
    )


def _transformed(values: FloatArray) -> ComplexArray:
    """Return the transforms over the time from the first sample to the last, by the trapezoidal rule."""
    periodic = values[:, :-1].copy()
    periodic[:, 0] = 0.5 * (values[:, 0] + values[:, -1])
    return np.asarray(np.fft.rfft(periodic, axis=1) / np.sqrt(periodic.shape[1]))


def _filled(record: Record, name: str) -> FloatArray:
    """Return an output with its few gaps filled by straight lines."""
    lost = int(np.sum(~record.used))
    if not lost:
        return record.outputs[name]
    if lost > MOST_MISSING * record.samples:
        raise SignalError(
            f"record {record.name}: expected a record without gaps, found {lost} of {record.samples} samples unused; "
            "cut the record beside the gap, or fit it in time."
        )
    sample = np.arange(record.samples)
    return np.interp(sample, sample[record.used], record.outputs[name][record.used])


def _borders(
    record: Record, source: ComplexArray, step_hz: float, band_hz: tuple[float, float] | None
) -> tuple[int, int]:
    """Return the first line and the one after the last."""
    top = min(int(HIGHEST * record.rate_hz / step_hz), source.size - 1)
    if band_hz is not None:
        first, last = max(int(np.ceil(band_hz[0] / step_hz - 1e-9)), 1), min(int(band_hz[1] / step_hz + 1e-9), top)
    else:
        power = np.abs(source[: top + 1]) ** 2 * np.arange(top + 1)
        sums = np.concatenate([[0.0], np.cumsum(power)])
        low = np.maximum(np.arange(top + 1) - AVERAGED, 0)
        high = np.minimum(np.arange(top + 1) + AVERAGED + 1, top + 1)
        level = (sums[high] - sums[low]) / (high - low)
        strong = np.flatnonzero(level > EXCITED * level.max())
        first, last = max(int(strong[0]), 1), int(strong[-1])
    if last - first + 1 < NARROWEST:
        raise SignalError(
            f"record {record.name}: expected at least {NARROWEST} excited lines, {step_hz:.3g} Hz apart, found "
            f"{max(last - first + 1, 0)}; record longer, or widen band_hz."
        )
    return first, last + 1
