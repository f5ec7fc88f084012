import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shaftprint.signals.conditioning._outliers import FaultLimits, flagged
from shaftprint.signals.conditioning._patch import Patcher

LIMITS = FaultLimits(floor=50.0, hold_samples=12, lowest=-3000.0, highest=3000.0)

NO_HOLDS = FaultLimits(floor=500.0, lowest=-3000.0, highest=3000.0)


def ramp(count: int = 4000) -> np.ndarray:
    """A slow ramp that moves by one count a sample; spikes and holds come on top."""
    return np.arange(count, dtype=np.int16) - 2000


def patched(channel, blocks, *, limits=LIMITS, **more):
    repairs = []
    patcher = Patcher(channel=channel, limits=limits, repairs=repairs, **more)
    parts = list(patcher.patched(flagged(blocks, limits)))
    return np.concatenate(parts) if parts else np.empty(0), repairs


def told(repairs):
    return [(repair.kind, repair.time_s, repair.count) for repair in repairs]


def test_faults_become_the_straight_line_between_their_neighbours(make_channel):
    values = ramp()
    values[100] += 500
    values[[700, 701]] -= 900
    values[1500:1540] = values[1500]
    values[2000:2100] = -3200
    channel = make_channel(values, start_s=10.0)
    found, repairs = patched(channel, [values])
    line = ramp().astype(float)
    # the first sample of a hold is good but cannot be told from the rest
    assert found == pytest.approx(line, abs=1e-9)
    assert told(repairs) == [
        ("outlier", 10.05, 1),
        ("outlier", 10.35, 2),
        ("dropout", 10.75, 40),
        ("dropout", 11.0, 100),
    ]


def test_thesis_inserts_the_mean_of_the_neighbours(make_channel):
    values = ramp()
    values[[700, 701, 702]] += 900
    found, _ = patched(make_channel(values), [values], mean_of_neighbours=True)
    assert found[699:704].tolist() == [-1301.0, -1299.0, -1299.0, -1299.0, -1297.0]


@pytest.mark.parametrize("place", [0, 3999])
def test_fault_at_an_end_takes_the_neighbour(make_channel, place):
    values = ramp()
    values[place] += 600 if place == 0 else -600
    found, repairs = patched(make_channel(values), [values])
    assert found[place] == (-1999.0 if place == 0 else 1998.0)
    assert told(repairs) == [("outlier", place / 2000.0, 1)]


def test_jump_that_dies_away_is_kept(make_channel):
    # far from the median of their windows, but the last one is near the good sample after it
    values = np.zeros(200, dtype=np.int16)
    values[100:106] = [2000, 1500, 700, 490, 300, 100]
    (_, codes), *_ = list(flagged([values], NO_HOLDS))
    assert codes[100:103].tolist() == [1, 1, 1]
    found, repairs = patched(make_channel(values), [values], limits=NO_HOLDS)
    assert np.array_equal(found, values)
    assert repairs == []


def test_crests_at_the_rail_are_listed_once_and_left_alone(make_channel):
    count = 12_000
    wave = 2400.0 + 640.0 * np.sin(2 * np.pi * 40.0 * np.arange(count) / 2000.0)
    wave[3000:] -= 800.0
    wave[9000:] += 800.0
    values = np.minimum(wave, 3010.0).astype(np.int16)
    found, repairs = patched(make_channel(values), [values], limits=NO_HOLDS)
    assert np.array_equal(found, values)
    assert [repair.kind for repair in repairs] == ["saturated", "saturated"]
    assert repairs[0].time_s == pytest.approx(0.0055, abs=0.002)
    assert repairs[1].time_s == pytest.approx(4.5, abs=0.03)
    assert sum(repair.count for repair in repairs) == np.sum(values >= 3000)


@settings(deadline=None, max_examples=40)
@given(size=st.integers(1, 900))
def test_cut_into_blocks_does_not_matter(make_channel, cut, size):
    values = ramp()
    rng = np.random.default_rng(9)
    values[rng.choice(4000, 25, replace=False)] += 700
    values[1500:1590] = 5
    values[2500:2620] = 3100
    channel = make_channel(values)
    whole, listed = patched(channel, [values])
    pieces, again = patched(channel, cut(values, size))
    assert np.array_equal(whole, pieces)
    assert listed == again
    assert len(listed) > 15


@pytest.mark.parametrize(
    ("stuck", "word"), [(17.0, "stands still"), (3100.0, "stays at full scale"), (np.nan, "has no values")]
)
@pytest.mark.parametrize("size", [37, 1000, 100_000])
def test_long_silence_is_a_gap(make_channel, cut, stuck, word, size):
    values = 10.0 * np.random.default_rng(2).standard_normal(20_000)
    values[6000:11_000] = stuck
    channel = make_channel(values, name="M_s")
    repairs, gaps = [], []
    patcher = Patcher(channel=channel, limits=LIMITS, repairs=repairs, gaps=gaps)
    found = np.concatenate(list(patcher.patched(flagged(cut(values, size), LIMITS))))
    assert [(gap.channel, gap.start_s, gap.stop_s, gap.reason) for gap in gaps] == [("M_s", 3.0, 5.5, word)]
    assert repairs == []
    # outside nothing has changed, inside the last good value goes on
    outside = np.r_[0:6000, 11_000:20_000]
    assert np.array_equal(found[outside], values[outside])
    assert np.all(found[6000:11_000] == values[5999])


@pytest.mark.parametrize(("first", "stop"), [(0, 300), (3700, 4000), (0, 4000)])
@pytest.mark.parametrize("size", [50, 5000])
def test_gap_at_an_end(make_channel, cut, first, stop, size):
    values = ramp().astype(float)
    values[first:stop] = np.nan
    gaps = []
    patcher = Patcher(channel=make_channel(values), limits=LIMITS, repairs=[], gaps=gaps)
    found = np.concatenate(list(patcher.patched(flagged(cut(values, size), LIMITS))))
    assert [(gap.start_s, gap.stop_s) for gap in gaps] == [(first / 2000.0, stop / 2000.0)]
    assert np.all(np.isfinite(found))
    assert found.size == 4000


def test_short_silence_is_the_straight_line(make_channel):
    """Up to a twentieth of a second."""
    values = ramp().astype(float)
    values[1000:1100] = np.nan
    found, repairs = patched(make_channel(values), [values])
    assert found == pytest.approx(ramp().astype(float), abs=1e-9)
    assert told(repairs) == [("dropout", 0.5, 100)]


def test_channel_that_is_at_its_rail_all_the_time(make_channel):
    values = np.full(3000, 3100, dtype=np.int16)
    found, repairs = patched(make_channel(values), [values])
    assert np.array_equal(found, values)
    assert told(repairs) == [("saturated", 0.0, 3000)]


def test_nothing_in_nothing_out(make_channel):
    found, repairs = patched(make_channel(ramp()), [])
    assert found.size == 0
    assert repairs == []
