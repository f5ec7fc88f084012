"""Confidence bands around the response of a model, pointwise: each frequency and time has its own coverage.

For a model ``H(theta)`` the exact derivatives give ``d ln H = (dH / d theta) / H``: the real part is the relative
change of the magnitude, the imaginary part the change of the phase [rad]. With the covariance ``C`` of the free
parameters (delta method)

    var(ln |H|) = Re(d ln H) C Re(d ln H)^T,     var(arg H) = Im(d ln H) C Im(d ln H)^T,

and for the step response ``y(t)``, whose derivatives are exact too, ``var(y) = (dy / d theta) C (dy / d theta)^T``.
From the repeats of a bootstrap a band holds the middle share of their responses instead.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from shaftprint.arrays import ComplexArray, FloatArray, frozen_float
from shaftprint.distributions import deviations
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.uncertainty._bootstrap import Bootstrap
from shaftprint.identify.uncertainty._parameter_spread import ParameterSpread, spread_of
from shaftprint.models._step_response import step_response
from shaftprint.models._structure import Structure
from shaftprint.units import PERCENT, decibel

DECIBEL_PER_NEPER = 20.0 / np.log(10.0)
COVERAGE = 0.95


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ResponseBand:
    """A band around a frequency response; its ends are not a number where the data do not fix the response."""

    coverage: float
    """Share of tests whose band holds the true value, at each frequency."""
    frequency_hz: FloatArray
    """Frequencies [Hz], shape (frequencies,)."""
    magnitude_db: FloatArray
    """Magnitude of the model [dB], shape (channels, frequencies)."""
    magnitude_lower_db: FloatArray
    """Lower end of the magnitude [dB], shape (channels, frequencies)."""
    magnitude_upper_db: FloatArray
    """Upper end of the magnitude [dB], shape (channels, frequencies)."""
    phase_deg: FloatArray
    """Phase of the model, unwrapped along the frequencies [deg], shape (channels, frequencies)."""
    phase_lower_deg: FloatArray
    """Lower end of the phase [deg], shape (channels, frequencies)."""
    phase_upper_deg: FloatArray
    """Upper end of the phase [deg], shape (channels, frequencies)."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class StepBand:
    """A band around the response to a step of 1; its ends are not a number where the data do not fix the response."""

    coverage: float
    """Share of tests whose band holds the true value, at each time."""
    time_s: FloatArray
    """Time after the step [s], shape (times,)."""
    value: FloatArray
    """Response of the model, shape (channels, times)."""
    lower: FloatArray
    """Lower end, shape (channels, times)."""
    upper: FloatArray
    """Upper end, shape (channels, times)."""


def response_band(
    identification: Identification,
    frequency_hz: ArrayLike,
    *,
    coverage: float = COVERAGE,
    experiment: int = 0,
    repeats: Bootstrap | None = None,
) -> ResponseBand:
    """Return the band around the fitted frequency response.

    ``frequency_hz``: frequencies [Hz], ascending, shape (frequencies,). ``coverage``: share of tests whose band shall
    hold the true value, between 0 and 1. ``experiment``: number of the experiment of a joint fit, from 0. ``repeats``:
    a bootstrap of the identification: the band is taken from its repeats, and follows the curvature of the model.
    Raises IdentificationError if there is no experiment of that number.
    """
    spread = spread_of(identification, experiment)
    if repeats is None:
        return _first_order(spread, frequency_hz, coverage)
    frequency = np.atleast_1d(np.asarray(frequency_hz, dtype=np.float64))
    s = 2j * np.pi * frequency
    middle = spread.structure.response(spread.values, s)
    rows = identification.objective.complete(repeats.values)
    drawn = spread.structure.response(identification.objective.terms[experiment].structure_values(rows), s)
    magnitude = _middle_share(decibel(np.abs(drawn)) - decibel(np.abs(middle)), coverage)
    return _band(coverage, frequency, middle, magnitude, _middle_share(np.degrees(np.angle(drawn / middle)), coverage))


def model_band(
    structure: Structure,
    values: FloatArray,
    covariance: FloatArray,
    frequency_hz: ArrayLike,
    *,
    coverage: float = COVERAGE,
) -> ResponseBand:
    """Return the band around the response of a structure from the covariance of its free parameters.

    ``values``: all parameters, shape (parameters,). ``covariance``: covariance of the free parameters, shape (free,
    free); a parameter of infinite variance takes the band with it wherever it has an influence. ``frequency_hz``,
    ``coverage``: as for ``response_band``.
    """
    return _first_order(ParameterSpread.of_covariance(structure, values, covariance), frequency_hz, coverage)


def step_band(
    identification: Identification,
    time_s: ArrayLike,
    *,
    coverage: float = COVERAGE,
    experiment: int = 0,
    repeats: Bootstrap | None = None,
) -> StepBand:
    """Return the band around the response of the fitted linear model to a step of 1 at an input.

    ``time_s``: time after the step [s], shape (times,). ``coverage``, ``experiment``, ``repeats``: as for
    ``response_band``. Raises IdentificationError if there is no experiment of that number.
    """
    spread = spread_of(identification, experiment)
    time = np.atleast_1d(np.asarray(time_s, dtype=np.float64))
    value, slopes = step_response(spread.structure, spread.values, time, [p.name for p in spread.structure.free])
    if repeats is None:
        half = deviations(coverage) * spread.deviation(slopes)
        lower, upper = value - half, value + half
    else:
        rows = identification.objective.complete(repeats.values)
        structure_rows = identification.objective.terms[experiment].structure_values(rows)
        lower, upper = _middle_share(
            np.stack([step_response(spread.structure, row, time)[0] for row in structure_rows]), coverage
        )
    return StepBand(
        coverage=coverage,
        time_s=frozen_float(time),
        value=frozen_float(value),
        lower=frozen_float(lower),
        upper=frozen_float(upper),
    )


def _first_order(spread: ParameterSpread, frequency_hz: ArrayLike, coverage: float) -> ResponseBand:
    frequency = np.atleast_1d(np.asarray(frequency_hz, dtype=np.float64))
    response, slopes = spread.structure.gradient(spread.values, 2j * np.pi * frequency)
    relative = slopes / response
    wide = deviations(coverage)
    magnitude = wide * DECIBEL_PER_NEPER * spread.deviation(relative.real)
    phase = wide * np.degrees(spread.deviation(relative.imag))
    return _band(coverage, frequency, response, (-magnitude, magnitude), (-phase, phase))


def _band(
    coverage: float,
    frequency: FloatArray,
    response: ComplexArray,
    magnitude: tuple[FloatArray, FloatArray],
    phase: tuple[FloatArray, FloatArray],
) -> ResponseBand:
    """Return the band whose ends lie so many decibel and degrees beside a response."""
    level, turn = decibel(np.abs(response)), np.degrees(np.unwrap(np.angle(response), axis=-1))
    return ResponseBand(
        coverage=coverage,
        frequency_hz=frozen_float(frequency),
        magnitude_db=frozen_float(level),
        magnitude_lower_db=frozen_float(level + magnitude[0]),
        magnitude_upper_db=frozen_float(level + magnitude[1]),
        phase_deg=frozen_float(turn),
        phase_lower_deg=frozen_float(turn + phase[0]),
        phase_upper_deg=frozen_float(turn + phase[1]),
    )


def _middle_share(drawn: FloatArray, coverage: float) -> tuple[FloatArray, FloatArray]:
    """Return the ends between which the middle share of the repeats lies, repeats along the first axis."""
    tail = 0.5 * PERCENT * (1.0 - coverage)
    low, high = np.percentile(drawn, (tail, PERCENT - tail), axis=0)
    return low, high
