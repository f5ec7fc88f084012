"""Item A6: no traceback for what a damaged or hostile file holds, or for an argument that is None.

Here: byte and variable-length strings as a channel, a covariance that is not square and whatever else may stand in the
place of numbers in a fingerprint, and None for an argument of a public function.
"""

import inspect
import os

import h5py
import numpy as np
import pytest

import shaftprint
from shaftprint.errors import FingerprintError, RecordingError, ShaftprintError, SignalError
from shaftprint.fingerprint import read_fingerprint
from shaftprint.recording import Channel, read_recording, write_recording
from shaftprint.signals import prepare_signals

# every how many-th mutation of the fingerprint is tried; 1 for all
STRIDE = max(1, 40 // int(os.environ.get("SHAFTPRINT_EXAMPLES", "25")))

# channels


def native_with(path, name, data, **kind):
    values = np.arange(500.0)
    channel = Channel(name="M_s", unit="V", rate_hz=100.0, start_s=0.0, count=500, source=lambda a, b: values[a:b])
    write_recording(path, [channel])
    with h5py.File(path, "r+") as file:
        group = next(iter(file.values()))
        made = group.create_dataset(name, data=data, **kind)
        for key in ("units", "sample_rate_hz", "start_s", "scale_factor", "add_offset"):
            if key in group["M_s"].attrs:
                made.attrs[key] = group["M_s"].attrs[key]


ODD = {
    "bytes": (np.array([b"ab", b"cd"] * 250), {}),
    "variable strings": (["a", "bc"] * 250, {"dtype": h5py.string_dtype()}),
    "variable rows": (None, {"shape": (500,), "dtype": h5py.vlen_dtype(np.float64)}),
    "pairs": (np.zeros(500, dtype=[("x", "f8"), ("y", "f8")]), {}),
    "complex": (np.zeros(500, dtype=complex), {}),
    "truth": (np.zeros(500, dtype=bool), {}),
    "a table": (np.zeros((500, 2)), {}),
    "one number": (np.float64(3.0), {}),
    "references": (None, {"shape": (500,), "dtype": h5py.ref_dtype}),
    "nothing": (None, {"dtype": "f8", "shape": None}),
}


@pytest.mark.parametrize("odd", ODD)
@pytest.mark.parametrize("command", ["inspect", "convert"])
def test_a_channel_that_is_no_row_of_numbers(odd, command, run, tmp_path):
    data, kind = ODD[odd]
    path = tmp_path / "odd.nc"
    native_with(path, "odd", h5py.Empty("f8") if odd == "nothing" else data, **({} if odd == "nothing" else kind))
    more = ("-o", tmp_path / "out.nc") if command == "convert" else ()
    result = run(command, path, *more)
    assert result.exit_code == 1
    assert "channel odd" in result.stderr
    assert "expected a row of numbers" in result.stderr
    assert not (tmp_path / "out.nc").exists()


@pytest.mark.parametrize("odd", ODD)
def test_such_a_vector_in_a_file_of_another_program_is_left_out(odd, run, tmp_path):
    data, kind = ODD[odd]
    path = tmp_path / "odd.h5"
    with h5py.File(path, "w") as file:
        file["time"], file["M_s"] = np.arange(500) / 100.0, np.arange(500.0)
        file.create_dataset(
            "odd", data=h5py.Empty("f8") if odd == "nothing" else data, **kind if odd != "nothing" else {}
        )
    try:
        with read_recording(path) as opened:
            for channel in opened.channels.values():
                assert np.isfinite(channel.values(0, 10)).all()
    except RecordingError as error:
        assert str(path) in str(error)  # noqa: PT017 - either is right


# fingerprints


def places_of_lists(content, place=()):
    """Give the place of everything that is a list or a number in JSON."""
    if isinstance(content, dict):
        for key, value in content.items():
            yield from places_of_lists(value, (*place, key))
    elif isinstance(content, list):
        yield place
        for i, value in enumerate(content[:2]):
            yield from places_of_lists(value, (*place, i))
    elif isinstance(content, int | float) and not isinstance(content, bool):
        yield place


ODD_VALUES = (
    [], [[]], [1.0], [[1.0], [1.0, 2.0]], ["x", "y"], [None], [[[1.0]]], [{}], {}, "x", "nan", None, True, 1e400, -1.0,
    [float("nan")] * 3, 10**400,
)  # fmt: skip
COMMANDS = (
    ("show", "{0}"),
    ("export", "json", "{0}", "-o", "{1}/o.json", "--force"),
    ("export", "csv", "{0}", "-o", "{1}/o.csv", "--force"),
    ("export", "ssp", "{0}", "-o", "{1}/o.ssv", "--force"),
)
SLOW_COMMANDS = (
    ("export", "fmu", "{0}", "-o", "{1}/o.fmu", "--source-only", "--force", "--sample", "2"),
    ("export", "matlab", "{0}", "-o", "{1}/o.mat", "--force"),
    ("export", "modelica", "{0}", "-o", "{1}/o.mo", "--force"),
    ("export", "osp", "{0}", "-o", "{1}/o.fmu", "--force"),
    ("simulate", "--fingerprint", "{0}", "--campaign", "short", "--between", "0", "20", "-o", "{1}/s.csv", "--force"),
)


def put(content, place, value):
    for key in place[:-1]:
        content = content[key]
    content[place[-1]] = value


def ends_in_a_sentence(run, command, path, folder):
    """The command ends well, or with one sentence; an error that is not foreseen comes through and fails the test."""
    result = run(*(part.format(path, folder) for part in command))
    assert result.exit_code in (0, 1, 2)
    if result.exit_code:
        assert result.stderr.startswith(("Error: ", "Usage: "))
        assert "Traceback" not in result.stderr


@pytest.mark.slow
def test_whatever_stands_in_the_place_of_numbers(run, forged, fingerprint_text, tmp_path):
    import json

    content = json.loads(fingerprint_text)
    cases = [(place, value) for place in places_of_lists(content) for value in ODD_VALUES]
    assert len(cases) > 1000
    accepted = 0
    # first every case through the reader, then a share of those that it takes through the commands
    for place, value in cases[:: STRIDE * 14 + 1]:
        path = forged(lambda found, place=place, value=value: put(found, place, value))
        try:
            read_fingerprint(path)
        except FingerprintError as error:
            assert str(path) in str(error)  # noqa: PT017 - refused with a sentence, or read
            continue
        accepted += 1
        commands = COMMANDS if accepted % 8 else (*COMMANDS, *SLOW_COMMANDS)
        for command in commands[accepted % 2 :: 2]:
            ends_in_a_sentence(run, command, path, tmp_path)
    assert accepted > 0


@pytest.mark.parametrize(
    "change",
    [
        lambda rows: rows[0].pop(),
        lambda rows: rows[0].append(1.0),
        lambda rows: rows.pop(),
        lambda rows: rows.append(rows[0]),
        lambda rows: rows.clear(),
        lambda rows: rows.insert(0, []),
    ],
)
def test_a_covariance_that_is_not_square(change, run, forged, tmp_path):
    path = forged(lambda content: change(content["covariance"]))
    for command in (*COMMANDS, *SLOW_COMMANDS):
        result = run(*(part.format(path, tmp_path) for part in command))
        assert result.exit_code == 1
        assert "covariance: expected" in result.stderr
        assert "one for each parameter" in result.stderr


@pytest.mark.parametrize("sign", [-1.0, 0.0, "NaN", "Infinity"])
def test_a_covariance_that_is_none(sign, run, forged, tmp_path):
    def change(content):
        rows = content["covariance"]
        for place in range(len(rows)):
            rows[place][place] = sign

    path = forged(change)
    for command in (*COMMANDS, *SLOW_COMMANDS):
        ends_in_a_sentence(run, command, path, tmp_path)


# None


def test_signals_of_a_recording_without_vessel_and_campaign(demo):
    with (
        read_recording(demo[0] / "recording.nc") as opened,
        pytest.raises(
            SignalError, match=r"prepare_signals: expected vessel \(Vessel\) and campaign \(Campaign\), found"
        ),
    ):
        prepare_signals(opened, None, None)


VERBS = {
    "vessel": ["load_vessel"],
    "campaign": ["load_campaign", "setpoint"],
    "recording": ["read_recording"],
    "signals": ["prepare_signals"],
    "spectra": ["estimate_response", "estimate_spectra"],
    "identify": ["identify", "assess", "compare_structures"],
    "time_domain": ["identify_in_time"],
    "simulation": ["simulate"],
    "validation": ["validate"],
    "fingerprint": ["take_fingerprint", "read_fingerprint"],
    "tug": ["sail"],
    "export": [
        "exported_model", "write_fmu", "write_matlab", "write_modelica", "write_ssv", "write_osp", "write_csv",
        "write_json",
    ],
    "report": ["render_report"],
}  # fmt: skip


@pytest.mark.parametrize(("room", "verb"), [(room, verb) for room, verbs in VERBS.items() for verb in verbs])
def test_none_is_refused_by_name(room, verb):
    import importlib

    function = getattr(importlib.import_module(f"{shaftprint.__name__}.{room}"), verb)
    needed = [
        parameter
        for parameter in inspect.signature(function).parameters.values()
        if parameter.default is parameter.empty and parameter.kind is not parameter.VAR_KEYWORD
    ]
    by_place = [None for parameter in needed if parameter.kind is not parameter.KEYWORD_ONLY]
    by_name = {parameter.name: None for parameter in needed if parameter.kind is parameter.KEYWORD_ONLY}
    with pytest.raises(ShaftprintError, match=rf"^{verb}: expected .*, found None") as caught:
        function(*by_place, **by_name)
    assert all(parameter.name in str(caught.value) for parameter in needed)
