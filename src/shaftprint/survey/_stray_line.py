"""One line that something else moved: a swell, or the ship surging at its moorings, at the frequency of one line.

A structure that lacks something misses several neighbouring lines, for every response is smooth from line to line. One
line alone that is far off every model, between two that are not, was moved by what acts at its frequency only.
"""

from collections.abc import Callable
from dataclasses import replace
from typing import TypeAlias

from shaftprint.arrays import frozen_bool
from shaftprint.digits import p_value_text, plain
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.judgement._misfit import explained
from shaftprint.identify.judgement._requirements import Requirements
from shaftprint.identify.likelihood._line_test import LineTest
from shaftprint.spectra._frequency_response import FrequencyResponse
from shaftprint.spectra._spectra import Spectra
from shaftprint.survey._measurement import Measurement

# A neighbour is as far off as chance allows once in so many tests.
_USUAL = 0.02


Fits: TypeAlias = tuple[Identification, ...]


def fits_beside_a_stray_line(fit: Callable[[Measurement], Fits], measurement: Measurement) -> tuple[Fits, Measurement]:
    """Return the fits to a measurement with what they are of: without its stray line, where they explain the rest.

    ``fit``: fits structures to a measurement; by the first of them a line is stray. ``measurement``: what was measured.
    """
    fits = fit(measurement)
    stray = stray_line(fits[0])
    if stray is None:
        return fits, measurement
    rest = _without_line(stray, fits[0], measurement)
    again = fit(rest)
    return (again, rest) if explained(again[0]) else (fits, measurement)


def _without_line(stray: LineTest, fit: Identification, measurement: Measurement) -> Measurement:
    frequency_hz = _frequency_hz(fit, stray)
    remark = (
        f"it alone lies off every model of the other lines (p = {p_value_text(stray.p_value)}), as where a swell or a "
        f"surge of the ship at {plain(frequency_hz, 3)} Hz moved it"
    )

    def left_out(response: FrequencyResponse) -> FrequencyResponse:
        return _without(response, stray.name, remark)

    def of_spectra(one: Spectra) -> Spectra:
        return replace(one, response=left_out(one.response))

    return replace(
        measurement,
        spectra=of_spectra(measurement.spectra),
        responses=tuple(map(left_out, measurement.responses)),
        legs=tuple(replace(leg, spectra=of_spectra(leg.spectra)) for leg in measurement.legs),
    )


def stray_line(fit: Identification) -> LineTest | None:
    """Return the one line that a fit misses farther than the worst of as many, with a usual one to either side of it.

    None where the fit explains the data, or misses more than one line, or the first or last.
    """
    if not fit.is_likelihood or fit.objective.others or explained(fit):
        return None
    tests = fit.line_tests
    far = [number for number, one in enumerate(tests) if one.p_value * len(tests) < Requirements().lowest_p_value]
    if len(far) != 1 or not 0 < far[0] < len(tests) - 1:
        return None
    before, stray, after = tests[far[0] - 1 : far[0] + 2]
    beside = [one for one in (before, after) if one.experiment == stray.experiment and one.p_value > _USUAL]
    return stray if len(beside) == 2 else None


def _frequency_hz(fit: Identification, line: LineTest) -> float:
    response = fit.experiments[line.experiment].response
    return float(response.frequency_hz[response.lines.index(line.name)])


def _without(response: FrequencyResponse, line: str, remark: str) -> FrequencyResponse:
    if line not in response.lines:
        return response
    used = response.used.copy()
    used[response.lines.index(line)] = False
    return replace(response, used=frozen_bool(used), remarks={**response.remarks, line: remark})
