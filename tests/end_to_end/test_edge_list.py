"""A test of the tug whose speed is in the list of a logic analyser or counter card, beside the logger's recording."""

import numpy as np
import pytest
from click.testing import CliRunner

from shaftprint.cli import shaftprint
from shaftprint.clocks import logger_clocks
from shaftprint.recording import read_recording, write_recording
from shaftprint.vessel import Vessel

pytestmark = pytest.mark.slow


def edges_of(channel):
    """When a channel goes through the middle of its pulses [s], and the level behind each; no two within 3 ms."""
    volts = channel.values(0, channel.count) - 2.5
    before = np.flatnonzero((volts[:-1] < 0.0) != (volts[1:] < 0.0))
    time = channel.start_s + (before - volts[before] / (volts[before + 1] - volts[before])) / channel.rate_hz
    time = time[np.diff(time, prepend=-1.0) > 0.003]
    return time, np.arange(time.size) % 2 == 0


@pytest.fixture(scope="module")
def logged(short_trip, tmp_path_factory):
    """The recording of a logger without the pick-up of four strips, and the edges of that pick-up."""
    folder = tmp_path_factory.mktemp("edges")
    with read_recording(short_trip.path) as recording:
        write_recording(folder / "log.nc", [recording.channel(name) for name in ("U_setpoint", "PTM_e", "M_s")])
        edge_s, is_high = edges_of(recording.channel("PTM_4"))
    return folder, edge_s, is_high


def written(path, edge_s, is_high):
    rows = [f"{time:.9f}, {int(level)}" for time, level in zip(edge_s.tolist(), is_high.tolist(), strict=True)]
    path.write_text("\n".join(["Time[s], PTM_4", f"{edge_s[0] - 0.01:.9f}, 0", *rows]) + "\n", encoding="utf-8")
    return path


def merged(*arguments):
    result = CliRunner().invoke(shaftprint, ["merge", *map(str, arguments)], catch_exceptions=False)
    assert result.exit_code == 0, result.output


def test_edges_on_the_clock_of_the_logger_give_the_response_of_the_pick_up(
    logged, vessel, short_trip, short_campaign, identified
):
    folder, edge_s, is_high = logged
    listed = written(folder / "digital.csv", edge_s, is_high)
    merged(folder / "log.nc", listed, "--same-clock", "-o", folder / "test.nc")
    content = vessel.model_dump()
    content["sensors"]["speed"] = [one for one in content["sensors"]["speed"] if one["channel"] == "PTM_4"]
    ship = Vessel.model_validate(content)
    sampled = identified(short_trip.path, short_campaign, ship=ship)
    found = identified(folder / "test.nc", short_campaign, ship=ship)
    one, other = sampled.spectra.response, found.spectra.response
    assert other.lines == one.lines
    used = one.used & other.used
    assert used.sum() == one.used.sum()
    variance = np.diagonal(one.covariance, axis1=1, axis2=2)
    std = np.sqrt(variance[:, :2] + variance[:, 2:])
    apart = np.abs(other.response[:, 0] - one.response[:, 0]).T[used] / std[used]
    assert apart.max() < 0.1
    tau = next(one for one in found.fit.parameters if one.name == "tau_dn")
    assert tau.value == pytest.approx(short_trip.truth.normalised["tau_dn"], abs=3.0 * tau.std)


def test_edges_on_a_clock_of_their_own_are_brought_onto_that_of_the_logger(logged):
    folder, edge_s, is_high = logged
    # begun 3 s later, and 20 parts in a million slow
    listed = written(folder / "analyser.csv", (edge_s[100:] - 3.0) * (1.0 - 20e-6), is_high[100:])
    output = folder / "merged.nc"
    merged(folder / "log.nc", listed, "--shared", "PTM_e=PTM_4", "--vessel", "stan-tug-1205", "-o", output)
    with read_recording(output) as recording:
        (clock,) = logger_clocks(recording)
    own_s = np.array([50.0, 800.0])
    errors = clock.alignment.map.reference_s(own_s) - (own_s / (1.0 - 20e-6) + 3.0)
    assert np.abs(errors).max() < 1e-3


def test_how_the_clocks_stand_must_be_said_in_one_way(logged):
    folder, edge_s, is_high = logged
    listed = written(folder / "twice.csv", edge_s, is_high)
    for more in ([], ["--same-clock", "--shared", "PTM_e=PTM_4"]):
        arguments = ["merge", folder / "log.nc", listed, "-o", folder / "no.nc", *more]
        result = CliRunner().invoke(shaftprint, list(map(str, arguments)))
        assert result.exit_code == 2
        assert "expected one of --shared and --same-clock" in result.output
        assert not (folder / "no.nc").exists()
