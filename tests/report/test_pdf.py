"""The first pages as PDF: how many there are, and that no text of a file is taken for more than text."""

import itertools
import re
import sys
from dataclasses import replace
from types import SimpleNamespace

import pytest

from shaftprint.errors import ReportError
from shaftprint.report import render_pdf, render_report, save_chart
from shaftprint.report.charts._pictures import draw
from shaftprint.report.paper import _write_pdf
from shaftprint.report.paper._write_pdf import write_pdf
from shaftprint.report.sections._engineer import budget_section, number_section, verdict_section
from shaftprint.report.sections._results import stability_section
from shaftprint.report.sections.first_page._cover_of import cover_of

pytest.importorskip("reportlab", reason="reportlab writes PDF")


def written(path, fingerprint, vessel, *, previous=None, further=()):
    inputs = SimpleNamespace(fingerprint=fingerprint)
    write_pdf(
        path,
        title=fingerprint.conditions.vessel,
        subtitle=fingerprint.conditions.campaign,
        cover=cover_of(fingerprint, vessel=vessel, previous=previous),
        sections=[verdict_section(inputs), number_section(inputs), *further],
        ending="the end",
    )
    return path.read_bytes()


def pictures(content):
    return len(re.findall(rb"/Subtype\s*/Image", content))


def pages(content):
    return len(re.findall(rb"/Type\s*/Page\b", content))


def test_the_first_page_is_one_sheet_and_the_same_report_the_same_bytes(tmp_path, fingerprint, vessel):
    content = written(tmp_path / "out.pdf", fingerprint, vessel, previous=fingerprint)
    assert content.startswith(b"%PDF")
    assert pages(content) == 2
    assert written(tmp_path / "again.pdf", fingerprint, vessel, previous=fingerprint) == content


def test_what_is_folded_is_left_out(tmp_path, survey, fingerprint, vessel):
    inputs = SimpleNamespace(
        identification=survey.identification, fingerprint=fingerprint, truth={}, validations=(), signals=None
    )
    (section,) = stability_section(inputs)
    folded = written(tmp_path / "folded.pdf", fingerprint, vessel, further=[replace(section, folded=True)])
    assert folded == written(tmp_path / "without.pdf", fingerprint, vessel)
    assert pictures(folded) == 0
    assert pictures(written(tmp_path / "open.pdf", fingerprint, vessel, further=[section])) > 0


def test_texts_of_files_stay_texts(tmp_path, survey, fingerprint, vessel):
    """Tags of ReportLab in names of a ship, test, place, parameter and unit: none loads a picture or makes a link."""
    (section,) = stability_section(
        SimpleNamespace(
            identification=survey.identification, fingerprint=fingerprint, truth={}, validations=(), signals=None
        )
    )
    save_chart(section.pictures[0].chart(), tmp_path / "x.png")
    evil = f"<img src='{tmp_path / 'x.png'}' width='9' height='9'/> & <a href='http://x.y'>z</a> \x1b[2J </para>"
    conditions = fingerprint.conditions.model_copy(update={"vessel": evil, "campaign": evil, "place": evil})
    first = replace(fingerprint.parameters[0], name=evil, unit=evil, meaning=evil)
    changed = fingerprint.model_copy(
        update={
            "conditions": conditions,
            "parameters": (first, *fingerprint.parameters[1:]),
            "verdict": replace(fingerprint.verdict, cautions=(evil,), reason=evil),
        }
    )
    content = written(tmp_path / "evil.pdf", changed, vessel)
    assert pictures(content) == 0
    assert b"/URI" not in content


def test_without_reportlab_it_is_said_what_to_install(tmp_path, survey, monkeypatch):
    monkeypatch.setitem(sys.modules, "reportlab", None)
    with pytest.raises(ReportError, match=r"expected the package reportlab, found none; pip install"):
        render_report(tmp_path / "report", survey, pdf=True)
    with pytest.raises(ReportError, match="reportlab"):
        render_pdf(tmp_path / "out.pdf", survey)
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_a_survey_gives_page_one_and_a_summary(tmp_path, survey):
    content = render_pdf(tmp_path / "out.pdf", survey).read_bytes()
    assert 3 <= pages(content) <= 4
    assert pictures(content) >= 2


def test_a_command_in_a_sentence_is_printed_as_words(tmp_path, fingerprint, vessel):
    """ReportLab refuses what it does not know as a tag."""
    typed = replace(fingerprint.verdict, cautions=("Read `shaftprint limits --records St1`, or --after.",))
    told = fingerprint.model_copy(update={"verdict": typed})
    assert written(tmp_path / "told.pdf", told, vessel) != written(tmp_path / "out.pdf", fingerprint, vessel)


def test_each_name_of_a_chart_has_a_line_of_its_own(tmp_path, monkeypatch, fingerprint, vessel):
    """Twenty-eight bars were drawn as high as a step: their names lay on one another."""
    drawn = []

    def kept(chart, **options):
        drawn.append(draw(chart, **options))
        return drawn[-1]

    (row, *_) = [row for row in fingerprint.budget.rows if row.shares]
    many = replace(fingerprint.budget, rows=tuple(replace(row, name=f"name {i}") for i in range(28)))
    monkeypatch.setattr(_write_pdf, "draw", kept)
    inputs = SimpleNamespace(fingerprint=fingerprint.model_copy(update={"budget": many}))
    written(tmp_path / "many.pdf", fingerprint, vessel, further=budget_section(inputs))
    (figure,) = drawn
    figure.canvas.draw()
    boxes = [label.get_window_extent() for label in figure.axes[0].get_yticklabels()]
    assert len(boxes) == 28
    edges = sorted((box.y0, box.y1) for box in boxes)
    assert all(below[1] < above[0] for below, above in itertools.pairwise(edges))
    # letters are as large as those of a table on paper
    letters_pt = figure.axes[0].get_yticklabels()[0].get_fontsize() * _write_pdf.SHRUNK
    assert letters_pt == pytest.approx(_write_pdf.CELL_PT)
