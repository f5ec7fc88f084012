"""Lists of edges, as logic analysers and counter cards write them, read as pulses whose flanks stand where they say."""

from itertools import pairwise

import numpy as np
import pytest

from shaftprint.errors import RecordingError
from shaftprint.recording import read_recording, write_recording


def saleae(folder, edges_s, *, title="Time [s],Channel 0", first_level=0, name="digital.csv", end_s=None):
    """Write the times of edges with the level behind each, below a row with the level at the start."""
    levels = (np.arange(edges_s.size + 1) + first_level) % 2
    rows = [f"{time:.9f},{level}" for time, level in zip([0.0, *edges_s.tolist()], levels.tolist(), strict=True)]
    rows += [] if end_s is None else [f"{end_s:.9f},{levels[-1]}"]
    path = folder / name
    path.write_text("\n".join([title, *rows]) + "\n", encoding="utf-8")
    return path


def uneven(count=2000, seed=1):
    """Times of edges of pulses that are low for 0.5 to 1.5 ms and high for 0.4 to 0.6 ms."""
    rng = np.random.default_rng(seed)
    steps = np.where(np.arange(count) % 2, rng.uniform(0.4e-3, 0.6e-3, count), rng.uniform(0.5e-3, 1.5e-3, count))
    return 0.01 + np.cumsum(steps)


def crossings(channel, *, rising=True):
    """When straight lines between the samples go up through the middle, or down."""
    values = channel.values(0, channel.count) - 0.5
    values = values if rising else -values
    before = np.flatnonzero((values[:-1] < 0.0) & (values[1:] >= 0.0))
    share = -values[before] / (values[before + 1] - values[before])
    return channel.start_s + (before + share) / channel.rate_hz


@pytest.mark.parametrize("title", ["Time [s],Channel 0", "Time[s], Channel 0", "time;Channel 0"])
def test_flanks_stand_where_the_list_says(tmp_path, title):
    edges = uneven()
    path = saleae(tmp_path, edges, title=title)
    if ";" in title:
        path.write_text(path.read_text(encoding="utf-8").replace(",", ";"), encoding="utf-8")
    with read_recording(path) as recording:
        (channel,) = recording.channels.values()
        assert recording.format == "CSV, list of edges"
        assert (channel.name, channel.unit, channel.start_s) == ("Channel 0", "V", 0.0)
        assert set(np.round(channel.values(0, 20), 12)) == {0.0}
        # of a list to the nanosecond; samples are some 50 microseconds apart
        assert crossings(channel) == pytest.approx(edges[::2], abs=5e-9)
        assert crossings(channel, rising=False) == pytest.approx(edges[1::2], abs=5e-9)
        assert 4.0 / 0.4e-3 < channel.rate_hz < 32.0 / 0.4e-3


def test_pieces_are_what_the_whole_is(tmp_path):
    with read_recording(saleae(tmp_path, uneven())) as recording:
        channel = recording.channels["Channel 0"]
        whole = channel.read(0, channel.count)
        borders = [0, 1, 2, 500, 501, 777, channel.count]
        pieces = [channel.read(first, stop) for first, stop in pairwise(borders)]
        assert np.array_equal(np.concatenate(pieces), whole)
        assert channel.read(5, 5).size == 0


def test_a_channel_that_begins_high_has_its_edges(tmp_path):
    edges = uneven()
    with read_recording(saleae(tmp_path, edges, first_level=1)) as recording:
        channel = recording.channels["Channel 0"]
        assert crossings(channel, rising=False) == pytest.approx(edges[::2], abs=5e-9)


def test_channels_of_one_list_have_edges_of_their_own(tmp_path):
    first, second = uneven(seed=1), uneven(seed=2)
    times = np.sort(np.concatenate([first, second]))
    rows = ["Time [s],Teeth,Index,Unused", "0.0,0,0,1"]
    levels = [np.searchsorted(edges, times, side="right") % 2 for edges in (first, second)]
    rows += [f"{time:.9f},{one},{other},1" for time, one, other in zip(times, *levels, strict=True)]
    path = tmp_path / "digital.csv"
    path.write_text("\n".join(rows) + "\n", encoding="utf-8")
    with read_recording(path) as recording:
        assert list(recording.channels) == ["Teeth", "Index", "Unused"]
        assert crossings(recording.channels["Teeth"]) == pytest.approx(first[::2], abs=5e-9)
        assert crossings(recording.channels["Index"]) == pytest.approx(second[::2], abs=5e-9)
        unused = recording.channels["Unused"]
        assert set(unused.values(0, unused.count)) == {1.0}


def test_times_alone_are_those_of_rising_edges(tmp_path):
    edges = uneven()[::2]
    path = tmp_path / "times.csv"
    path.write_text("time [ms]\n" + "\n".join(f"{1e3 * time:.6f}" for time in edges) + "\n", encoding="utf-8")
    with read_recording(path) as recording:
        (channel,) = recording.channels.values()
        assert (channel.name, channel.unit) == ("pulses", "V")
        assert crossings(channel) == pytest.approx(edges, abs=5e-9)


def test_levels_before_and_behind_each_edge_are_one_edge(tmp_path):
    edges = uneven()
    rows = ["Time [s],Channel 0", "0.0,0"]
    for number, time in enumerate(edges):
        rows += [f"{time:.9f},{number % 2}", f"{time:.9f},{1 - number % 2}"]
    path = tmp_path / "digital.csv"
    path.write_text("\n".join(rows) + "\n", encoding="utf-8")
    with read_recording(path) as recording:
        assert crossings(recording.channels["Channel 0"]) == pytest.approx(edges[::2], abs=5e-9)


def test_edges_a_microsecond_apart_are_one_edge_or_none(tmp_path):
    edges = uneven()
    # a bounce behind the rising edge 400, and a needle in the middle of the low behind edge 801
    needle = 0.5 * (edges[801] + edges[802])
    spoilt = np.sort([*edges, edges[400] + 0.5e-6, edges[400] + 1e-6, needle, needle + 1e-6])
    with read_recording(saleae(tmp_path, spoilt)) as recording:
        assert crossings(recording.channels["Channel 0"]) == pytest.approx(edges[::2], abs=5e-9)


def test_levels_at_even_times_stay_samples(tmp_path):
    times = np.arange(400) / 1000.0
    rows = [f"{time:.6f},{level}" for time, level in zip(times, times * 100.0 % 1.0 < 0.4, strict=True)]
    path = tmp_path / "sampled.csv"
    path.write_text("time [s],M_s [N m]\n" + "\n".join(rows).replace("True", "1").replace("False", "0") + "\n")
    with read_recording(path) as recording:
        channel = recording.channels["M_s"]
        assert (channel.rate_hz, channel.count, channel.unit) == (1000.0, 400, "N m")


def test_even_times_at_which_the_level_always_changes_are_edges(tmp_path):
    edges = 0.001 * np.arange(1, 401)
    with read_recording(saleae(tmp_path, edges)) as recording:
        assert crossings(recording.channels["Channel 0"]) == pytest.approx(edges[::2], abs=5e-9)


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        (lambda rows: [*rows[:50], rows[80], *rows[50:]], r"digital\.csv, column Time: expected .*ascending.* row 52"),
        (lambda rows: [*rows[:50], ",1", *rows[50:]], r"digital\.csv, column Time: expected .*times.* row 51"),
    ],
)
def test_times_that_cannot_be_those_of_edges_are_refused(tmp_path, change, expected):
    path = saleae(tmp_path, uneven())
    rows = path.read_text(encoding="utf-8").splitlines()
    path.write_text("\n".join([rows[0], *change(rows[1:])]) + "\n", encoding="utf-8")
    with pytest.raises(RecordingError, match=expected):
        read_recording(path)


@pytest.mark.parametrize(("edges_a_ms", "told"), [(4, "4"), (3, "3"), (1.4, r"1\.4\d?")])
def test_edges_that_share_their_times_are_no_pulses_that_go(tmp_path, edges_a_ms, told):
    """Printed to the millisecond, an even number of edges would be none, an odd number one."""
    rows = [f"{int(k / edges_a_ms) / 1000.0:.3f},{k % 2}" for k in range(2000)]
    path = tmp_path / "digital.csv"
    path.write_text("\n".join(["Time [s],Channel 0", *rows]) + "\n", encoding="utf-8")
    with pytest.raises(RecordingError, match=f"column Time: expected a time for each edge, found {told} edges"):
        read_recording(path)
    path.write_text("\n".join(["time [s]", *(row[:-2] for row in rows)]) + "\n", encoding="utf-8")
    with pytest.raises(RecordingError, match=f"expected a time for each edge, found {told} edges with each"):
        read_recording(path)


def test_samples_of_a_logic_analyser_whose_times_stand_still_need_their_rate(tmp_path):
    """As sigrok-cli -O csv:label=channel:time=true writes them: the column of times is 0 throughout."""
    levels = [int(k % 50 < 25) for k in range(4000)]
    head = "; CSV generated by libsigrok 0.5.2\n; Channels (1/1): tooth\nMETA samplerate: 100000\nTime,tooth\n"
    path = tmp_path / "logic.csv"
    path.write_text(head + "".join(f"0,{level}\n" for level in levels), encoding="utf-8")
    with pytest.raises(RecordingError, match=r"about 4000 rows with each stamp; pass their rate"):
        read_recording(path)
    with read_recording(path, sample_rate_hz=1e5) as recording:
        tooth = recording.channel("tooth")
        assert (tooth.rate_hz, tooth.values(0, tooth.count).tolist()) == (1e5, levels)


def test_values_at_odd_times_are_messages_not_edges(tmp_path):
    rows = [f"{time:.6f},{1e3 * np.sin(time):.3f}" for time in uneven()]
    path = tmp_path / "log.csv"
    path.write_text("time [s],M_s [N m]\n" + "\n".join(rows) + "\n", encoding="utf-8")
    with read_recording(path) as recording:
        assert recording.format == "CSV"
        assert recording.channel("M_s").is_uneven
        assert recording.channel("M_s").count == len(rows)


def test_pulses_of_a_list_are_kept_by_the_container(tmp_path):
    edges = uneven()
    with read_recording(saleae(tmp_path, edges)) as recording:
        write_recording(tmp_path / "edges.nc", recording.channels.values())
    with read_recording(tmp_path / "edges.nc") as recording:
        assert crossings(recording.channels["Channel 0"]) == pytest.approx(edges[::2], abs=5e-9)
