"""What is wrong with a file ends in one sentence that names it, a non-zero exit code and no output."""

from importlib.resources import files
from re import search, sub

import numpy as np
import pytest
from click.testing import CliRunner

from shaftprint.cli import shaftprint
from shaftprint.errors import ShaftprintError

SHORT = (files("shaftprint.campaign") / "shipped" / "short.toml").read_text(encoding="utf-8")


# name: (how the recording is spoilt, what the sentence says)
RECORDINGS = {
    "missing torque": ({"leave_out": ("M_s",)}, r'expected a channel "M_s" for the shaft torque'),
    "missing pick-up": ({"leave_out": ("PTM_e",)}, r'expected a channel "PTM_e"'),
    "missing set point": ({"leave_out": ("U_setpoint",)}, r'expected a channel "U_setpoint"'),
    "set point that never moves": (
        {"change": lambda x: np.full_like(x, -5.05), "channels": ("U_setpoint",)},
        r"channel U_setpoint: expected a set point that moves by 3 V, found it between -5\.05 and -5\.05 V",
    ),
    "set point of another test": (
        {"change": lambda x: x[::-1].copy(), "channels": ("U_setpoint",)},
        r"channel U_setpoint: this is not the campaign of this recording: .*name the campaign file that belongs to it",
    ),
    "too short": (
        {"change": lambda x: x[:1_000_000]},
        r"structure GAUGE-CLOSED has 12 free parameters, the response 8 usable numbers \(2 lines\)",
    ),
    "dead torque": (
        {"change": lambda x: np.full_like(x, 3.45), "channels": ("M_s",)},
        r"channel M_s: expected the torque to move during St1, found it dead near 1725 N m",
    ),
    "dead pick-up": (
        {"change": lambda x: np.full_like(x, 0.02), "channels": ("PTM_e",)},
        r"channel PTM_e: expected pulses between two levels, found the channel dead",
    ),
    "torque in another unit": (
        {"channels": ("M_s",), "unit": "kN m"},
        r'"?M_s"?.*V.*kN m',
    ),
}


@pytest.fixture
def refused(tmp_path):
    """The sentence with which the command line refuses a recording; nothing is left behind."""

    def run(recording, campaign="short", vessel="stan-tug-1205"):
        before = {place.name for place in tmp_path.iterdir()}
        output = tmp_path / "results"
        arguments = ["identify", str(recording), "--vessel", str(vessel), "--campaign", str(campaign)]
        result = CliRunner().invoke(shaftprint, [*arguments, "--output", str(output), "--no-progress"])
        assert result.exit_code == 1
        assert isinstance(result.exception, SystemExit)
        assert {place.name for place in tmp_path.iterdir()} == before
        assert result.output.startswith("Error: ")
        return result.output.removeprefix("Error: ").strip()

    return run


@pytest.mark.slow
@pytest.mark.parametrize(("spoilt", "sentence"), RECORDINGS.values(), ids=RECORDINGS)
def test_spoilt_recording(spoil, refused, identified, short_campaign, tmp_path, spoilt, sentence):
    path = spoil(tmp_path / "spoilt.nc", **spoilt)
    with pytest.raises(ShaftprintError, match=sentence) as caught:
        identified(path, short_campaign)
    assert "\n" not in str(caught.value)
    assert refused(path) == str(caught.value)


@pytest.mark.slow
@pytest.mark.parametrize("share", [0.999, 0.5, 0.01])
def test_truncated_recording(short_trip, refused, tmp_path, share):
    content = short_trip.path.read_bytes()
    path = tmp_path / "cut.nc"
    path.write_bytes(content[: int(share * len(content))])
    sentence = refused(path)
    assert sentence.startswith(f"{path}: expected a whole shaftprint recording")
    assert "truncated file" in sentence
    assert sentence.endswith("copy it again from the logger.")


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        (b"PK\x03\x04 a document" * 50, "expected one of the formats"),
        (b"", "expected a logger file, found an empty one"),
    ],
)
def test_foreign_recording(refused, tmp_path, content, sentence):
    path = tmp_path / "foreign.nc"
    path.write_bytes(content)
    assert f"{path}: {sentence}" in refused(path)


def test_recording_that_is_not_there(refused, tmp_path):
    path = tmp_path / "none.nc"
    assert refused(path) == f"{path}: expected a logger file, found none there."


def test_truth_of_a_simulation_is_no_recording(short_trip, refused):
    sentence = refused(short_trip.path.with_suffix(".truth.json"))
    assert search(
        r"short\.truth\.json: expected one of the formats .*, found none of them; JSON, as of a result or", sentence
    )


@pytest.mark.slow
def test_campaign_in_rad_per_second(short_trip, refused, tmp_path):
    path = tmp_path / "rad.toml"
    angular = sub(
        r"frequency_hz = ([\d.]+)", lambda match: f"frequency_hz = {2.0 * np.pi * float(match[1]):.6g}", SHORT
    )
    path.write_text(angular, encoding="utf-8")
    sentence = refused(short_trip.path, path)
    assert sentence.startswith("channel U_setpoint: expected the set point of the campaign")
    assert "2 pi times slower: divide the frequencies of the campaign file, which are in rad/s" in sentence


def test_campaign_of_another_test(short_trip, refused):
    assert "expected at least one whole test" in refused(short_trip.path, "thesis")


def test_campaign_with_several_mistakes_names_them_all(short_trip, refused, tmp_path):
    path = tmp_path / "wrong.toml"
    spoilt = SHORT.replace("frequency_hz = 0.02\n", "frequency = 0.02\n").replace("dwell_s = 30.0", "dwell_s = -30.0")
    path.write_text(spoilt, encoding="utf-8")
    sentence = refused(short_trip.path, path)
    assert sentence.startswith(f"{path}: 2 fields cannot be used.")
    for wrong in ("frequency (S1): ", "wanted as frequency_hz", "dwell_s (St1): "):
        assert wrong in sentence


def test_pick_up_with_wrong_number_of_pulses(short_trip, refused, tmp_path):
    """The vessel file says 2 pulses a turn of the engine where there is one: half the speed."""
    shipped = (files("shaftprint.vessel") / "shipped" / "stan_tug_1205.toml").read_text(encoding="utf-8")
    path = tmp_path / "vessel.toml"
    path.write_text(shipped.replace("pulses_per_revolution = 1\n", "pulses_per_revolution = 2\n", 1), encoding="utf-8")
    sentence = refused(short_trip.path, vessel=path)
    assert sentence.startswith("channels PTM_e and PTM_1: expected the same engine-side speed, found n_e1 / n_e = 2.0")
    assert "as with 1 pulse of n_e where 2 are stated, or" in sentence
    assert sentence.endswith("check pulses_per_revolution and gearbox.ratio in the vessel file.")


def test_rack_that_was_not_logged(short_trip, refused):
    """The vessel file names percent torque on the CAN bus, the recording has none."""
    sentence = refused(short_trip.path, vessel="stan-tug-1205-ecu")
    # the recording says of which ship it is, the vessel file is of another variant of it
    assert sentence.startswith(f"{short_trip.path}: this recording is of Stan Tug 1205, port, the vessel file of ")
    assert 'expected a channel "X_percent" for the fuel rack, as the vessel file' in sentence
    assert sentence.endswith("M_s; correct the name there, or take [sensors.rack] out where it was not logged.")
