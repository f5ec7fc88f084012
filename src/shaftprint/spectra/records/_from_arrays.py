"""From plain arrays of any drive to a frequency response with covariance, in one call."""

from collections.abc import Sequence

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import ResponseError
from shaftprint.spectra._frequency_response import FrequencyResponse
from shaftprint.spectra._response_covariance import real_covariance, weight_factor
from shaftprint.spectra.records._arbitrary import Arbitrary
from shaftprint.spectra.records._excitation import Excitation
from shaftprint.spectra.records._records import Channels, read_records

_LOST = "noise is larger than what the input does here"


def response_from_arrays(
    inputs: Channels | Sequence[Channels],
    outputs: Channels | Sequence[Channels],
    rate_hz: float,
    *,
    excitation: Excitation | None = None,
    drift: bool = False,
    band_hz: tuple[float, float] | None = None,
) -> FrequencyResponse:
    """Estimate the response from inputs to outputs, with its covariance, from measured time series.

    The means of all channels count as the working point: the response is that of deviations from it, in the units of
    the arrays. It goes from samples to samples: where a computer holds each value of the input until the next one, the
    hold is in the response (about half a sample of delay) and belongs into the structure that is fitted to it.

    In a closed loop the input of the plant reacts to the noise of the output, and the direct way from the one to the
    other is biased. Give what moves the loop from outside (the reference) as the input, the plant's input and output
    both as outputs, and hand the result to ``plant_from_closed_loop``. The same helps where the input of the plant is
    measured with noise.

    Parameters
    ----------
    inputs, outputs
        Samples by channel name, such as ``{"voltage": u}`` and ``{"speed": w, "current": i}``; for several runs lists
        of such mappings, one a run, whose lengths may differ.
    rate_hz
        Sample rate of all channels [Hz].
    excitation
        ``Periodic(period_s=...)`` where the inputs repeat themselves, which is the most accurate; ``Arbitrary()``, also
        when not given, for noise, chirps, steps and everything else.
    drift
        Whether to take a straight line out of every channel.
    band_hz
        Lowest and highest frequency of lines [Hz]; up to half of the sample rate when not given.

    Returns
    -------
    The response at the excited lines. Lines at which nothing of the inputs is seen in the outputs are marked as not
    used, with a remark; lines at which an input is still altogether are left out.

    Raises
    ------
    ResponseError
        If the rate is not positive, channels do not belong together, hold values that are not finite or do not move,
        the band is empty, the records are too short, or no line is excited.
    """
    records = read_records(inputs, outputs, rate_hz)
    band = band_hz or (0.0, 0.5 * records.rate_hz)
    if not 0.0 <= band[0] < band[1]:
        raise ResponseError(f"band_hz = {band[0]:g} to {band[1]:g}: expected ascending frequencies in Hz, 0 or more.")
    estimates = (excitation or Arbitrary()).estimate(records, drift=drift, band_hz=band)
    factor = np.array([weight_factor(float(n), len(records.outputs)) for n in estimates.complex_samples])
    covariance = real_covariance(factor[:, np.newaxis, np.newaxis] * estimates.spread)
    names = _line_names(estimates.frequency_hz)
    return FrequencyResponse(
        frequency_hz=estimates.frequency_hz,
        response=estimates.response,
        covariance=0.5 * (covariance + np.swapaxes(covariance, 1, 2)),
        inputs=records.inputs,
        outputs=records.outputs,
        lines=names,
        degrees_of_freedom=2.0 * estimates.complex_samples,
        used=~estimates.lost,
        remarks={name: _LOST for name, lost in zip(names, estimates.lost, strict=True) if lost},
    )


def _line_names(frequency_hz: FloatArray) -> tuple[str, ...]:
    """Return the frequencies as names, with as many digits as tell them apart."""
    for digits in range(4, 17):
        names = tuple(f"{frequency:.{digits}g} Hz" for frequency in frequency_hz)
        if len(set(names)) == len(names):
            break
    return names
