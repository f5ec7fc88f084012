"""Name and logo of a company: pixels of a small picture and text, nothing else of what a user gives."""

import base64
import io
import re
from dataclasses import replace

import pytest
from PIL import Image, PngImagePlugin

from shaftprint.errors import SettingsError
from shaftprint.fingerprint import vessel_fields
from shaftprint.report import _render as render_module
from shaftprint.report import render_report
from shaftprint.report._logo import drawn_logo
from shaftprint.report.sections.first_page._cover_of import cover_of
from shaftprint.settings import write_template
from shaftprint.vessel import load_vessel

NAME = "<img src=x> & Söhne"


def picture(path, size=(1200, 300), **more):
    Image.new("RGB", size, (10, 200, 30)).save(path, **more)
    return path


def vessel_with(folder, logo, name=NAME):
    path = folder / "vessel.toml"
    write_template("vessel", path, shipped="stan-tug-1205")
    path.write_text(
        f'{path.read_text(encoding="utf-8")}\n[company]\nname = "{name}"\nlogo = "{logo}"\n', encoding="utf-8"
    )
    return load_vessel(path)


def test_a_logo_is_drawn_anew_small_and_without_what_else_its_file_holds(tmp_path):
    told = PngImagePlugin.PngInfo()
    told.add_text("Comment", "a secret")
    drawn, missing = drawn_logo(picture(tmp_path / "logo.png", pnginfo=told))
    assert missing == ""
    with Image.open(io.BytesIO(drawn)) as logo:
        assert (logo.format, logo.size) == ("PNG", (600, 150))
        assert logo.getpixel((300, 75)) == (10, 200, 30, 255)
        assert not logo.info
    assert b"secret" not in drawn


def test_a_grey_of_16_bits_keeps_its_grey(tmp_path):
    Image.new("I;16", (1200, 300), 100 * 256).save(tmp_path / "logo.png")
    drawn, _ = drawn_logo(tmp_path / "logo.png")
    with Image.open(io.BytesIO(drawn)) as logo:
        assert logo.getpixel((300, 75)) == (100, 100, 100, 255)


@pytest.mark.parametrize(
    ("make", "why"),
    [
        (lambda path: None, "beside the vessel file, found none there"),
        (lambda path: path.write_text("<svg></svg>"), "as PNG or JPEG: it is neither"),
        (lambda path: picture(path, format="GIF"), "as PNG or JPEG: it is neither"),
        (lambda path: path.write_bytes(bytes(2**20 + 1)), "at most 1 MB"),
        (lambda path: picture(path, size=(5000, 4000)), "at most 16 million pixels"),
        (lambda path: path.write_bytes(picture(path).read_bytes()[:120]), "logo.png as PNG or JPEG"),
    ],
)
def test_what_is_no_small_picture_is_left_out_with_the_reason(tmp_path, make, why):
    make(tmp_path / "logo.png")
    drawn, missing = drawn_logo(tmp_path / "logo.png")
    assert drawn is None
    assert why in missing


@pytest.mark.parametrize("name", ["../logo.png", "logo.svg", "a/logo.png", "https://x.example/logo.png", "C:logo.png"])
def test_a_logo_lies_beside_the_vessel_file(tmp_path, name):
    with pytest.raises(SettingsError, match="expected the name of a PNG or JPEG file beside the vessel file, found"):
        vessel_with(tmp_path, name)


def test_the_page_shows_name_and_logo_as_text_and_picture(tmp_path, survey, monkeypatch):
    monkeypatch.setattr(render_module, "page_sections", lambda inputs: ())
    drawn, _ = drawn_logo(picture(tmp_path / "logo.png"))
    trial = replace(survey.trial, vessel=vessel_with(tmp_path, "logo.png"))
    text = render_report(tmp_path / "out", replace(survey, trial=trial)).read_text(encoding="utf-8")
    picture_text = base64.b64encode(drawn).decode()
    assert f'<img src="data:image/png;base64,{picture_text}" alt=""> &lt;img src=x&gt; &amp; Söhne</p>' in text
    assert text.count("<img") == 1
    assert "img-src &#39;self&#39; file: data:;" in text or "img-src 'self' file: data:;" in text
    (tmp_path / "logo.png").unlink()
    without = render_report(tmp_path / "bare", replace(survey, trial=trial)).read_text(encoding="utf-8")
    assert "data:" not in without.split("</head>")[0]
    assert "expected logo.png beside the vessel file, found none there" in without


def test_name_and_logo_stand_on_paper_and_are_no_fields_of_the_ship(tmp_path, fingerprint):
    pytest.importorskip("reportlab", reason="reportlab writes PDF")
    from shaftprint.report.paper._write_pdf import write_pdf

    picture(tmp_path / "logo.png")
    vessel = vessel_with(tmp_path, "logo.png")
    cover = cover_of(fingerprint, vessel=vessel)
    write_pdf(tmp_path / "out.pdf", title="a", subtitle="b", cover=cover, sections=[], ending="c")
    content = (tmp_path / "out.pdf").read_bytes()
    assert len(re.findall(rb"/Subtype\s*/Image", content)) in (1, 2), "the picture, and its mask"
    assert not [name for name in vessel_fields(vessel) if "company" in name]
