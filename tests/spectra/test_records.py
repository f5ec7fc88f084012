"""Arrays that cannot be a measurement are refused with their place; those that can are taken as they are."""

import numpy as np
import pytest

from shaftprint.errors import ResponseError
from shaftprint.spectra import Periodic, response_from_arrays
from shaftprint.spectra.records._records import read_records

U = np.tile(np.random.default_rng(0).standard_normal(100), 4)


def broken(place, value):
    values = U.copy()
    values[place] = value
    return values


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"rate_hz": 0.0}, "rate_hz = 0.0: expected a positive, finite sample rate"),
        ({"rate_hz": np.nan}, "rate_hz = nan: expected a positive, finite sample rate"),
        ({"inputs": U}, r'inputs: expected a mapping of names to arrays such as \{"voltage": samples\}'),
        ({"outputs": []}, "outputs: expected a mapping of names"),
        ({"outputs": [U]}, "outputs: expected a mapping of names"),
        ({"outputs": {}}, "outputs: expected at least one channel, found none"),
        ({"inputs": [{"u": U}] * 2}, "expected as many records of both, found 2 and 1"),
        ({"outputs": {"u": U}}, "u: expected a channel among inputs or outputs, found it in both"),
        (
            {"inputs": [{"u": U}] * 2, "outputs": [{"y": U}, {"z": U}]},
            "record 2, outputs: expected y as in record 1, found z",
        ),
        ({"outputs": {"y": U[:-1]}}, "record 1: expected channels of one length, found 399, 400 samples"),
        ({"outputs": {"y": U[:, np.newaxis]}}, r"record 1, y: expected one row of samples, found .* shape \(400, 1\)"),
        ({"outputs": {"y": []}}, r"record 1, y: expected one row of samples"),
        ({"outputs": {"y": ["a", "b"]}}, "record 1, y: expected an array of numbers"),
        ({"outputs": {"y": U + 0j}}, "record 1, y: expected real samples, found complex numbers"),
        ({"inputs": {"u": broken(17, np.nan)}}, r"record 1, u: .* found nan at sample 17 \(1 such samples\)"),
        ({"outputs": {"y": broken([3, 9], np.inf)}}, r"record 1, y: .* found inf at sample 3 \(2 such samples\)"),
        ({"inputs": {"u": np.full(400, 12.5)}}, "record 1, u: expected a signal that moves, found 12.5 throughout"),
        ({"band_hz": (2.0, 1.0)}, "band_hz = 2 to 1: expected ascending frequencies"),
    ],
)
def test_arrays_that_are_no_measurement_are_refused(change, message):
    given = {"inputs": {"u": U}, "outputs": {"y": U}, "rate_hz": 10.0} | change
    with pytest.raises(ResponseError, match=message):
        response_from_arrays(**given)


def test_channels_keep_the_order_of_the_first_record_and_their_values():
    counts = np.array([1, 2, 4], dtype=np.int16)
    records = read_records([{"a": counts, "b": [3, 2, 1]}, {"b": [1, 0, 1], "a": [0, 1, 0]}], [{"y": counts}] * 2, 5)
    assert (records.inputs, records.outputs, records.rate_hz) == (("a", "b"), ("y",), 5.0)
    assert records.values[0].tolist() == [[1.0, 2.0, 4.0], [3.0, 2.0, 1.0], [1.0, 2.0, 4.0]]
    assert records.values[1][:2].tolist() == [[0.0, 1.0, 0.0], [1.0, 0.0, 1.0]]
    assert not records.values[0].flags.writeable


def test_units_and_means_do_not_matter():
    rng = np.random.default_rng(1)
    y = np.convolve(U, [0.5, 0.3, 0.2])[:400] + 0.1 * rng.standard_normal(400)
    for excitation in (None, Periodic(period_s=10.0)):
        plain = response_from_arrays({"u": U}, {"y": y}, 10.0, excitation=excitation)
        other = response_from_arrays({"u": 5.0 + 1e-3 * U}, {"y": 40.0 * y - 7.0}, 10.0, excitation=excitation)
        assert other.frequency_hz.tolist() == plain.frequency_hz.tolist()
        assert other.response == pytest.approx(4e4 * plain.response, rel=1e-6)
        assert other.covariance == pytest.approx(1.6e9 * plain.covariance, rel=1e-6)


def test_lines_are_named_by_their_frequency_with_digits_enough():
    # lines 0.001 Hz apart at 1 Hz need five digits
    time_s = np.arange(4000) / 4.0
    u = sum(np.cos(2.0 * np.pi * f * time_s + f * 1e3) for f in (1.0, 1.001, 1.002))
    found = response_from_arrays({"u": np.tile(u, 3)}, {"y": np.tile(u, 3)}, 4.0, excitation=Periodic(period_s=1000.0))
    assert found.lines == ("1 Hz", "1.001 Hz", "1.002 Hz")
