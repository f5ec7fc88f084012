"""``convert`` and ``join`` cut: which samples stay, when they were, and what is refused."""

import numpy as np
import pytest

from shaftprint.recording import Channel, Recording, RecordingWriter, cut, read_recording, write_by_ending

RATE_HZ = 100.0
COUNT = 1000


def written(path, *, start_s=0.0, first=0, count=COUNT):
    """Write the numbers of the samples, so that each sample says which one it is."""
    numbers = np.arange(first, first + count, dtype=np.float64)
    channels = [
        Channel(
            name=name,
            unit="V",
            rate_hz=RATE_HZ,
            start_s=start_s,
            count=count,
            source=lambda start, stop: numbers[start:stop],
        )
        for name in ("M_s", "U")
    ]
    write_by_ending(path, channels)
    return path


def held(path):
    """Return times and values of the channels of a file."""
    with read_recording(path) as opened:
        channels = tuple(opened.channels.values())
        return {c.name: (c.time_s(0, c.count), c.values(0, c.count)) for c in channels}


@pytest.mark.parametrize("source", [".nc", ".csv", ".mat", ".mf4", ".tdms"])
@pytest.mark.parametrize("target", [".nc", ".csv", ".mat", ".mf4", ".tdms"])
def test_every_format_keeps_the_times(run, tmp_path, source, target):
    path = written(tmp_path / f"in{source}", start_s=5.0)
    result = run("convert", path, "-o", tmp_path / f"out{target}", "--from", 7.0, "--to", 9.5, "--no-progress")
    assert result.exit_code == 0, result.stderr
    for time_s, values in held(tmp_path / f"out{target}").values():
        # the sample at 7 s is the 200th after 5 s, and the one at 9.5 s is out
        np.testing.assert_allclose(time_s, 7.0 + np.arange(250) / RATE_HZ, atol=1e-9)
        np.testing.assert_array_equal(values, np.arange(200, 450))


@pytest.mark.parametrize(
    ("options", "first", "last"),
    [(("--from", 3.0), 300, 1000), (("--to", 3.0), 0, 300), (("--from", 0.0, "--to", 10.0), 0, 1000), ((), 0, 1000)],
)
def test_open_ends(run, tmp_path, options, first, last):
    path = written(tmp_path / "in.nc")
    assert run("convert", path, "-o", tmp_path / "out.nc", *options, "--no-progress").exit_code == 0
    np.testing.assert_array_equal(held(tmp_path / "out.nc")["U"][1], np.arange(first, last))


def test_seconds_between_samples(run, tmp_path):
    path = written(tmp_path / "in.nc")
    run("convert", path, "-o", tmp_path / "out.nc", "--from", 1.001, "--to", 1.0301, "--no-progress")
    time_s, values = held(tmp_path / "out.nc")["M_s"]
    np.testing.assert_allclose(time_s, [1.01, 1.02, 1.03])
    assert values.tolist() == [101.0, 102.0, 103.0]


def test_each_channel_is_cut_on_its_own_clock(run, tmp_path):
    path = tmp_path / "in.nc"
    with RecordingWriter(path) as writer:
        for name, rate_hz, start_s, count in (("fast", 1000.0, 0.0, 4000), ("slow", 10.0, 0.25, 40)):
            writer.declare(name, unit="V", rate_hz=rate_hz, start_s=start_s, scale=0.5)
            writer.append(name, np.arange(count, dtype=np.int16))
    assert run("convert", path, "-o", tmp_path / "out.nc", "--from", 1.0, "--to", 2.0).exit_code == 0
    with read_recording(tmp_path / "out.nc") as opened:
        fast, slow = opened.channel("fast"), opened.channel("slow")
        assert (fast.start_s, fast.count, slow.start_s, slow.count) == (1.0, 1000, 1.05, 10)
        # counts stay counts
        assert fast.read(0, 2).tolist() == [1000, 1001]
        assert slow.values(0, 2).tolist() == [4.0, 4.5]


def test_two_parts_are_the_whole_again(run, tmp_path):
    path = written(tmp_path / "in.nc")
    for name, option in (("a.nc", "--to"), ("b.nc", "--from")):
        assert run("convert", path, "-o", tmp_path / name, option, 3.337, "--no-progress").exit_code == 0
    result = run("join", tmp_path / "a.nc", tmp_path / "b.nc", "-o", tmp_path / "whole.nc")
    assert result.exit_code == 0, result.stderr
    for time_s, values in held(tmp_path / "whole.nc").values():
        np.testing.assert_allclose(time_s, np.arange(COUNT) / RATE_HZ, atol=1e-9)
        np.testing.assert_array_equal(values, np.arange(COUNT))


def test_join_cuts_the_whole(run, tmp_path):
    written(tmp_path / "a.nc")
    written(tmp_path / "b.nc", start_s=10.0, first=COUNT)
    arguments = ("join", tmp_path / "a.nc", tmp_path / "b.nc", "-o", tmp_path / "part.nc")
    result = run(*arguments, "--from", 9.0, "--to", 11.0)
    assert result.exit_code == 0, result.stderr
    time_s, values = held(tmp_path / "part.nc")["U"]
    np.testing.assert_allclose(time_s, 9.0 + np.arange(200) / RATE_HZ, atol=1e-9)
    np.testing.assert_array_equal(values, np.arange(900, 1100))


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        (("--from", 5, "--to", 3), "expected a stretch that ends after it begins, found 5 to 3 s of a recording from"),
        (("--from", 5, "--to", 5), "expected a stretch that ends after it begins, found 5 to 5 s of a recording from"),
        (("--from", "nan"), "expected a stretch that ends after it begins, found nan to 10 s"),
        (("--to", "inf"), "expected a stretch that ends after it begins, found 0 to inf s"),
        (
            ("--from", 12),
            "expected a stretch that ends after it begins, found 12 to 10 s of a recording from 0 to 10 s",
        ),
        (("--from", 12, "--to", 15), "within the recording, which goes from 0 to 10 s, found 12 to 15 s"),
        (("--from", -1), "within the recording, which goes from 0 to 10 s, found -1 to 10 s"),
        (("--to", 10.5), "within the recording, which goes from 0 to 10 s, found 0 to 10.5 s"),
        (("--from", 1.001, "--to", 1.002), "channel M_s: expected samples in the stretch, found it recorded from 0 to"),
    ],
)
def test_stretches_that_are_refused(run, tmp_path, options, sentence):
    path = written(tmp_path / "in.nc")
    for command in (("convert", path), ("join", path)):
        result = run(*command, "-o", tmp_path / "out.nc", *options)
        assert result.exit_code == 1
        assert sentence in result.stderr, result.stderr
        assert result.stderr.count("\n") == 1
        assert not (tmp_path / "out.nc").exists()


def test_only_the_stretch_is_read(tmp_path):
    """A stretch of a recording larger than the memory is read as the recording is, in pieces."""
    asked = []

    def source(start, stop):
        asked.append((start, stop))
        return np.zeros(stop - start)

    channel = Channel(name="M_s", unit="V", rate_hz=1000.0, start_s=0.0, count=10**9, source=source)
    whole = Recording(path=tmp_path / "in.nc", sha256="0", format="memory", channels={"M_s": channel})
    stretch = cut(whole, from_s=1000.0, to_s=1001.0)
    assert asked == []
    write_by_ending(tmp_path / "out.nc", stretch.channels.values())
    assert min(start for start, _ in asked) == 1_000_000
    assert max(stop for _, stop in asked) == 1_001_000
