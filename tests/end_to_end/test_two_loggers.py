"""Two loggers whose clocks disagree: one has the set point, the other shaft torque and speed."""

from dataclasses import replace

import numpy as np
import pytest
from click.testing import CliRunner

from shaftprint.cli import shaftprint
from shaftprint.clocks import align, clock_attributes, logger_clocks
from shaftprint.recording import read_recording, write_recording
from shaftprint.signals import content_of
from shaftprint.survey import load_trial, measure


@pytest.fixture(scope="module")
def loggers(short_trip, second_logger, tmp_path_factory):
    """One file of set point and engine speed, one of the propeller shaft's speed and torque on another clock."""
    folder = tmp_path_factory.mktemp("loggers")
    with read_recording(short_trip.path) as recording:
        own = [recording.channel(name) for name in ("U_setpoint", "PTM_e")]
        write_recording(folder / "bridge.nc", own)
        other = [second_logger.of(recording.channel(name)) for name in ("PTM_1", "PTM_4", "M_s")]
        write_recording(folder / "shaft.nc", other)
    return folder


@pytest.mark.slow
def test_the_map_is_found_within_two_milliseconds(loggers, second_logger, vessel):
    engine, _, propeller = vessel.sensors.speed
    with read_recording(loggers / "bridge.nc") as still, read_recording(loggers / "shaft.nc") as moving:
        reference = content_of(still.channel(engine.channel), engine, rate_hz=50.0)
        other = content_of(moving.channel(propeller.channel), propeller, rate_hz=50.0)
        found = align(other, reference)
    errors = found.map.reference_s(other.time_s) - second_logger.true_time_s(other.time_s)
    assert np.abs(errors).max() < 2e-3
    assert np.abs(errors).max() < 4.0 * found.worst_std_s + 1e-5


@pytest.fixture(scope="module")
def merged(loggers):
    """Both on the clock of the bridge, in one file."""
    path = loggers / "merged.nc"
    arguments = ["merge", loggers / "bridge.nc", loggers / "shaft.nc", "--shared", "PTM_e=PTM_4"]
    arguments += ["--vessel", "stan-tug-1205", "-o", path]
    result = CliRunner().invoke(shaftprint, [str(a) for a in arguments], catch_exceptions=False)
    assert result.exit_code == 0, result.output
    assert "drift" in result.output
    return path


def test_the_merged_file_states_the_true_map(merged, second_logger):
    with read_recording(merged) as recording:
        (clock,) = logger_clocks(recording)
        assert clock.channels == ("PTM_1", "PTM_4", "M_s")
        assert recording.channel("M_s").start_s == pytest.approx(second_logger.true_time_s(5.0), abs=2e-4)
    ends = np.array(clock.alignment.span_s)
    errors = clock.alignment.map.reference_s(ends) - second_logger.true_time_s(ends)
    assert np.abs(errors).max() < 4.0 * clock.alignment.worst_std_s + 1e-5
    assert clock.alignment.map.drift == pytest.approx(30e-6, abs=3.0 * clock.alignment.map.covariance[1, 1] ** 0.5)


@pytest.mark.slow
def test_a_clock_that_is_known_badly_becomes_a_finding(merged, tmp_path):
    with read_recording(merged) as recording:
        (clock,) = logger_clocks(recording)
        line = replace(clock.alignment.map, covariance=np.diag([2.5e-5, 0.0]))
        bad = replace(clock, alignment=replace(clock.alignment, map=line))
        write_recording(tmp_path / "bad.nc", recording.channels.values(), attributes=clock_attributes([bad]))
    trial = load_trial("stan-tug-1205", "short")
    good, poor = (measure(path, trial).signals for path in (merged, tmp_path / "bad.nc"))
    (finding,) = set(poor.findings) - set(good.findings)
    assert finding.startswith("The clock of shaft.nc is known to 5 ms only: parameters may be off by up to ")


@pytest.mark.slow
def test_the_fingerprint_of_the_merged_recording_is_that_of_one_logger(merged, short_trip, short_campaign, identified):
    one, two = (identified(path, short_campaign).fit for path in (short_trip.path, merged))
    for a, b in zip(one.parameters, two.parameters, strict=True):
        assert b.value == pytest.approx(a.value, abs=0.5 * a.std), a.name


def test_what_cannot_be_aligned_is_said(loggers, tmp_path):
    def merge(shared, *more):
        paths = [str(loggers / "bridge.nc"), str(loggers / "shaft.nc")]
        arguments = ["merge", *paths, "--shared", shared, "-o", str(tmp_path / "x.nc"), *more]
        return CliRunner().invoke(shaftprint, arguments, catch_exceptions=False)

    for shared, code, words in (
        ("PTM_e", 2, "expected CHANNEL=CHANNEL"),
        ("PTM_e=PTM_9", 1, 'expected a channel "PTM_9"'),
        # raw pulses of two shafts, without the vessel file that says so
        ("PTM_e=PTM_1", 1, "channels PTM_e and PTM_1"),
    ):
        result = merge(shared)
        assert (result.exit_code, words in result.output) == (code, True), result.output
    assert not (tmp_path / "x.nc").exists()


def test_parts_of_one_logger_are_joined(short_trip, tmp_path):
    with read_recording(short_trip.path) as recording:
        for number, (first, last) in enumerate(((0.0, 0.4), (0.4, 1.0)), start=1):
            parts = []
            for channel in recording.channels.values():
                start, stop = (int(share * channel.count) for share in (first, last))
                cut = replace(
                    channel,
                    start_s=channel.start_s + start / channel.rate_hz,
                    count=stop - start,
                    source=lambda a, b, start=start, source=channel.source: source(a + start, b + start),
                )
                parts.append(cut)
            write_recording(tmp_path / f"{number}.nc", parts)
        arguments = ["join", *(str(tmp_path / f"{n}.nc") for n in (1, 2)), "-o", str(tmp_path / "whole.nc")]
        result = CliRunner().invoke(shaftprint, arguments, catch_exceptions=False)
        assert result.exit_code == 0, result.output
        with read_recording(tmp_path / "whole.nc") as whole:
            for name, channel in recording.channels.items():
                np.testing.assert_array_equal(
                    whole.channel(name).read(0, channel.count), channel.read(0, channel.count)
                )
