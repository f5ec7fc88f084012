"""Blocks of the pages in other languages: settings load, models parse, MATLAB runs, included files are there."""

import functools
import json
import re
import shutil
import subprocess
import tomllib
from importlib.metadata import EntryPoint
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from benchmarks.result_tables import read_between_marks, read_rows, shown_table, whole_text, write_between_marks
from click.testing import CliRunner
from pages import PAGES, ROOT, blocks, dialogue, python_of, shown
from tests.wrong_recordings import __main__ as wrong_recordings

from shaftprint.bench import equipped
from shaftprint.campaign import Campaign, CampaignOfBoth, load_campaign
from shaftprint.cli import shaftprint
from shaftprint.drive import Drive
from shaftprint.export import exported_model, write_matlab
from shaftprint.fingerprint import read_fingerprint
from shaftprint.propeller import four_quadrants
from shaftprint.recording import read_recording
from shaftprint.recording.readers import _outside
from shaftprint.vessel import load_vessel

OCTAVE = shutil.which("octave-cli") or shutil.which("octave")
needs_octave = pytest.mark.skipif(OCTAVE is None, reason="Octave runs MATLAB's lines; apt-get install octave")
# Octave has no timetables, no strings and no files of version 7.3: these stand for them where a page uses them. A
# string is a word of letters, of which a loop takes one after the other.
STAND_INS = {
    "seconds.m": "function y = seconds(x)\n  y = x;\nend\n",
    "string.m": "function y = string(x)\n  y = [x{:}];\nend\n",
}
TIMETABLE = """
tt.Properties.RowTimes = (100:0.25:110)';
tt.Properties.VariableNames = {'n', 'M'};
tt.n = (1:41)';
tt.M = 2 * (1:41)';
"""


def of(kind):
    """Return page and text of every block of a kind."""
    found = [(page, text) for page in PAGES for name, text in blocks(page) if name == kind]
    return [pytest.param(page, text, id=f"{page} {number}") for number, (page, text) in enumerate(found)]


def octave(folder, text):
    """Run lines in a folder."""
    command = [OCTAVE, "--no-gui", "--quiet", "--norc", "--eval", text]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


@functools.cache
def octave_draws():
    """Whether Octave has what it needs for a figure, which its package only recommends."""
    draw = [OCTAVE, "--no-gui", "--quiet", "--norc", "--eval", "figure('visible', 'off'); axes;"]
    return subprocess.run(draw, capture_output=True, check=False).returncode == 0


@pytest.fixture
def acme(tmp_path, monkeypatch):
    """The package of the page on formats, installed as its toml says."""
    page = "docs/formats.md"
    (tmp_path / "acme_reader.py").write_text("\n".join(python_of(page)), encoding="utf-8")
    monkeypatch.syspath_prepend(str(tmp_path))
    ((_, text),) = (block for block in blocks(page) if block[0] == "toml")
    groups = tomllib.loads(text)["project"]["entry-points"]
    points = [EntryPoint(name, value, group) for group, found in groups.items() for name, value in found.items()]
    monkeypatch.setattr(_outside, "entry_points", lambda group: [point for point in points if point.group == group])
    _outside._functions.cache_clear()
    yield tmp_path
    _outside._functions.cache_clear()


def test_a_reader_that_a_package_names_so_is_used(acme):
    np.arange(3000, dtype="<f4").tofile(acme / "log.acme")
    with read_recording(acme / "log.acme") as recording:
        assert recording.format == "ACME logger"
        torque = recording.channel("M_s")
        assert (torque.unit, torque.rate_hz, torque.count) == ("N m", 1000.0, 3000)
        assert torque.values(10, 12).tolist() == [10.0, 11.0]


def test_toml_is_of_a_page_with_a_check_of_its_own():
    known = {
        "docs/astern.md",
        "docs/both-shafts.md",
        "docs/drives.md",
        "docs/formats.md",
        "docs/legs.md",
        "docs/pitch.md",
        "docs/serve.md",
    }
    assert {page.values[0] for page in of("toml")} == known


def test_the_dialogue_of_the_page_on_a_german_csv_is_that_of_its_file(tmp_path, monkeypatch):
    page = "docs/tutorials/german-csv.md"
    title, *rows = shown(page).splitlines()
    # the rows of the page, then as many in their manner that a clock and both pick-ups are seen
    for place in range(3, 4000):
        engine, shaft = ("4,2000" if (hz * place / 2000) % 1.0 < 0.1 else "0,3500" for hz in (20.0, 22.2))
        clock = f"20.11.2026 09:30:{place // 2000:02d},{place % 2000 * 5:04d}"
        rows.append(f"{clock};12,0000;{engine};{shaft};3,451250")
    (tmp_path / "log.csv").write_text("\n".join([title, *rows]), encoding="cp1252")
    monkeypatch.chdir(tmp_path)
    typed = dialogue(page)
    result = CliRunner().invoke(shaftprint, ["start"], input="".join(f"{answer}\n" for _, answer in typed))
    assert result.exit_code == 0, result.output
    # all answers are taken, each by its question
    places = [result.output.index(f"{question}:") for question, _ in typed]
    assert places == sorted(places)
    sensors = load_vessel(tmp_path / "vessel.toml").sensors
    assert [(one.channel, one.pulses_per_revolution) for one in sensors.speed] == [
        ("Drehzahl Motor", 1),
        ("Drehzahl Welle", 4),
    ]
    assert (sensors.shaft_torque.channel, sensors.shaft_torque.unit) == ("Drehmoment", "kN m")
    assert sensors.set_point.asked_rpm(sensors.set_point.volts(12.0)) == pytest.approx((620 + 1810) / 2)
    with read_recording(tmp_path / "log.csv") as recording:
        assert recording.channel("Drehmoment").values(0, 2).tolist() == [3.80625, 3.474687]
        assert recording.began.isoformat() == "2026-11-20T09:30:00"


def test_the_campaign_of_the_page_on_legs_is_one():
    ((_, text),) = (block for block in blocks("docs/legs.md") if block[0] == "toml")
    campaign = Campaign.model_validate(tomllib.loads(text))
    # as its comments say
    multisine, binary = campaign.legs
    assert (multisine.periods, binary.length_of_period_s) == (4, 126 * 0.25)


def test_the_multisine_of_the_page_on_a_pitch_is_the_shipped_one():
    ((_, text),) = (block for block in blocks("docs/pitch.md") if block[0] == "toml")
    (multisine,) = tomllib.loads(text)["multisines"]
    shipped = next(one for one in load_campaign("pitch").multisines if one.name == multisine["name"]).model_dump()
    for name, value in multisine.items():
        # the page shows the first lines of many
        assert value == (list(shipped[name])[: len(value)] if isinstance(value, list) else shipped[name])


def test_the_vessel_file_of_the_page_on_tests_astern_is_the_shipped_one():
    ((_, text),) = (block for block in blocks("docs/astern.md") if block[0] == "toml")
    shipped = load_vessel("stan-tug-1205-astern").model_dump(exclude_none=True)
    for table, fields in tomllib.loads(text).items():
        assert fields.items() <= shipped[table].items()


def test_the_table_of_the_page_on_tests_astern_is_that_of_the_series():
    page = (ROOT / "docs/astern.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| (\d\.\d) \| (.*) \|$", page, flags=re.MULTILINE)
    curve = four_quadrants(blades=4, area_ratio=0.7)
    assert len(rows) == 5
    for pitch, numbers in rows:
        ahead, astern = (curve.bollard(float(pitch), astern=way) for way in (False, True))
        expected = [ahead.thrust, astern.thrust, astern.thrust / ahead.thrust]
        expected += [ahead.torque, astern.torque, astern.torque / ahead.torque]
        found = [float(number) for number in numbers.split(" | ")]
        assert found == pytest.approx(expected, abs=0.0051)
        assert found[3:5] == pytest.approx(expected[3:5], abs=6e-5)


def test_the_campaign_of_the_page_on_both_shafts_is_one():
    ((_, text),) = (block for block in blocks("docs/both-shafts.md") if block[0] == "toml")
    campaign = CampaignOfBoth.model_validate(tomllib.loads(text))
    port, starboard = (side.multisines[0] for side in campaign.sides)
    assert campaign.excited == "at once"
    assert not {*port.harmonics} & {*starboard.harmonics}


def test_the_users_of_the_page_on_the_server_can_be_read(tmp_path):
    users = pytest.importorskip("shaftprint.web.access._users")
    password = pytest.importorskip("shaftprint.web.access._password")
    alerts, text = (text for kind, text in blocks("docs/serve.md") if kind == "toml")
    (tmp_path / "alerts.toml").write_text(alerts, encoding="utf-8")
    (tmp_path / "alerts.toml").chmod(0o600)
    assert (
        pytest.importorskip("shaftprint.web._alerts").read_alerts(tmp_path / "alerts.toml").pages
        == "https://yard.example"
    )
    hashed = password.hashed("twelve letters")
    (tmp_path / "users.toml").write_text(text.replace("$argon2id$...", hashed), encoding="utf-8")
    (anna,) = users.read_users(tmp_path / "users.toml").values()
    assert (anna.role.name, anna.ships) == ("TESTER", ("9074729",))
    assert password.is_right("twelve letters", anna.password)


def test_the_drives_of_their_page_have_structures():
    tables = (tomllib.loads(text) for kind, text in blocks("docs/drives.md") if kind == "toml")
    first, second, rows, responses, estimated = tables
    loaded, fan, apart = (equipped(Drive.model_validate(one)) for one in (first, second, first | rows))
    assert (loaded.structure.name, loaded.priors["R"].std) == ("LOADED-MOTOR", 0.05)
    assert fan.structure.names == ("K", "T")
    assert equipped(Drive.model_validate(second | responses)).drive.responses[0].columns == (
        "f",
        "gain",
        "phase",
        "deviation",
    )
    sines = equipped(Drive.model_validate(second | estimated)).drive.frequency_response
    assert (sines.excitation, sines.highest_hz) == ("sine", 20.0)
    (row,) = apart.drive.per_record
    assert (row.label("brass_step"), row.label("steel_chirp, slow"), row.label("bare")) == ("brass", "steel", "bare")


def test_json_loads():
    for page in of("json"):
        assert json.loads(page.values[1])


@pytest.mark.parametrize(("page", "text"), of("xml"))
def test_xml_connects_what_the_export_has(page, text):
    # our own page
    root = ET.fromstring(f"<page>{text}</page>")  # noqa: S314
    named = {entry.get("name") for entry in root.iter() if entry.get("simulator") == "line"}
    assert named
    # variables and groups that the exports of the pages' commands are tested to have
    assert named <= {"engine_speed_set_point", "engine_speed", "shaft_torque"}


@pytest.mark.parametrize(("page", "text"), of("modelica"))
def test_modelica_parses_and_names_what_the_export_has(page, text):
    parser = pytest.importorskip("pymoca.parser", reason="pymoca reads Modelica")
    # lines of a script are statements of a function; the exports are tested to have the rest
    tree = parser.parse(f"function script\nalgorithm\n{text}end script;\n", bypass_cache=True)
    assert len(tree.classes["script"].statements) == 3
    assert re.findall(r"Tug\.\w+", text) == ["Tug.mo", "Tug.Step"]
    assert set(re.findall(r"line\.(\w+)", text)) == {"engine_speed", "shaft_torque"}


@needs_octave
def test_matlab_of_the_page_on_exports_runs(demo, tmp_path):
    if not octave_draws():
        pytest.skip("Octave draws no figure here; apt-get install gnuplot-nox fonts-freefont-otf")
    ((_, text),) = (block for block in blocks("docs/export-formats.md") if block[0] == "matlab")
    fingerprint = read_fingerprint(demo[0] / "fingerprint.json")
    model = exported_model(fingerprint)
    write_matlab(model, tmp_path / "tug.mat")
    save = "re = real(response); im = imag(response); save('-v6', 'out.mat', 're', 'im', 'omega');"
    octave(tmp_path, f"set(0, 'defaultfigurevisible', 'off');\n{text}\nassert(isstruct(model));\n{save}\n")
    from scipy.io import loadmat

    found = loadmat(tmp_path / "out.mat")
    assert found["omega"].ravel().tolist() == [0.5, 1.0, 2.0]
    expected = model.structure.response(model.values, 1j * np.array([0.5, 1.0, 2.0]))
    response = (found["re"] + 1j * found["im"]).reshape(expected.shape)
    np.testing.assert_allclose(response, expected, rtol=1e-9)


@needs_octave
def test_matlab_of_the_page_on_formats_writes_what_is_read(tmp_path):
    ((_, text),) = (block for block in blocks("docs/formats.md") if block[0] == "matlab")
    for name, content in STAND_INS.items():
        (tmp_path / name).write_text(content, encoding="utf-8")
    assert "'-v7.3'" in text
    octave(tmp_path, TIMETABLE + text.replace("'-v7.3'", "'-v7'"))
    with read_recording(tmp_path / "plain.mat") as recording:
        assert set(recording.channels) == {"n", "M"}
        for name, factor in (("n", 1.0), ("M", 2.0)):
            channel = recording.channel(name)
            assert (channel.rate_hz, channel.start_s, channel.count) == (4.0, 0.0, 41)
            assert channel.values(0, 41).tolist() == [factor * i for i in range(1, 42)]


def test_matlab_is_of_pages_with_a_check_of_their_own():
    assert sorted(page.values[0] for page in of("matlab")) == ["docs/export-formats.md", "docs/formats.md"]


def test_every_page_is_in_one_table_of_contents():
    listed = []
    for page, text in (found.values for found in of("{toctree}")):
        folder = (ROOT / page).parent
        entries = [re.sub(r".*<(.*)>", r"\1", line) for line in text.splitlines() if line and not line.startswith(":")]
        listed += [path.relative_to(ROOT).as_posix() for entry in entries for path in folder.glob(f"{entry}.md")]
    assert sorted(listed) == sorted(page for page in PAGES if page.startswith("docs/") and page != "docs/index.md")


@pytest.mark.parametrize(("page", "text"), of("{toctree}"))
def test_pages_of_a_table_of_contents_exist(page, text):
    folder = (ROOT / page).parent
    entries = [re.sub(r".*<(.*)>", r"\1", line) for line in text.splitlines() if line and not line.startswith(":")]
    assert entries
    for entry in entries:
        if not entry.startswith("generated/"):
            assert list(folder.glob(f"{entry}.md")), entry


@pytest.mark.parametrize("page", [page for page in PAGES if "{literalinclude}" in PAGES[page]])
def test_parts_of_examples_that_a_page_includes_are_there(page):
    for kind, text in blocks(page):
        if kind.startswith("{literalinclude}"):
            path = (ROOT / page).parent / kind.split()[1]
            # every example is run by tests/examples or tests/cli
            assert path.resolve().parent == ROOT / "examples"
            options = dict(re.findall(r"^:([\w-]+): (.*)$", text, flags=re.MULTILINE))
            assert set(options) <= {"start-at", "end-before"}
            first, last = (options.get(name, "").strip('"') for name in ("start-at", "end-before"))
            source = path.read_text(encoding="utf-8")
            assert first in source
            assert last in source[source.index(first) :]


RESULTS = sorted((ROOT / "docs" / "results").glob("*.tsv"))
# A cell that begins so would be a list, a quotation, a heading or code.
OF_A_BLOCK = re.compile(r"[-*+] |[-*+]$|\d+[.)](?:\s|$)|>|#|```|~~~|\s")


def test_every_table_of_results_is_shown_or_linked_by_a_page():
    shown = {
        ((ROOT / page).parent / name).resolve()
        for page, text in PAGES.items()
        for name in re.findall(r"(?:^:file: |\]\()([\w./-]+\.tsv)\b", text, flags=re.MULTILINE)
    }
    assert shown == set(RESULTS)


@pytest.mark.parametrize("path", RESULTS, ids=lambda path: path.stem)
def test_a_table_of_results_has_rows_of_one_length_whose_cells_are_lines(path):
    head, *rows = read_rows(path)
    assert rows
    for row in (head, *rows):
        assert len(row) == len(head), row
        assert not [cell for cell in row if OF_A_BLOCK.match(cell) or "\n" in cell]


@pytest.mark.parametrize(("page", "text"), of("{csv-table}"))
def test_a_table_of_results_is_shown_as_it_is_written(page, text):
    name = re.search(r"^:file: (.*)$", text, flags=re.MULTILINE)[1]
    assert f"```{{csv-table}}\n{text}```" == shown_table(name), page


def test_tables_of_a_benchmark_go_beside_their_page_and_come_back(tmp_path):
    page, begin, end = tmp_path / "page.md", "<!-- table of benchmarks/x.py: begin -->", "<!-- x: end -->"
    page.write_text(f"# Page\n\n{begin}\nold\n{end}\n\nmore\n", encoding="utf-8")
    rows = "".join(f"| {i} | - |\n" for i in range(41))
    text = f'### Short\n\n| a | b |\n|---|---|\n| 1, "2" | `3\t4` |\n\nSaid.\n\n| c | d |\n|---|---|\n{rows}'
    write_between_marks(page, text, begin, end)
    assert "| a |" not in page.read_text(encoding="utf-8")
    assert "[All 41 rows](results/x-2.tsv)" in page.read_text(encoding="utf-8")
    assert read_rows(tmp_path / "results" / "x-1.tsv") == [["a", "b"], ['1, "2"', "`3\t4`"]]
    back = read_between_marks(page, begin, end)
    assert back.strip() == text.replace("| - |", "| \u2013 |").strip()
    assert page.read_text(encoding="utf-8").endswith(f"{end}\n\nmore\n")
    write_between_marks(page, text.partition("Said.")[0], begin, end)
    assert [path.name for path in (tmp_path / "results").iterdir()] == ["x.tsv"]


def test_the_page_on_wrong_recordings_has_every_case_and_counts_them():
    folder = ROOT / "docs" / "results"
    rows = {test: read_rows(folder / file)[1:] for test, file in wrong_recordings.FILES.items()}
    cases = (wrong_recordings.CASES, wrong_recordings.CASES_OF_LEGS)
    assert [[name for name, _, _ in found] for found in rows.values()] == [[case.name for case in of] for of in cases]
    told = [outcome for found in rows.values() for _, outcome, _ in found]
    assert set(told) == {"refused", "not trusted", "right"}
    page = PAGES["docs/wrong-recordings.md"]
    assert f"{len(told)} cases. Wrong and trusted: 0;" in page
    counted = [[int(n) for n in line.split(" | ")[2:]] for line in re.findall(r"^\| (.+ speeds? \|.+) \|$", page, re.M)]
    assert np.sum(counted, axis=0).tolist() == [len(told), *(told.count(one) for one in wrong_recordings.OUTCOMES)]


ROWS = re.compile(r"^\| (.+?) \| .+ \| \[.+\]\((.+)\) \|$", flags=re.MULTILINE)
TEN = ROWS.findall(PAGES["docs/evidence.md"])
OF_THE_README = [(number, page.removeprefix("docs/")) for number, page in ROWS.findall(PAGES["README.md"])]


def test_there_are_ten_numbers():
    assert len(TEN) == 10
    assert len(OF_THE_README) == 4


@pytest.mark.parametrize(("number", "page"), [*TEN, *OF_THE_README])
def test_a_number_of_the_ten_stands_on_the_page_that_it_names(number, page):
    plain = number.removesuffix(" s").removesuffix(" %")
    told = whole_text(ROOT / "docs" / page, PAGES[f"docs/{page}"])
    assert re.search(rf"(?<![\d.]){re.escape(plain)}(?![\d])", told), number
