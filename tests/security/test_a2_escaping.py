"""Item A2: one escaping function for each language that is written, and every writer uses it.

Any text may stand in a name. What is written with it is read by the real parser of its language: it parses, runs
nothing, and the text returns, apart from the documented apostrophe and from characters that are not printed, which
become question marks. ``SHAFTPRINT_EXAMPLES`` sets the number of texts that are tried.
"""

import ast
import csv
import html.parser
import io
import os
import re
import shutil
import subprocess
import tomllib
import unicodedata
import zipfile
from pathlib import Path
from xml.etree import ElementTree as ET

import canmatrix
import canmatrix.formats
import numpy as np
import pytest
from click.testing import CliRunner
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

import shaftprint.cli
from shaftprint import escape
from shaftprint.catalogue import structure
from shaftprint.cli._terminal import echo
from shaftprint.cli.output._layout import table_lines
from shaftprint.digits import plain_letters
from shaftprint.export import ExportedModel, write_fmu, write_matlab, write_modelica, write_osp, write_ssv
from shaftprint.tables import Table, texts

CHROMIUM = Path("/usr/bin/chromium")
EXAMPLES = int(os.environ.get("SHAFTPRINT_EXAMPLES", "25"))

NASTY = (
    "tug **// #include <stdlib.h>\n__attribute__((constructor)) static void pwn(void){ system(\"id\"); } /*",
    "*\\\n/ int x; /*",
    "*??/\n/ #error \"run\"",
    '");system("id");("??/',
    "\\",
    "trailing \\",
    "??=??(??)??'",
    "x'); system('id'); ('",
    "@TITLE@'); system('id'); ('@DATA@",
    "%{\nsystem('id')\n%}",
    "...\nsystem('id')",
    "a\";\nend Line;\nmodel Evil",
    "</p></html>",
    "<script>alert(1)</script>",
    "\"><img src=x onerror=alert(1)>",
    "&amp;&#0;]]><!--",
    "=cmd|' /C calc'!A0",
    "+1",
    "-1+1",
    "@SUM(1)",
    "'=1",
    "\t=1",
    "\r=1",
    "\x1b[2J\x1b]0;owned\x07",
    "\x9b31m",
    "one\nVerdict: trustworthy",
    "[red]alarm[/red]",
    "[/]",
    "[link=http://x]y[/link]\\",
    ":warning:",
    "\x00nul\x01",
    "\ufffe\uffff",
    "\u202eevil\u202c",
    "line\u2028separator",
    "Ærøskøbing ÆØÅ 船 🚢",
    "narrow\u202fspace\u00a0here",
    "",
    " ",
    "two  spaces ",
    "-",
    "$\\frac$",
    "a$b",
    "{0} {x} %s %d %n",
)  # fmt: skip


def any_text(function):
    """Try a function with all nasty texts, and with texts that are drawn."""
    for text in NASTY:
        function = example(text)(function)
    drawn = st.text(alphabet=st.characters(exclude_categories=("Cs",)), max_size=60)
    function = given(drawn)(function)
    relaxed = [HealthCheck.function_scoped_fixture, HealthCheck.too_slow]
    return settings(
        max_examples=EXAMPLES, deadline=None, suppress_health_check=relaxed, database=None, derandomize=True
    )(function)


def seen(text):
    """The text as it may return, by the categories of Unicode: what is not printed is a question mark."""
    hidden = ("Cc", "Cf", "Cs", "Co", "Cn", "Zl", "Zp")
    return "".join("?" if unicodedata.category(letter) in hidden else letter for letter in text)


def model_of(title):
    chosen = structure("GAUGE-CLOSED")
    return ExportedModel(
        title=title, structure=chosen, values=chosen.vector({}), engine_speed_rpm=1183.8, shaft_torque_nm=1740.0
    )


# C


def compiled(folder, source, *more):
    (folder / "text.c").write_bytes(source)
    command = ["cc", "-std=c99", "-trigraphs", "-Wall", "-Werror", "-o", "text", "text.c", *more]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True)


@pytest.mark.skipif(shutil.which("cc") is None, reason="there is no C compiler called cc")
def test_c_gives_every_text_back_and_runs_none(tmp_path):
    """All texts in one program, which writes the bytes that the compiler made of each."""
    drawn = np.random.default_rng(7)
    letters = "\"\\?'/*\n\r%{}()<>#=!-^|&x0é船\x00\x1b"
    random = ["".join(drawn.choice(list(letters), size=40)) for _ in range(10 * EXAMPLES)]
    texts = [*NASTY, *random]
    lines = "".join(f"fwrite({(s := escape.c_string(text))}, 1, sizeof {s}, stdout);\n" for text in texts)
    result = compiled(tmp_path, f"#include <stdio.h>\nint main(void) {{\n{lines}return 0;\n}}\n".encode())
    assert result.returncode == 0, result.stderr
    written = subprocess.run([tmp_path / "text"], capture_output=True).stdout
    assert written.split(b"\0")[:-1] == [seen(text).encode() for text in texts]


@pytest.mark.skipif(shutil.which("cc") is None, reason="there is no C compiler called cc")
@pytest.mark.parametrize("title", [NASTY[0], NASTY[1], NASTY[2], NASTY[3], "\x00\x1b*/船"])
def test_the_c_of_an_fmu_holds_its_title_and_nothing_of_it_runs(title, tmp_path):
    ran = tmp_path / "ran"
    title = title.replace('"id"', f'"touch {ran}"')
    write_fmu(model_of(title), tmp_path / "tug.fmu", platforms=())
    with zipfile.ZipFile(tmp_path / "tug.fmu") as archive:
        archive.extractall(tmp_path / "fmu")
    sources = tmp_path / "fmu" / "sources"
    (sources / "main.c").write_text('#include "model.h"\n#include <stdio.h>\nint main(void) { puts(model_title); }\n')
    tables = ["cc", "-std=c99", "-trigraphs", "-Werror=comment", "-o", "title", "main.c", *sorted(
        path.name for path in sources.glob("*.c") if path.name != "main.c")]  # fmt: skip
    done = subprocess.run([*tables, "-lm"], cwd=sources, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    said = subprocess.run([sources / "title"], capture_output=True).stdout.decode()
    assert said == f"{seen(title)}, GAUGE-CLOSED\n"
    assert not ran.exists()


# XML


@pytest.mark.slow
@any_text
def test_xml_of_the_fmu_of_ssp_and_of_osp_gives_every_text_back(tmp_path_factory, text):
    folder = tmp_path_factory.mktemp("xml")
    model = model_of(text)
    title = f"{seen(text)}, GAUGE-CLOSED"
    for version in (2, 3):
        write_fmu(model, folder / "tug.fmu", version=version, platforms=(), overwrite=True)
        with zipfile.ZipFile(folder / "tug.fmu") as archive:
            root = ET.fromstring(archive.read("modelDescription.xml"))  # noqa: S314
        assert root.get("modelName") == "tug"
        assert root.get("description").startswith(f"{title}: ")
        words = [element.get("description", "") for element in root.iter()]
        assert sum(entry.endswith(f", {seen(text)}") for entry in words) >= 2
    write_ssv(model, folder / "tug.ssv", overwrite=True)
    entry = ET.parse(folder / "tug.ssv").getroot()  # noqa: S314
    assert (entry.get("name"), entry.get("description")) == ("tug", title)
    ET.parse(write_osp(model, folder / "tug.fmu", overwrite=True))  # noqa: S314


@pytest.mark.slow
@any_text
def test_xml_of_any_tree(text):
    from shaftprint.export._xml import xml_document

    root = ET.Element("a", b=text)
    root.text = text
    parsed = ET.fromstring(xml_document(root))  # noqa: S314
    assert parsed.get("b") == parsed.text == seen(text) or (text == "" and parsed.text is None)


# Modelica


class _Strings:
    """The strings of a Modelica text, taken apart by its lexical rules (Modelica 3.6, section 2.4.2)."""

    pattern = re.compile(r'"((?:[^"\\]|\\.)*)"', re.DOTALL)

    @classmethod
    def of(cls, text):
        return [re.sub(r"\\(.)", r"\1", found, flags=re.DOTALL) for found in cls.pattern.findall(text)]


@pytest.mark.slow
@any_text
def test_modelica_strings_give_every_text_back(text):
    assert _Strings.of(escape.modelica_string(text)) == [seen(text)]
    assert "\n" not in escape.modelica_string(text)


def test_the_parser_of_modelica_gives_every_text_back():
    """All texts in one model, as comments of variables and as their names; a full stop ends each.

    The lexer of pymoca takes a backslash at the very end of a string, which the language writes twice, for one in front
    of the closing quotation mark.
    """
    parser = pytest.importorskip("pymoca.parser", reason="pymoca is the parser of Modelica")
    lines = [f"  Real x{i} {escape.modelica_string(text + '.')};\n" for i, text in enumerate(NASTY)]
    names = {escape.modelica_identifier(f"{text}.") for text in NASTY}
    lines += [f"  Real {name};\n" for name in names]
    found = parser.parse(f"model m\n{''.join(lines)}end m;\n").classes["m"]
    assert len(found.symbols) == len(NASTY) + len(names)
    assert not found.classes
    comments = [found.symbols[f"x{i}"].comment for i in range(len(NASTY))]
    assert [_Strings.of(f'"{comment}"')[0] for comment in comments] == [f"{seen(text)}." for text in NASTY]


@pytest.mark.parametrize("title", ['a";\nend Line;\nmodel Evil', "\\", "船 \x1b"])
def test_a_modelica_package_parses_whatever_the_name_of_the_ship(title, tmp_path):
    parser = pytest.importorskip("pymoca.parser", reason="pymoca is the parser of Modelica")
    written = write_modelica(model_of(title), tmp_path / "tug.mo")
    content = written.path.read_text(encoding="utf-8")
    assert _Strings.of(content)[0].startswith(f"{seen(title)}, GAUGE-CLOSED; written by shaftprint")
    package = parser.parse(content).classes["tug"]
    assert set(package.classes) == {"RealInput", "RealOutput", "Line", "Step"}


@any_text
def test_modelica_identifiers_are_ascii_and_end_where_they_should(text):
    name = escape.modelica_identifier(text)
    assert re.fullmatch(r"'(?:[A-Za-z0-9_ !#$%&()*+,\-./:;<>=?@\[\]^{}|~]|\\['\"\\])*'", name)


def test_a_package_is_not_called_by_a_word_of_the_language(tmp_path):
    assert write_modelica(model_of("tug"), tmp_path / "model.mo").package == "model_"


# MATLAB


@any_text
def test_matlab_strings_give_every_text_back(text):
    quoted = escape.matlab_string(text)
    assert re.fullmatch(r"'(?:[^'\r\n]|'')*'", quoted)
    assert quoted[1:-1].replace("''", "'") == seen(text)
    assert not set(escape.matlab_comment(text)) & set("\r\n\x0b\x0c\x85\u2028\u2029")


@pytest.mark.slow
def test_octave_runs_nothing_of_a_name_and_gives_it_back(tmp_path, monkeypatch):
    """One run of Octave for all texts: a function and a data file for each, named after the text where that may be."""
    if shutil.which("octave") is None:
        pytest.skip("there is no Octave")
    monkeypatch.chdir(tmp_path)
    ran = tmp_path / "ran"
    calls = []
    for place, text in enumerate(NASTY):
        title = text.replace("'id'", f"'touch {ran}'")
        folder = tmp_path / f"f{place}"
        folder.mkdir()
        stem = escape.plain_name(title).strip() or "x"
        name = f"x{place}{stem}"[:60]
        written = write_matlab(model_of(title), folder / f"{name}.mat")
        second, fourth = written.script.read_text(encoding="utf-8").splitlines()[1:4:2]
        assert second.endswith(f"{seen(title)}, GAUGE-CLOSED: {structure('GAUGE-CLOSED').title}")
        assert f"reads {name}.mat," in fourth
        calls.append(
            f"cd('{folder}'); m = {written.script.stem}();"
            f"printf('%d %s\\n', {place}, sprintf('%02x', unicode2native(m.title, 'utf-8')));\n"
        )
    Path("every_title.m").write_text("".join(calls), encoding="utf-8")
    command = ["octave", "--no-gui", "--norc", "--quiet", "every_title.m"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    assert not ran.exists()
    said = dict(line.split(" ", 1) for line in done.stdout.splitlines())
    for place, text in enumerate(NASTY):
        title = text.replace("'id'", f"'touch {ran}'")
        assert bytes.fromhex(said[str(place)]).decode() == seen(title)


# DBC


@any_text
def test_dbc_strings_return(text):
    # letters that the encoding of such files does not have become question marks too
    plain = escape.dbc_text(text)
    assert plain == seen(text).replace('"', "'").replace("\\", "/").encode("latin-1", "replace").decode("latin-1")
    matrix, file = canmatrix.CanMatrix(), io.BytesIO()
    frame = canmatrix.Frame("A", arbitration_id=canmatrix.ArbitrationId(1), size=8)
    frame.add_signal(canmatrix.Signal("x", start_bit=0, size=8, unit=plain, comment=plain))
    frame.add_signal(canmatrix.Signal("after", start_bit=8, size=8))
    matrix.add_frame(frame)
    canmatrix.formats.dump(matrix, file, "dbc")
    (again,) = canmatrix.formats.load(io.BytesIO(file.getvalue()), "dbc").values()
    (frame,) = again.frames
    assert [one.name for one in frame.signals] == ["x", "after"]
    assert (frame.signals[0].unit, frame.signals[0].comment or "") == (plain, plain)


# CSV


@any_text
def test_csv_cells_are_no_formulas_and_return(text):
    stream = io.StringIO()
    csv.writer(stream).writerow(["first", escape.csv_cell(text)])
    (row,) = csv.reader(io.StringIO(stream.getvalue()))
    assert len(row[1]) <= 1 or row[1][0] not in "=+-@\t\r＝＋－＠"
    assert row[1] in (seen(text), "'" + seen(text))
    assert escape.csv_cell_text(row[1]) == seen(text)


def test_a_fingerprint_as_tables_holds_no_formula(run, forged, tmp_path):
    def change(content):
        for quantity in (*content["parameters"], *content["physical"], *content["combinations"]):
            quantity["unit"], quantity["meaning"] = "=1+1", "@SUM(A1)\x1b"
        place = content["joint"]["names"].index(content["physical"][0]["name"])
        content["physical"][0]["name"] = content["joint"]["names"][place] = "+cmd"

    result = run("export", "csv", forged(change), "-o", tmp_path / "out.csv")
    assert result.exit_code == 0, result.stderr
    numbers = 0
    for name in ("parameters", "combinations", "response"):
        for row in csv.reader(io.StringIO((tmp_path / f"out-{name}.csv").read_text(encoding="utf-8"))):
            for cell in row:
                numbers += re.fullmatch(r"-\d.*", cell) is not None
                assert cell == "-" or not cell.startswith(("=", "+", "-", "@")) or float(cell) <= 0.0
    assert numbers > 10
    assert "'@SUM(A1)?" in (tmp_path / "out-parameters.csv").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", ["=1+1", "+M", "@x", "-y", "'=z", "plain"])
def test_channel_names_go_through_a_csv_recording_and_back(name, tmp_path):
    from shaftprint.recording import Channel, read_recording, write_csv

    values = np.arange(50.0)
    channel = Channel(name=name, unit="V", rate_hz=10.0, start_s=0.0, count=50, source=lambda a, b: values[a:b])
    write_csv(tmp_path / "x.csv", [channel])
    titles = (tmp_path / "x.csv").read_text(encoding="utf-8").splitlines()[0].split(",")
    assert titles[1][0] not in "=+-@"
    with read_recording(tmp_path / "x.csv") as opened:
        assert list(opened.channels) == [name]


# terminal

CONTROL = re.compile("[\x00-\x09\x0b-\x1f\x7f-\x9f\u2028\u2029\u202a-\u202e\u2066-\u2069]")


@any_text
def test_a_line_on_the_terminal_is_one_line_and_moves_no_cursor(text):
    import click

    @click.command()
    def command():
        echo(f"before {text} after")

    output = CliRunner().invoke(command, catch_exceptions=False).output
    assert output == f"before {seen(text)} after\n"
    assert not CONTROL.search(output)


@any_text
def test_a_cell_of_a_table_stands_for_itself(text):
    table = Table(title="", columns=texts("name"), rows=((f"<{text}>",),))
    *_, line = table_lines(table, width=10_000)
    assert line == f" <{seen(plain_letters(text))}>".replace("\u00a0", " ")


@any_text
def test_an_error_of_several_lines_is_one_message(text):
    message = escape.terminal_message(f"ship.toml: 1 field cannot be used.\n  name ({text}): expected a number.")
    assert not CONTROL.search(message)
    assert all(line.startswith("  ") for line in message.split("\n")[1:])


def test_nothing_is_printed_past_the_gate():
    """No command calls click.echo, print or a console of rich by itself; the gate is one file."""
    allowed = {"_terminal.py": {"click.echo"}, "_progress.py": {"Console"}}
    found = []
    for path in Path(shaftprint.cli.__file__).parent.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call):
                name = ast.unparse(node.func)
                if re.fullmatch(r"click\.s?echo|click\.secho|print|(.*\.)?Console|console\.print|rich\.print", name):
                    found += [(path.name, name)] * (name not in allowed.get(path.name, ()))
    assert found == []


SHOWN = "tug \x1b[31m\x07\u202e [red]x[/red] :warning: \\"
SHOWN_SEEN = "tug ?[31m?? [red]x[/red] :warning: \\"


def test_show_gives_names_back_and_no_escape_sequence(run, forged):
    def change(content):
        content["conditions"]["vessel"] = SHOWN
        content["conditions"]["campaign"] = SHOWN
        content["findings"] = [SHOWN]
        content["sources"][0]["name"] = SHOWN
        content["parameters"][0]["unit"] = SHOWN
        content["conditions"]["lines_left_out"] = {SHOWN: SHOWN}

    result = run("show", forged(change))
    assert result.exit_code == 0, result.stderr
    assert not CONTROL.search(result.output)
    assert result.output.count(SHOWN_SEEN) >= 5


def test_error_sentences_of_every_kind_hold_no_escape_sequence(run, forged, tmp_path):
    vessel = tmp_path / "ship\x1b[31m.toml"
    vessel.write_text('name = "a\\u001b[31m"\n["\\u001b[2J"]\nx = 1\n', encoding="utf-8")
    path = forged(lambda content: content.update(structure="\x1b[31mX"))
    for arguments in (
        ("inertia", "--vessel", vessel),
        ("export", "json", path),
        ("show", tmp_path / "none\x1b[31m.json"),
        ("inspect", tmp_path / "none\x1b[31m.nc"),
        ("compare", path, path),
    ):
        result = run(*arguments)
        assert result.exit_code != 0
        assert not CONTROL.search(result.stderr), arguments
        assert result.stderr.strip()


# TOML


@any_text
def test_toml_strings_give_every_text_back(text):
    line = escape.toml_string(text)
    assert tomllib.loads(f"x = {line}")["x"] == text
    assert not CONTROL.search(line)


# HTML


class _Reader(html.parser.HTMLParser):
    def __init__(self):
        super().__init__(convert_charrefs=True)
        self.tags, self.text, self.titles = [], "", []

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.titles += [value for name, value in attrs if name == "title"]

    def handle_data(self, data):
        self.text += data


@any_text
def test_html_gives_every_text_back_and_has_no_tag_of_it(text):
    reader = _Reader()
    reader.feed(f'<p title="{escape.html_text(text)}">{escape.html_text(text)}</p>')
    reader.close()
    assert reader.tags == ["p"]
    assert reader.text == seen(text)
    assert reader.titles == [seen(text)]


@any_text
def test_tables_of_a_page_give_every_text_back(text):
    from shaftprint.markup._environment import environment, shown_table
    from shaftprint.tables import Table, texts

    table = Table(title="c", columns=texts("name", "x"), rows=((text, "1"),))
    reader = _Reader()
    reader.feed(str(shown_table(environment({}), table)))
    reader.close()
    assert not {"script", "img", "b", "p"} & set(reader.tags)
    breaks_kept = "".join("\n" if letter == "\n" else "\t" if letter == "\t" else seen(letter) for letter in text)
    assert " ".join(breaks_kept.split()) in " ".join(reader.text.split())


def test_names_of_files_hold_nothing_that_a_system_refuses():
    for text in NASTY:
        name = escape.plain_name(text)
        assert not set(name) & set('\\/:*"<>|\x00\x1b\n')


@pytest.mark.slow
def test_a_report_of_hostile_names_in_a_browser(run, forged, demo, tmp_path):
    """Every name of two fingerprints is hostile; the page runs nothing, asks for nothing, and shows the names."""
    if not CHROMIUM.exists():
        pytest.skip(f"{CHROMIUM} is the browser; apt-get install chromium")
    api = pytest.importorskip("playwright.sync_api", reason="playwright drives the browser")
    hostile = "<img src=x onerror=\"document.title='owned'\"><script>document.title='owned'</script> $\\frac \x01 *//"

    def change(content):
        content["conditions"]["vessel"] = content["conditions"]["campaign"] = hostile
        content["findings"] = [hostile]
        content["sources"][0]["name"] = hostile

    folder = tmp_path / "out"
    result = run(
        "compare", demo[0] / "fingerprint.json", forged(change), "--name", "a", "--name", hostile, "-o", folder
    )
    assert result.exit_code == 0, result.stderr
    asked = []
    with api.sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=str(CHROMIUM), args=["--no-sandbox", "--disable-gpu"])
        page = browser.new_page()
        page.on("request", lambda request: asked.append(request.url))
        page.goto((folder / "index.html").as_uri())
        text, title = page.inner_text("body"), page.title()
        images = page.evaluate("[...document.images].map(image => image.getAttribute('src'))")
        browser.close()
    assert title != "owned"
    assert "x" not in images
    assert all(url.startswith(("file://", "data:", "blob:")) for url in asked)
    assert " ".join(seen(hostile).split()) in " ".join(text.split())
    for picture in folder.glob("figures/*.svg"):
        ET.parse(picture)  # noqa: S314
