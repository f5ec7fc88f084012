"""Frequency responses of a drive that are estimated from its records, with the covariance that these tell.

Where an input holds from sample to sample, what is estimated is the response behind that hold. It is divided by the
hold's own, ``sin(x) / x exp(-j x)`` with ``x = pi f / rate``. What the hold moves down from beyond the rate is left:
of a response that goes as ``h / f`` there it is ``x^2 / 3 h / f``, which is counted as deviation, with the largest
``h`` of the lines.
"""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.bench._equipped import EquippedDrive
from shaftprint.bench._hold import jump_within_a_sample
from shaftprint.bench._per_record import with_structures
from shaftprint.bench._responses import ResponseFile
from shaftprint.drive._responses import EstimatedResponse
from shaftprint.errors import RecordingError, ResponseError
from shaftprint.spectra._conversion import converted
from shaftprint.spectra._frequency_response import FrequencyResponse
from shaftprint.spectra._plain_covariance import circular_covariance
from shaftprint.spectra.records._arbitrary import Arbitrary
from shaftprint.spectra.records._excitation import Excitation
from shaftprint.spectra.records._from_arrays import response_from_arrays
from shaftprint.spectra.records._periodic import Periodic
from shaftprint.spectra.records._sine import Sine
from shaftprint.time_domain._record import Record

# Highest line where inputs hold, as a share of the rate: there what is left is 0.8 %.
HELD_SHARE = 0.05


def estimated_responses(one: EquippedDrive, records: Sequence[Record]) -> tuple[ResponseFile, ...]:
    """Return the frequency responses of records as the drive file says: of each, or of those that belong together.

    Sines are put together, and so are records of several inputs, which need different ones; records that have values of
    their own are not. Raises RecordingError if records have gaps or other rates, or hold no response.
    """
    how = one.drive.frequency_response or EstimatedResponse()
    together = how.excitation == "sine" or len(one.structure.inputs) > 1
    groups: dict[int, list[Record]] = {}
    for number, (structure, record) in enumerate(with_structures(one, records)):
        groups.setdefault(id(structure) if together else number, []).append(record)
    return tuple(_response(one, how, group) for group in groups.values())


def _response(one: EquippedDrive, how: EstimatedResponse, records: Sequence[Record]) -> ResponseFile:
    name = f"record {records[0].name}" if len(records) == 1 else f"records {', '.join(one.name for one in records)}"
    for record in records:
        _expect_usable(one, record, records[0].rate_hz)
    rate_hz, hold = records[0].rate_hz, records[0].hold
    highest_hz = how.highest_hz or (HELD_SHARE if hold else 0.5) * rate_hz
    try:
        response = response_from_arrays(
            [dict(record.inputs) for record in records],
            [{output: record.outputs[output] for output in one.structure.outputs} for record in records],
            rate_hz,
            excitation=_excitation(how),
            drift=one.drive.fit.offset == "drift",
            band_hz=(how.lowest_hz, highest_hz),
        )
        if hold:
            response = _before_the_hold(response, rate_hz)
    except ResponseError as error:
        raise RecordingError(f"{name}: {error}") from None
    lines, lost = response.frequency_hz, int(np.sum(~response.used))
    remark = (
        f"the response of {name} was estimated at {lines.size} {'lines' if lines.size > 1 else 'line'}, "
        f"{lines[0]:.4g} to {lines[-1]:.4g} Hz"
        f"{f'; {lost} of them, where nothing is seen but noise, are not used' if lost else ''}"
        f"{', before the hold of the inputs' if hold else ''}."
    )
    taken = (remark_of for record in records for remark_of in record.remarks)
    return ResponseFile(name=records[0].name, response=response, remarks=(*taken, remark))


def _expect_usable(one: EquippedDrive, record: Record, rate_hz: float) -> None:
    if not record.used.all():
        at = record.time_s[int(np.argmin(record.used))]
        raise RecordingError(
            f"record {record.name}: expected outputs throughout for a frequency response, found none at {at:g} s; cut "
            "the record there with [[records]] in the drive file."
        )
    if abs(record.rate_hz / rate_hz - 1.0) > 1e-6:
        raise RecordingError(
            f"record {record.name}: expected the rate of the records that it belongs to, {rate_hz:g} Hz, found "
            f"{record.rate_hz:g} Hz; put them on one with `shaftprint convert --rate`."
        )
    if one.drive.fit.inputs_hold is None and jump_within_a_sample(record):
        raise RecordingError(
            f"record {record.name}: expected inputs_hold in [fit] of the drive file, as the input jumps within a "
            "sample: true if a computer holds it from sample to sample, false if it was sampled and goes straight."
        )


def _excitation(how: EstimatedResponse) -> Excitation:
    if how.excitation == "sine":
        return Sine(settling_s=how.settling_s)
    if how.period_s is None:
        return Arbitrary()
    settling_s = how.period_s if how.settling_s is None else how.settling_s
    return Periodic(period_s=how.period_s, settling_periods=math.ceil(settling_s / how.period_s - 1e-9))


def _before_the_hold(response: FrequencyResponse, rate_hz: float) -> FrequencyResponse:
    """Return a response without that of the hold of its inputs."""
    x: FloatArray = math.pi * response.frequency_hz / rate_hz
    hold = np.sin(x) / x * np.exp(-1j * x)
    values = response.response / hold
    turn = (1.0 / hold)[:, None, None] * np.eye(response.covariance.shape[1] // 2)
    turned = converted(response, values, turn, inputs=response.inputs, outputs=response.outputs)
    largest = np.max(np.abs(values) * response.frequency_hz, axis=2, keepdims=True)
    rest = circular_covariance(largest / response.frequency_hz * x**2 / 3.0)
    return replace(turned, covariance=turned.covariance + rest)
