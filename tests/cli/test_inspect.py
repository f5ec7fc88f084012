"""``shaftprint inspect`` says what is in a recording; ``tests/docs`` inspects a whole test, as the pages show it."""

import re
from importlib.resources import files

import numpy as np
import pytest

from shaftprint.campaign import load_campaign
from shaftprint.cli._inspect_headline import headline
from shaftprint.recording import RecordingWriter
from shaftprint.spectra import FrequencyResponse, SignalToNoise, Spectra


def _cells(output, first):
    """Return the words of the table row that begins with a word."""
    return next(line.split() for line in output.splitlines() if line.split()[:1] == [first])


def test_channels_alone(run, recording):
    result = run("inspect", recording)
    assert result.exit_code == 0
    assert f"{recording}: shaftprint recording (NetCDF-4), SHA-256 " in result.output
    words = _cells(result.output, "PTM_e")
    assert words[1:6] == ["V", "2000", "0", "to", "860"]
    assert words[-1] == "0"
    assert "Sensors of the vessel file" not in result.output


def test_values_that_are_not_numbers_are_counted(run, tmp_path):
    path = tmp_path / "test.nc"
    with RecordingWriter(path) as writer:
        for name, values in (("half", [1.0, np.nan, 3.0, np.inf]), ("none", [np.nan, np.nan]), ("empty", [])):
            writer.declare(name, unit="V", rate_hz=10.0, dtype="float64")
            writer.append(name, np.array(values))
    output = run("inspect", path).output
    assert _cells(output, "half")[-4:] == ["1", "2", "3", "2"]
    assert _cells(output, "none")[-4:] == ["nan", "nan", "nan", "2"]
    assert _cells(output, "empty")[-4:] == ["nan", "nan", "nan", "0"]


def test_messages_are_judged_without_a_vessel_file(run, tmp_path):
    path = tmp_path / "bus.nc"
    rng = np.random.default_rng(1)
    times = 0.02 * np.arange(5000) + rng.uniform(-0.004, 0.004, 5000)
    times = np.delete(times, [*range(700, 5000, 100), *range(2000, 2050)])
    with RecordingWriter(path) as writer:
        writer.declare("X", unit="%", rate_hz=50.0, offset=-125.0, times="uneven")
        writer.append("X", np.rint(165.0 + 9.0 * np.sin(times)).astype(np.int16), times)
        writer.declare("M_s", unit="V", rate_hz=100.0)
        writer.append("M_s", np.arange(10_000, dtype=np.int16))
    output = run("inspect", path).output
    assert (
        "Channels with times of their own\n"
        "  * X: a message every 20 ms +/- 3.3 ms, 1.8 % lost, 1 hole of up to 1.02 s, steps of 1 %\n"
    ) in output
    assert "M_s: " not in output
    # the proposal takes the period of the sender for the cycle
    assert "cycle_s = 0.02" in output


def test_sensors_with_a_vessel_file(run, recording):
    result = run("inspect", recording, "--vessel", "stan-tug-1205")
    assert result.exit_code == 0
    four = next(line for line in result.output.splitlines() if "PTM_4" in line and "speed" in line)
    # table 3.4 of the thesis, scaled from its printed sum of 360.02 to 360; which strip comes first is not seen
    turned = ["90.40", "87.24", "90.73", "91.63"]
    found = [word.strip(",") for word in four.split() if word.startswith(("9", "8"))]
    assert sorted(float(angle) for angle in found) == pytest.approx(sorted(map(float, turned)), abs=0.02)
    assert "missing pulse" in result.output
    assert "Problems\n  * None." in result.output
    assert "Signal-to-noise" not in result.output


def test_swapped_columns_are_a_problem_without_a_campaign(run, recording, tmp_path):
    text = (recording.parent / "vessel.toml").read_text(encoding="utf-8")
    swapped = text.replace('"PTM_e"', '"?"').replace('"PTM_4"', '"PTM_e"').replace('"?"', '"PTM_4"')
    assert swapped != text
    (tmp_path / "swapped.toml").write_text(swapped, encoding="utf-8")
    result = run("inspect", recording, "--vessel", tmp_path / "swapped.toml")
    assert result.exit_code == 0
    problems = " ".join(result.output.partition("Problems\n")[2].split())
    assert problems.startswith("* channels PTM_4 and PTM_e seem to be swapped: expected one engine speed, found ")
    assert "with n_e = PTM_e, n_e4 = PTM_4 all pick-ups agree" in problems


def test_campaign_without_vessel_is_a_usage_error(run, recording):
    result = run("inspect", recording, "--campaign", "short")
    assert result.exit_code == 2
    assert "--campaign needs --vessel" in result.stderr


def test_campaign_longer_than_the_recording(run, recording):
    result = run("inspect", recording, "--vessel", "stan-tug-1205", "--campaign", "thesis")
    # its work is done, and the answer is no, said once
    assert (result.exit_code, result.stderr) == (3, "")
    assert result.output.startswith("Not good enough. ")
    assert " ".join(result.output.split()).count("found a recording from 0.0 to 860.0 s") == 1
    assert "Sensors of the vessel file" in result.output


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (None, "expected a logger file, found none there"),
        (b"", "expected a logger file, found an empty one"),
        (b"Dear reader, this is a letter.\n", "found none of them"),
    ],
)
def test_file_that_is_no_recording(run, tmp_path, content, message):
    path = tmp_path / "test.dat"
    if content is not None:
        path.write_bytes(content)
    result = run("inspect", path)
    assert result.exit_code == 1
    assert str(path) in result.stderr
    assert message in result.stderr
    assert len(result.stderr.splitlines()) == 1


def test_folder_in_the_place_of_a_recording(run, tmp_path):
    for name in ("vessel.toml", "monday.csv", "index.html"):
        (tmp_path / name).write_text("x\n", encoding="utf-8")
    result = run("inspect", tmp_path)
    assert result.exit_code == 1
    assert "expected a logger file, found a folder; name the file in it: monday.csv." in result.stderr


def test_two_recordings_are_told_how_they_become_one(run, tmp_path):
    result = run("inspect", tmp_path / "a.nc", tmp_path / "b.nc")
    assert result.exit_code == 2
    assert "it takes one recording. `shaftprint join`" in result.stderr


def test_truncated_recording(run, recording, tmp_path):
    path = tmp_path / "cut.nc"
    path.write_bytes(recording.read_bytes()[:1_000_000])
    result = run("inspect", path)
    assert result.exit_code == 1
    assert "damaged or truncated" in result.stderr


def test_channel_that_the_vessel_file_names_is_missing(run, tmp_path):
    path = tmp_path / "test.nc"
    with RecordingWriter(path) as writer:
        writer.declare("speed", unit="V", rate_hz=2000.0, dtype="float64")
        writer.append("speed", np.zeros(4000))
    result = run("inspect", path, "--vessel", "stan-tug-1205")
    assert result.exit_code == 1
    assert "PTM_e" in result.stderr


def _spectra(frequency_hz, local_db, used, torque_db=20.0):
    count = len(frequency_hz)
    lines = tuple(f"S{number}" for number in range(1, count + 1))
    response = FrequencyResponse(
        frequency_hz=np.array(frequency_hz),
        response=np.ones((2, 1, count), dtype=complex),
        covariance=np.broadcast_to(1e-4 * np.eye(4), (count, 4, 4)),
        inputs=("n_set",),
        outputs=("n", "M_s"),
        lines=lines,
        used=np.array(used),
    )
    table = np.column_stack([np.full(count, 80.0), local_db, np.broadcast_to(torque_db, count)])
    ratios = SignalToNoise(lines=lines, channels=("n_set", "n_e", "M_s"), local_db=table, overall=np.ones(3))
    return Spectra(
        response=response,
        windows=(),
        signal_to_noise=ratios,
        harmonics=None,
        load_drift=None,
        speed="n_e",
    )


SIX = [0.01, 0.05, 0.1, 0.3, 0.6, 4.0]


def test_headline_good():
    sentence = headline([_spectra(SIX, [20.0] * 6, [True] * 6)])
    assert sentence == (
        "Good enough: 6 of 6 lines are good, 2 of them between 1 and 12 rad/s, where the loop crosses over."
    )


def test_headline_counts_the_lines_of_all_legs_once():
    leg = _spectra(SIX, [20.0] * 6, [True] * 6)
    other = _spectra(SIX, [20.0] * 6, [True, True, True, False, False, True])
    assert headline([leg, other], planned=12).startswith("Good enough: 10 of 12 lines are good, 2 of them between ")


def test_headline_too_few_lines():
    # of one line speed and torque drown in noise and one is aliased: four are left
    drowned = [20.0, -0.1, 20.0, 20.0, 20.0, 20.0]
    spectra = _spectra(SIX, drowned, [True] * 5 + [False], torque_db=drowned)
    sentence = headline([spectra])
    assert sentence.startswith("Not good enough: 4 of 6 lines are good, ")
    assert "at least 5 are needed. Use a larger amplitude" in sentence
    # of a test that was cut off no amplitude helps
    cut = headline([spectra], planned=10, lost=("S7 and S8 are lost",))
    assert cut.endswith("at least 5 are needed. Not all of the campaign is there: S7 and S8 are lost.")


def test_headline_nothing_at_the_crossover():
    sentence = headline([_spectra([0.01, 0.02, 0.05, 0.1, 0.12, 0.3], [20.0] * 6, [True] * 6)])
    assert sentence.startswith("Not good enough: 6 of 6")
    assert "at least 2 are needed there" in sentence


def test_headline_is_never_good_above_what_is_wrong():
    good = [_spectra(SIX, [20.0] * 6, [True] * 6)]
    assert headline(good, worst="The speed is in doubt.").startswith("Not as it is. The speed is in doubt. ")
    assert headline([], worst="channel P: found no pulses.") == "Not good enough. Channel P: found no pulses."
    assert headline([], worst="log.csv: found no pulses.") == "Not good enough. log.csv: found no pulses."
    partly = headline(good, planned=12, lost=("M2 is lost",))
    assert partly.startswith("Good enough, as far as it goes: 6 of 12 lines ")
    assert partly.endswith("Not all of the campaign is there: M2 is lost.")


@pytest.fixture
def ship(demo, tmp_path):
    """Write the vessel file of the short demo with other words in it."""

    def write(old, new):
        text = (demo[0] / "vessel.toml").read_text(encoding="utf-8")
        assert old in text
        path = tmp_path / "ship.toml"
        path.write_text(text.replace(old, new, 1), encoding="utf-8")
        return path

    return write


def test_a_vessel_file_that_cannot_be_is_not_good_enough(run, demo, ship):
    """The tug has 221 kW: in W it is refused with the number, and of a third the file contradicts itself."""
    files = (demo[0] / "recording.nc", "--campaign", demo[0] / "campaign.toml", "--vessel")
    refused = run("inspect", *files, ship("rated_power_kw = 221", "rated_power_kw = 221000"))
    assert refused.exit_code == 1
    assert "expected rated_power_kw near 2" in refused.stderr
    assert "found 221000; in W?" in refused.stderr
    doubted = run("inspect", *files, ship("rated_power_kw = 221", "rated_power_kw = 70"))
    assert doubted.exit_code == 3
    assert "Not as it is. The vessel file contradicts itself, as said above: correct it first." in " ".join(
        doubted.output.split()
    )


def test_another_rate_and_another_ship_than_the_recording_says_are_said(run, demo, ship):
    """The demo is logged at 2000 Hz on the Stan Tug 1205."""
    said = run("inspect", demo[0] / "recording.nc", "--vessel", ship("sample_rate_hz = 2000", "sample_rate_hz = 1000"))
    assert "logger.sample_rate_hz: 1000 in the vessel file, 2000 Hz in the recording" in " ".join(said.output.split())
    other = ship('name = "Stan Tug 1205, port"', 'name = "Vega"')
    said = run("inspect", demo[0] / "recording.nc", "--vessel", other)
    words = "his recording is of Stan Tug 1205, port, the vessel file of Vega"
    assert f"T{words}." in " ".join(said.output.split())
    text = other.read_text(encoding="utf-8").replace('channel = "PTM_e"', 'channel = "Impuls"')
    other.write_text(text, encoding="utf-8")
    refused = run("inspect", demo[0] / "recording.nc", "--vessel", other)
    assert f'recording.nc: t{words}: expected a channel "Impuls"' in refused.stderr
    for right in ("Not as the vessel file says", "his recording is of"):
        assert right not in run("inspect", demo[0] / "recording.nc", "--vessel", demo[0] / "vessel.toml").output


def test_the_campaign_of_another_test_is_told_with_the_one_that_fits(run, demo, brief_campaign):
    result = run("inspect", demo[0] / "recording.nc", "--vessel", "stan-tug-1205", "--campaign", brief_campaign)
    assert result.exit_code == 3
    words = " ".join(result.stdout.split())
    assert "this is not the campaign of this recording" in words.partition("Channels, raw")[0]
    assert "demo/campaign.toml, which fits: name that." in words.partition("Channels, raw")[0]
    assert "amplifier" not in words


@pytest.mark.slow
def test_proposal_for_a_campaign_whose_times_are_wrong(run, recording, tmp_path):
    """The recording was sailed by `short`: what is proposed in place of a wrong campaign must be that."""
    truth = load_campaign("short")
    text = (files("shaftprint.campaign") / "shipped" / "short.toml").read_text(encoding="utf-8")
    wrong = re.sub(
        r"(start_s|settled_s|stop_s) = ([\d.]+)", lambda match: f"{match[1]} = {float(match[2]) + 2.5:.4g}", text
    )
    wrong = wrong.replace("frequency_hz = 0.8\n", "frequency_hz = 0.83\n").replace("860.0", "870.0")
    path = tmp_path / "wrong.toml"
    path.write_text(wrong, encoding="utf-8")
    result = run("inspect", recording, "--vessel", "stan-tug-1205", "--campaign", path)
    assert "All tests are found 2.500 s earlier than planned." in result.output
    # what is wrong is said once, before the error
    assert " ".join(result.stdout.split()).count("another course in every slow test") <= 1
    head, proposal = result.output.split("in place of those that it has\n\n")
    lines = proposal.split("\n\nSteady state")[0]
    path.write_text(wrong.split("[[staircases]]")[0] + lines, encoding="utf-8")
    found = load_campaign(path)
    assert [test.name for test in found.excitations] == [test.name for test in truth.excitations]
    for test, sailed in zip(found.excitations, truth.excitations, strict=True):
        assert test.start_s == pytest.approx(sailed.start_s, abs=0.02)
        assert test.stop_s == pytest.approx(sailed.stop_s, abs=0.02)
    assert [s.frequency_hz for s in found.sines] == pytest.approx([s.frequency_hz for s in truth.sines], rel=1e-4)
    # with it nothing is left to be said
    again = run("inspect", recording, "--vessel", "stan-tug-1205", "--campaign", path)
    assert "Proposal for the campaign file" not in again.output
    assert "0.83 Hz" in head


def test_jumps_of_the_clock_and_what_is_taken_for_granted_are_said(run, tmp_path):
    path = tmp_path / "log.csv"
    # milliseconds since 1970 that are set back by half a second at row 100
    times = [1_795_000_000_000 + 10 * row - (500 if row >= 100 else 0) for row in range(200)]
    path.write_text("timestamp,M_s [V]\n" + "".join(f"{time},1\n" for time in times))
    output = " ".join(run("inspect", path).output.split())
    assert "At 1 s the times of M_s are set back by 0.5 s." in output
    assert "numbers such as 1.795e+12 were taken for milliseconds since 1970." in output
    assert "Second 0 is 2026-11-18 11:06:40+00:00" in output
    result = run("convert", path, "-o", tmp_path / "out.csv")
    assert "left out the jumps of the clock of M_s: only the native container" in result.output
    assert "left out the date of second 0: 2026-11-18 11:06:40+00:00" in result.output
    assert "taken for milliseconds since 1970" in result.output


def test_a_pick_up_alone_shows_its_speed_from_edges_at_any_rate(run, tmp_path):
    vessel = (files("shaftprint") / "vessel" / "shipped" / "stan_tug_1205.toml").read_text(encoding="utf-8")
    head, _, rest = vessel.partition("[[sensors.speed]]")
    wheel = '[[sensors.speed]]\nname = "n"\nchannel = "Channel 0"\nshaft = "engine"\nunit = "V"\nwheel = "12+1"\n'
    (tmp_path / "mine.toml").write_text(head + wheel + rest[rest.index("\n[sensors.") :], encoding="utf-8")
    # twelve teeth and one between two of them, 60 turns of a starter at 188 rpm; the engine will run at 1183 rpm
    turn_s = 60.0 / 188.0
    teeth = np.sort(np.append(np.arange(12) / 12.0, 0.5 / 12.0))
    rising = ((np.arange(60)[:, None] + teeth).ravel() * turn_s + 0.1).tolist()
    rows = [f"{time:.7f},1\n{time + 0.01 * turn_s:.7f},0\n" for time in rising]
    (tmp_path / "edges.csv").write_text("Time [s],Channel 0\n0.0,0\n" + "".join(rows))
    result = run("inspect", tmp_path / "edges.csv", "--vessel", tmp_path / "mine.toml")
    assert result.exit_code == 0, result.output
    assert "188.00" in next(line for line in result.output.splitlines() if "0 to 1 V" in line)
    output = " ".join(result.output.split())
    assert 'expected a channel "M_s" for the shaft torque' in output
    assert "log at" not in output
    result = run("inspect", tmp_path / "edges.csv", "--vessel", tmp_path / "mine.toml", "--campaign", "short")
    assert result.exit_code == 1
