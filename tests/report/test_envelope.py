import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from shaftprint.recording import Channel
from shaftprint.report.figures._envelope import channel_envelope, envelope


def test_a_single_spike_among_a_million_samples_stays():
    values = np.zeros(1_000_000)
    values[654_321] = 7.0
    time, drawn = envelope(np.arange(values.size) / 200.0, values, stretches=1000)
    assert drawn.max() == 7.0
    assert time[np.argmax(drawn)] == 654_321 / 200.0
    assert drawn.size == 2000


@given(st.integers(1, 400), st.integers(1, 20), st.integers(0, 2**32 - 1))
def test_every_drawn_point_is_a_sample_and_the_extremes_are_kept(count, stretches, seed):
    values = np.random.default_rng(seed).standard_normal(count)
    time, drawn = envelope(np.arange(count, dtype=float), values, stretches=stretches)
    np.testing.assert_array_equal(values[time.astype(int)], drawn)
    assert np.all(np.diff(time) >= 0.0)
    assert (drawn.min(), drawn.max()) == (values.min(), values.max())
    assert drawn.size <= max(2 * stretches, 1)


def test_a_short_signal_is_drawn_as_it_is():
    time, values = np.arange(10.0), np.arange(10.0) ** 2
    drawn = envelope(time, values, stretches=5)
    assert np.array_equal(drawn[0], time)
    assert np.array_equal(drawn[1], values)


def test_a_channel_of_short_floats_is_scaled_with_all_digits():
    counts = np.array([0.25, 0.5], dtype=np.float32)
    channel = Channel(
        name="T", unit="s", rate_hz=1.0, start_s=0.0, count=2, scale=0.1, offset=1e6,
        source=lambda start, stop: counts[start:stop],
    )  # fmt: skip
    _, drawn = channel_envelope(channel)
    np.testing.assert_allclose(drawn, [1_000_000.025, 1_000_000.05], rtol=1e-15)


def test_a_raw_channel_is_read_in_pieces_and_scaled():
    counts = np.zeros(2_500_000, dtype=np.int16)
    counts[[10, 1_048_576, 2_499_999]] = (100, -50, 30)
    asked = []

    def source(start, stop):
        asked.append(stop - start)
        return counts[start:stop]

    channel = Channel(
        name="U", unit="V", rate_hz=2000.0, start_s=5.0, count=counts.size, source=source, scale=0.1, offset=1.0
    )
    time, volts = channel_envelope(channel, stretches=300)
    assert max(asked) <= 1 << 20
    assert sorted({11.0, -4.0, 4.0} & set(volts.round(9))) == [-4.0, 4.0, 11.0]
    assert time[np.argmax(volts)] == 5.0 + 10 / 2000.0
    assert 600 <= volts.size <= 620
