"""What is known of the loggers' clocks goes through files and comes back."""

import json
from dataclasses import replace

import numpy as np
import pytest
from click.testing import CliRunner

from shaftprint.cli import shaftprint
from shaftprint.clocks import Alignment, ClockMap, Stretch, clock_attributes, joined, logger_clocks, merged
from shaftprint.errors import ClockError, RecordingError
from shaftprint.recording import Samples, read_recording, recording_from_arrays, write_recording

CORRELATED = np.array([[4e-6, -0.6 * 2e-3 * 5e-7], [-0.6 * 2e-3 * 5e-7, 25e-14]])
FOUND = Alignment(
    map=ClockMap(offset_s=0.4, drift=30e-6, middle_s=431.7, covariance=CORRELATED),
    span_s=(5.0, 860.0),
    stretches=(Stretch(time_s=35.0, offset_s=0.3881, std_s=1e-3), Stretch(time_s=95.0, offset_s=0.39, std_s=2e-3)),
    scatter=1.07,
)
LATER = Alignment(
    map=ClockMap(offset_s=-12.25, drift=-80e-6, middle_s=100.0, covariance=np.diag([9e-6, 16e-14])), span_s=(0.0, 800.0)
)


def test_a_simulated_logger_is_told_as_it_was(tmp_path):
    """Offset 0.4 s and drift 30 ppm, through merge and inspect, within the standard deviations stated."""
    rng = np.random.default_rng(3)
    time_s = np.arange(-5.0, 920.0, 0.02)
    steps = 0.3 * np.sign(np.sin(2.0 * np.pi * time_s / 97.0) + 0.6 * np.sin(2.0 * np.pi * time_s / 61.8))
    moved = np.convolve(steps + 0.3 * rng.standard_normal(time_s.size), np.full(50, 0.02), mode="same")
    own_s = 2.0 + np.arange(0.0, 880.0, 0.05)
    true_s = own_s + 0.4 + 30e-6 * own_s
    logs = {
        "bridge": Samples(name="n_e", values=np.interp(np.arange(0.0, 900.0, 0.02), time_s, moved), unit="1/s",
                          rate_hz=50.0),
        "shaft": Samples(name="n_s", values=np.interp(true_s, time_s, moved) / 3.0, unit="1/s", rate_hz=20.0,
                         start_s=2.0),
    }  # fmt: skip
    for name, samples in logs.items():
        noisy = replace(samples, values=samples.values + 0.003 * rng.standard_normal(samples.values.size))
        (tmp_path / name).write_bytes(b"a logger's file")
        with recording_from_arrays(tmp_path / name, [noisy], format="test") as one:
            write_recording(tmp_path / f"{name}.nc", one.channels.values())
    paths = [str(tmp_path / f"{name}.nc") for name in ("bridge", "shaft", "merged")]
    found = CliRunner().invoke(shaftprint, ["merge", *paths[:2], "--shared", "n_e=n_s", "-o", paths[2]])
    assert found.exit_code == 0, found.output
    shown = CliRunner().invoke(shaftprint, ["inspect", paths[2]])
    with read_recording(paths[2]) as recording, read_recording(paths[1]) as raw:
        (clock,) = logger_clocks(recording)
        assert (clock.logger, clock.sha256, clock.channels) == ("shaft.nc", raw.sha256, ("n_s",))
        line = clock.alignment.map
        errors = line.reference_s(own_s) - true_s
        assert np.abs(errors).max() < 3.0 * clock.alignment.worst_std_s
        assert clock.alignment.worst_std_s < 5e-3
        offset_std, drift_std = np.sqrt(np.diag(line.covariance))
        assert line.offset_s == pytest.approx(0.4 + 30e-6 * line.middle_s, abs=3.0 * offset_std)
        assert line.drift == pytest.approx(30e-6, abs=3.0 * drift_std)
        assert len(clock.alignment.stretches) == 14
        for stretch in clock.alignment.stretches:
            assert stretch.offset_s == pytest.approx(0.4 + 30e-6 * stretch.time_s, abs=5.0 * stretch.std_s)
    # the same table by both commands, with the same numbers
    printed, again = (
        next(row for row in run.output.splitlines() if row.split()[:2] == ["shaft.nc", "n_s"]) for run in (found, shown)
    )
    assert again == printed
    # logger, channels, offset +/- std [ms], at [s], drift +/- std [ppm], correlation, largest std, minutes, scatter
    words = printed.split()
    offset_ms, offset_std_ms, middle_s, drift_ppm, drift_std_ppm = (float(words[place]) for place in (2, 4, 5, 6, 8))
    assert offset_ms == pytest.approx(1e3 * (0.4 + 30e-6 * middle_s), abs=3.0 * offset_std_ms)
    assert drift_ppm == pytest.approx(30.0, abs=3.0 * drift_std_ppm)
    assert words[11] == "14"


def log(folder, name, *channels):
    (folder / name).write_bytes(name.encode())
    samples = [Samples(name=c, values=np.arange(8600.0), unit="V", rate_hz=10.0) for c in channels]
    return recording_from_arrays(folder / name, samples, format="test")


def kept(recording, path):
    write_recording(path, recording.channels.values(), attributes=recording.attributes)
    return read_recording(path)


def test_all_of_it_comes_back_to_the_last_digit(tmp_path):
    reference = replace(log(tmp_path, "bridge", "U"), attributes={"vessel": "Stan Tug 1205", "knots": 9.5})
    with kept(merged(reference, [(log(tmp_path, "shaft", "M_s"), FOUND)]), tmp_path / "merged.nc") as recording:
        (clock,) = logger_clocks(recording)
        assert recording.attributes["vessel"] == "Stan Tug 1205"
        assert recording.attributes["knots"] == 9.5
    back = clock.alignment
    assert (clock.logger, clock.reference, clock.channels) == ("shaft", "bridge", ("M_s",))
    assert (back.span_s, back.scatter, back.stretches) == (FOUND.span_s, FOUND.scatter, FOUND.stretches)
    assert (back.map.offset_s, back.map.drift, back.map.middle_s) == (0.4, 30e-6, 431.7)
    np.testing.assert_array_equal(back.map.covariance, CORRELATED)
    # by hand: 4e-6 - 2 * 0.6e-9 * 428.3 + 25e-14 * 428.3^2 = 3.53190e-6 at 860 s,
    # 4e-6 + 2 * 0.6e-9 * 426.7 + 25e-14 * 426.7^2 = 4.55756e-6 at 5 s
    assert back.map.std_s(np.array([860.0])) == pytest.approx(1.879335e-3, rel=1e-5)
    assert back.worst_std_s == pytest.approx(2.134844e-3, rel=1e-5)


def test_a_third_logger_keeps_the_map_of_the_second(tmp_path):
    first = kept(merged(log(tmp_path, "bridge", "U"), [(log(tmp_path, "shaft", "M_s"), FOUND)]), tmp_path / "two.nc")
    with kept(merged(first, [(log(tmp_path, "engine", "U", "X"), LATER)]), tmp_path / "three.nc") as recording:
        shaft, engine = logger_clocks(recording)
        assert list(recording.channels) == ["U", "M_s", "U (engine)", "X"]
    assert (shaft.logger, shaft.channels, shaft.alignment.map.offset_s) == ("shaft", ("M_s",), 0.4)
    assert (engine.logger, engine.reference, engine.channels) == ("engine", "two.nc", ("U (engine)", "X"))
    assert engine.alignment.map.offset_s == -12.25
    assert (engine.alignment.stretches, engine.alignment.scatter) == ((), None)


def test_a_merged_recording_that_is_merged_carries_its_own_maps_along(tmp_path):
    inner = merged(log(tmp_path, "engine", "X", "U"), [(log(tmp_path, "shaft", "M_s"), FOUND)])
    with kept(merged(log(tmp_path, "bridge", "U"), [(inner, LATER)]), tmp_path / "all.nc") as recording:
        engine, shaft = logger_clocks(recording)
        moved = recording.channel("M_s")
    assert (engine.channels, shaft.channels) == (("X", "U (engine)"), ("M_s",))
    assert (engine.reference, shaft.reference) == ("bridge", "bridge")
    # sample by sample through both maps: shaft to engine to bridge
    time_s = np.array([0.0, 431.7, 860.0])
    through = LATER.map.reference_s(FOUND.map.reference_s(time_s))
    assert shaft.alignment.map.reference_s(time_s) == pytest.approx(through, abs=1e-9)
    assert moved.start_s == pytest.approx(through[0], abs=1e-9)
    # independent errors of both maps add in squares, the second read where the first leads
    both = np.hypot(FOUND.map.std_s(time_s), LATER.map.std_s(FOUND.map.reference_s(time_s)))
    assert shaft.alignment.map.std_s(time_s) == pytest.approx(both, rel=1e-3)
    # 35 s of the shaft are 35.3881 s of the engine, -12.25 - 80e-6 * (35.3881 - 100) s less of the bridge
    assert shaft.alignment.stretches[0].offset_s == pytest.approx(0.3881 - 12.25 + 80e-6 * 64.6119, abs=1e-9)


def test_joined_parts_keep_the_maps_of_all(tmp_path):
    parts = []
    for number in (1, 2):
        shaft = log(tmp_path, f"shaft{number}", "M_s")
        parts.append(merged(log(tmp_path, f"bridge{number}", "U"), [(shaft, FOUND)]))
    parts[0] = replace(parts[0], attributes=parts[0].attributes | {"vessel": "tug", "part": 1.0})
    parts[1] = replace(parts[1], attributes=parts[1].attributes | {"vessel": "tug", "part": 2.0})
    with joined(parts, follow_on=True) as whole:
        assert [clock.logger for clock in logger_clocks(whole)] == ["shaft1", "shaft2"]
        assert whole.attributes["vessel"] == "tug"
        assert "part" not in whole.attributes


def test_convert_keeps_the_map_or_says_that_it_cannot(tmp_path):
    path = tmp_path / "merged.nc"
    kept(merged(log(tmp_path, "bridge", "U"), [(log(tmp_path, "shaft", "M_s"), FOUND)]), path).close()
    done = CliRunner().invoke(shaftprint, ["convert", str(path), "-o", str(tmp_path / "copy.h5")])
    assert done.exit_code == 0, done.output
    with read_recording(path) as before, read_recording(tmp_path / "copy.h5") as after:
        assert after.attributes == before.attributes
    # without the logger's channels its map says nothing
    chosen = ["convert", str(path), "--channel", "U", "-o", str(tmp_path / "less.nc")]
    assert CliRunner().invoke(shaftprint, chosen).exit_code == 0
    with read_recording(tmp_path / "less.nc") as less:
        assert logger_clocks(less) == ()
    done = CliRunner().invoke(shaftprint, ["convert", str(path), "-o", str(tmp_path / "copy.tdms")])
    assert done.exit_code == 0
    assert "left out the attribute clock_maps: only the native container (.nc) holds it" in done.stderr


def broken(change):
    def of(text):
        entries = json.loads(text)
        change(entries[0])
        return json.dumps(entries)

    return of


@pytest.mark.parametrize(
    "change",
    [
        lambda text: text[:-40],
        lambda text: "",
        lambda text: 3.0,
        lambda text: "[" * 10_000,
        lambda text: "{}",
        lambda text: text.replace("0.4", "NaN"),
        lambda text: text.replace("0.4", "1e300"),
        broken(lambda entry: entry.pop("covariance")),
        broken(lambda entry: entry.update(covariance=[[1.0, 2.0], [2.0, 1.0]])),
        broken(lambda entry: entry.update(covariance=[[-1.0, 0.0], [0.0, 1.0]])),
        broken(lambda entry: entry.update(covariance=[[1.0]])),
        broken(lambda entry: entry.update(drift=-1.0)),
        broken(lambda entry: entry.update(channels="M_s")),
        broken(lambda entry: entry.update(stretches=[[1.0, 2.0]])),
        broken(lambda entry: entry.update({"\x1b[2J\n": 1})),
    ],
)
def test_broken_attributes_end_in_one_sentence(tmp_path, change):
    path = tmp_path / "merged.nc"
    whole = merged(log(tmp_path, "bridge", "U"), [(log(tmp_path, "shaft", "M_s"), FOUND)])
    write_recording(path, whole.channels.values(), attributes={"clock_maps": change(whole.attributes["clock_maps"])})
    with (
        read_recording(path) as recording,
        pytest.raises(
            RecordingError, match=r"merged\.nc, attribute clock_maps: expected.*merge the loggers again"
        ) as told,
    ):
        logger_clocks(recording)
    assert str(told.value).isprintable()
    shown = CliRunner().invoke(shaftprint, ["inspect", str(path)])
    assert (shown.exit_code, len(shown.stderr.splitlines())) == (1, 1)


def test_names_of_files_that_no_screen_can_show_are_kept_as_far_as_one_can(tmp_path):
    """A byte that the system cannot decode, and a file that clears the screen."""
    (clock,) = logger_clocks(merged(log(tmp_path, "bridge", "U"), [(log(tmp_path, "shaft", "M_s"), FOUND)]))
    written = clock_attributes([replace(clock, logger="sh\udcfft.log")])["clock_maps"]
    assert json.loads(written)[0]["logger"] == "sh?t.log"
    hostile = broken(lambda entry: entry.update(logger="\x1b[2Jx", reference="a\nb"))(written)
    (back,) = logger_clocks(replace(log(tmp_path, "shaft", "M_s"), attributes={"clock_maps": hostile}))
    assert (back.logger, back.reference) == ("?[2Jx", "a?b")


@pytest.mark.parametrize(
    "wrong",
    [{"offset_s": np.nan}, {"drift": -1.0}, {"covariance": np.eye(3)}, {"covariance": [[1.0, 2.0], [2.0, 1.0]]}],
)
def test_a_map_that_cannot_be_is_refused(wrong):
    with pytest.raises(ClockError, match="clock map: expected"):
        replace(FOUND.map, **wrong)


def test_a_recording_of_one_logger_has_no_map(tmp_path):
    with kept(log(tmp_path, "bridge", "U"), tmp_path / "one.nc") as recording:
        assert logger_clocks(recording) == ()
        assert recording.attributes == {}
