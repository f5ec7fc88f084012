import re
import subprocess
import sys
from dataclasses import replace
from html.parser import HTMLParser
from types import SimpleNamespace
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from tests.made_signals import with_channels

from shaftprint.catalogue import structure
from shaftprint.identify import Settings, Unweighted, identify
from shaftprint.report import _page as page_module
from shaftprint.report import _render as render_module
from shaftprint.report import render_report
from shaftprint.report.sections._measurement import time_section
from shaftprint.report.sections._results import stability_section, summary_section
from shaftprint.survey import ThesisMode

VOID = {"meta", "img", "br", "link"}


class Page(HTMLParser):
    """Checks nesting and collects what the tests ask for."""

    def __init__(self, text):
        super().__init__()
        self.open, self.tags, self.words, self.ids, self.rows = [], [], [], [], []
        self.feed(text)
        assert not self.open, f"never closed: {self.open}"

    def handle_starttag(self, tag, attributes):
        self.tags.append((tag, dict(attributes)))
        if "id" in dict(attributes):
            self.ids.append(dict(attributes)["id"])
        if tag == "tr":
            self.rows.append([])
        if tag in ("td", "th"):
            self.rows[-1].append("")
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if "style" not in self.open:
            self.words.append(data)
        if "td" in self.open or "th" in self.open:
            self.rows[-1][-1] += data

    def all(self, tag):
        return [attributes for name, attributes in self.tags if name == tag]

    @property
    def text(self):
        return re.sub(r"\s+", " ", "".join(self.words))


@pytest.fixture(scope="session")
def thesis(signals, spectra, open_responses):
    """Unweighted fits of the thesis, all lines used, speeds a turn late."""
    governor, core = open_responses
    late = {name: replace(speed, delay_s=0.0507) for name, speed in signals.speeds.items()}
    everything = replace(spectra.response, used=np.ones(16, dtype=np.bool_))
    settings = Settings(weighting=Unweighted(), starts=12)
    rng = np.random.default_rng(6)
    data = {"OL1": core, "OL2": governor, "OL5": governor}
    return ThesisMode(
        signals=replace(with_channels(signals, **late), mode="thesis"),
        spectra=replace(spectra, response=everything),
        identifications={name: identify(structure(name), r, rng=rng, settings=settings) for name, r in data.items()},
    )


@pytest.fixture(scope="session")
def report(tmp_path_factory, survey, recording, fits, thesis, response):
    folder = tmp_path_factory.mktemp("out") / "report"
    told = []
    page = render_report(
        folder,
        replace(survey, fits=(*survey.fits, *(fits[name] for name in ("OL1", "OL2", "BENCHMARK")))),
        recording=recording,
        thesis=thesis,
        truth={"tau_dn": 0.32, "K_p": 5.7, "K_i": 4.27, "t_d": 0.07, "t_sp": 0.05, "k_q": 9.0, "I_dn": 17.0},
        line_selection={"fit": response, "bin": response},
        sensitivity=[structure("OL2")],
        progress=told.append,
    )
    assert told[-1] == 1.0
    assert np.all(np.diff(told) > 0.0)
    return page


@pytest.fixture(scope="session")
def page(report):
    return Page(report.read_text(encoding="utf-8"))


@pytest.fixture(scope="session")
def thesis_page(report):
    """The page on the thesis' way, beside the report."""
    return Page((report.parent / "thesis.html").read_text(encoding="utf-8"))


@pytest.mark.slow
def test_every_chart_has_its_data_and_words(report, page, thesis_page):
    charts = [one for shown in (page, thesis_page) for one in shown.all("div") if one.get("class") == "plot"]
    assert len(charts) >= 20
    for chart in charts:
        data = (report.parent / chart["data-source"]).read_text(encoding="utf-8")
        assert data.startswith(f'shaftprintChart("{chart["data-plot"]}",{{')
        assert len(data) < 300_000
        assert len(chart["aria-label"]) > 20
    assert not page.all("img")
    assert "shaftprint identify --figures" in page.text


@pytest.mark.slow
def test_the_page_asks_for_nothing_outside(report, page):
    text = report.read_text(encoding="utf-8")
    assert not page.all("link")
    scripts = [script["src"] for script in page.all("script")]
    assert [script for script in scripts if not re.fullmatch(r"plots/[a-z0-9.-]+\.js", script)] == []
    assert {(report.parent / script).is_file() for script in scripts} == {True}
    assert "http://" not in text
    assert "https://" not in text
    for attributes in page.all("a"):
        assert attributes["href"].startswith("#") or attributes["href"] == "thesis.html"
    policy = next(m["content"] for m in page.all("meta") if m.get("http-equiv") == "Content-Security-Policy")
    assert "default-src 'none'" in policy
    assert "script-src 'self' file:;" in policy
    # attributes of what is drawn, never a sheet or a script
    assert policy.replace("style-src-attr 'unsafe-inline'", "").count("unsafe") == 0


def test_pictures_are_written_where_they_are_asked_for(tmp_path, survey, monkeypatch):
    monkeypatch.setattr(render_module, "page_sections", lambda inputs: stability_section(inputs))
    report = render_report(tmp_path / "pictures", survey, pictures=True)
    figures = report.parent / "figures"
    assert sorted(file.name for file in figures.iterdir()) == ["nyquist.pdf", "nyquist.png", "nyquist.svg"]
    (image,) = Page(report.read_text(encoding="utf-8")).all("img")
    assert image["src"] == "figures/nyquist.svg"
    text = (figures / "nyquist.svg").read_text(encoding="utf-8")
    assert ET.fromstring(text).tag.endswith("svg")  # noqa: S314
    links = re.findall(r'(?:href|src)="([^"]*)"', text)
    assert all(link.startswith(("#", "data:")) for link in links)


@pytest.mark.slow
def test_a_report_needs_no_matplotlib(tmp_path):
    """It takes half a second to load and most of a report's time to draw: nothing on the way may import it."""
    code = "import sys, shaftprint.cli, shaftprint.report; print('matplotlib' in sys.modules)"
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "False"


@pytest.mark.slow
def test_the_policy_allows_exactly_this_style_sheet(report, page):
    import base64
    import hashlib

    text = report.read_text(encoding="utf-8")
    style = re.search(r"<style>(.*?)</style>", text, re.DOTALL).group(1)
    digest = base64.b64encode(hashlib.sha256(style.encode()).digest()).decode()
    assert f"'sha256-{digest}'" in next(m["content"] for m in page.all("meta") if "http-equiv" in m).replace(
        "&#39;", "'"
    )
    assert "prefers-color-scheme: dark" in style
    assert "@media print" in style


@pytest.mark.slow
def test_headings_and_anchors(page):
    levels = [int(tag[1]) for tag, _ in page.tags if re.fullmatch(r"h[1-6]", tag)]
    assert levels[0] == 1
    assert levels.count(1) == 1
    assert np.diff(levels).max() <= 1
    assert len(set(page.ids)) == len(page.ids)
    assert {a["href"][1:] for a in page.all("a") if a["href"] != "thesis.html"} <= set(page.ids)


@pytest.mark.slow
def test_the_summary_comes_before_a_folded_appendix(page):
    """Page one, verdict, numbers, model and data, and budget are open; all else is in sections that a reader opens."""
    text = page.text[page.text.index("Verdict: the fit is", page.text.index("The test can")) :]
    order = ["Verdict: the fit is", "What was identified", "Model and data", "Where the uncertainty comes", "Appendix"]
    places = [text.index(words) for words in order]
    assert places == sorted(places)
    assert "within their noise" in text[: places[3]]
    assert "vessel file 17.0 ± 1.6" in text[places[4] :]
    assert "The governed line is stable" in page.text
    assert "+/-" not in page.text
    # tables that a phone folds are open without its script
    folded = [attributes for attributes in page.all("details") if attributes.get("class") != "fold"]
    assert len(folded) >= 8
    assert not [attributes for attributes in folded if "open" in attributes]


@pytest.mark.slow
def test_what_was_assumed_is_named(page, fingerprint):
    assert ("Priors, from the vessel file" in page.text) == bool(fingerprint.priors)


@pytest.mark.slow
def test_truth_stands_beside_the_estimate(page):
    """tau_dn is true at 0.32 and found there; k_q is not 9."""
    rows = [
        row for row in page.rows if len(row) > 4 and row[4] in ("yes", "no") and row[3] != "–" and "±" not in row[3]
    ]
    row = next(row for row in rows if row[0] == "τdn")
    assert (float(row[3]), row[4]) == (0.32, "yes")
    row = next(row for row in rows if row[0] == "kq")
    assert (float(row[3]), row[4]) == (9.0, "no")
    row = next(row for row in rows if row[0] == "Idn")
    assert float(row[3]) == 17.0
    row = next(row for row in rows if row[0] == "td + tsp")
    assert float(row[3]) == pytest.approx(0.12)


@pytest.mark.slow
def test_tables_of_the_thesis_are_there(page, thesis_page):
    for words in ("table 3.1", "table 3.3", "table 3.4", "table 3.5", "table 3.6", "table 3.7", "tables 5.2 and 5.3"):
        assert words in page.text + thesis_page.text
    assert "dropout" not in page.text
    assert "missing pulse" in page.text


@pytest.mark.slow
def test_why_thesis_mode_differs(thesis_page):
    """tau of 54.006 kg m2 at 19.53 / 3.82 rev/s and 1725 N m is 1.006 s."""
    assert "a factor" in thesis_page.text
    assert "upstream of the gauge gives 1.006 s" in thesis_page.text
    assert "sees only what lies downstream of the gauge" in thesis_page.text
    assert "50.7 ms late" in thesis_page.text
    assert "nearly the same, though their Kp lie between" in thesis_page.text
    assert "S15 and S16 lie above 9.87 Hz" in thesis_page.text


@pytest.mark.slow
def test_a_report_of_a_bare_survey(tmp_path, survey):
    bare = replace(
        survey,
        measurement=replace(survey.measurement, signals=replace(survey.signals, strips=(), step_delays=(), repairs=())),
        trial=replace(survey.trial, campaign=survey.campaign.model_copy(update={"chirps": (), "staircases": ()})),
    )
    page = Page(render_report(tmp_path / "bare", bare).read_text(encoding="utf-8"))
    assert "truth within" not in page.text
    assert "thesis-mode" not in page.ids
    assert "time" not in page.ids
    assert "plot-campaign" not in page.ids


def test_tests_that_ended_before_the_recording_began_are_not_drawn(campaign, signals):
    """St1 ends at 310 s and C11 at 450 s; a figure of either would be empty."""
    late = replace(signals, start_s=455.0)
    (section,) = time_section(SimpleNamespace(campaign=campaign, signals=late))
    assert [picture.name for picture in section.pictures] == ["chirp_c2"]
    assert section.pictures[0].chart().panels
    assert time_section(SimpleNamespace(campaign=campaign, signals=replace(signals, start_s=700.0))) == []


def test_names_of_users_are_escaped(tmp_path, survey, monkeypatch):
    monkeypatch.setattr(render_module, "page_sections", lambda inputs: [summary_section(inputs)])
    evil = "<b>Tug & Co</b>"
    fingerprint = survey.fingerprint
    renamed = fingerprint.model_copy(
        update={
            "conditions": fingerprint.conditions.model_copy(update={"vessel": evil}),
            "findings": ("k_q is <script>alert(1)</script>",),
        }
    )
    text = render_report(tmp_path / "evil", replace(survey, fingerprint=renamed)).read_text(encoding="utf-8")
    assert "<b>" not in text
    assert "<script>alert" not in text
    assert "&lt;b&gt;Tug &amp; Co" in text
    assert "<i>k</i><sub>q</sub> is &lt;script&gt;" in text


def test_an_earlier_report_is_kept_unless_overwriting_is_asked_for(tmp_path, survey, monkeypatch):
    monkeypatch.setattr(render_module, "page_sections", lambda inputs: [])
    (tmp_path / "recording.nc").write_text("raw")
    first = render_report(tmp_path, survey).read_bytes()
    (tmp_path / "figures").mkdir()
    (tmp_path / "figures" / "old.svg").write_text("old")
    with pytest.raises(FileExistsError, match=r"index\.html exists already"):
        render_report(tmp_path, survey)
    assert (tmp_path / "index.html").read_bytes() == first
    render_report(tmp_path, survey, overwrite=True)
    # a report without pictures has no folder of them
    assert sorted(file.name for file in tmp_path.iterdir()) == ["index.html", "plots", "recording.nc"]


def test_a_report_that_fails_leaves_nothing(tmp_path, survey, monkeypatch):
    def fail(*_, **__):
        raise OSError("disk full")

    monkeypatch.setattr(page_module, "write_charts", fail)
    with pytest.raises(OSError, match="disk full"):
        render_report(tmp_path / "report", survey)
    assert not list(tmp_path.iterdir())


def test_a_structure_without_feedback_has_no_stability_section(tmp_path, survey, fits, monkeypatch):
    found = stability_section
    inputs = []
    monkeypatch.setattr(render_module, "page_sections", lambda given: inputs.append(given) or [])
    render_report(tmp_path / "report", survey)
    assert found(replace(inputs[0], identification=fits["OL1"])) == []
