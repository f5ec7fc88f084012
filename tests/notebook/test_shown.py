"""What a session shows of a noun: a few lines, a small table, harmless whatever a file holds; words of the field."""

import importlib
import pkgutil
import re
from dataclasses import is_dataclass
from html.parser import HTMLParser

import numpy as np
import pytest
from pydantic import BaseModel

import shaftprint as sp
from shaftprint.notebook._shown import Shown
from shaftprint.notebook._summary import Summary

HOSTILE = "<script>alert(1)</script>\x1b[2J\nK_p & co"
for found in pkgutil.iter_modules(sp.__path__):
    if found.name not in {"__main__", "cli"}:
        room = importlib.import_module(f"shaftprint.{found.name}")
        # a door loads what stands behind it when it is asked for
        for behind in getattr(room, "__all__", ()):
            getattr(room, behind)


def every_noun(noun=Shown):
    return {noun, *(one for child in noun.__subclasses__() for one in every_noun(child))} - {Shown}


class Tags(HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.opened, self.texts = [], []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.opened.append((tag, dict(attrs)))

    def handle_data(self, data):
        self.texts.append(data)


def nouns():
    vessel = sp.vessel.load_vessel("stan-tug-1205")
    line = sp.catalogue.structure("GAUGE-CLOSED")
    campaign = sp.campaign.load_campaign("thesis")
    response = sp.spectra.FrequencyResponse(
        frequency_hz=np.linspace(0.1, 3.0, 40),
        response=np.ones((1, 1, 40), dtype=complex),
        covariance=np.tile(1e-6 * np.eye(2), (40, 1, 1)),
        inputs=("n_set",),
        outputs=("n",),
    )
    return {"vessel": vessel, "structure": line, "campaign": campaign, "response": response}


@pytest.mark.parametrize("noun", sorted(every_noun(), key=lambda one: one.__name__), ids=lambda one: one.__name__)
def test_no_noun_prints_its_arrays(noun):
    """A dataclass without ``repr=False`` would bring its own."""
    assert noun.__repr__ is Shown.__repr__
    assert noun.__str__ is Shown.__str__
    assert is_dataclass(noun) or issubclass(noun, BaseModel)


def test_the_nouns_that_people_handle_are_among_them():
    names = {noun.__name__ for noun in every_noun()}
    assert names >= {
        *("Vessel", "Campaign", "Recording", "Signals", "Spectra", "FrequencyResponse", "Structure", "Identification"),
        *("Verdict", "Fingerprint", "Validation", "Survey", "Measurement", "StructureComparison", "LimitFit", "Trace"),
    }


@pytest.mark.parametrize("name", ["vessel", "structure", "campaign", "response"])
def test_a_noun_is_a_few_lines_that_fit_a_terminal(name):
    lines = repr(nouns()[name]).split("\n")
    assert 3 <= len(lines) <= 12
    assert max(len(line) for line in lines) <= 100


def test_the_lines_of_a_vessel_are_those_of_its_file():
    assert repr(sp.vessel.load_vessel("stan-tug-1205")).split("\n")[:3] == [
        "Vessel Stan Tug 1205, port",
        "  engine         221 kW at 1800 rpm, 6 cylinders",
        "  gearbox        ratio 3.82, efficiency 0.97",
    ]


def test_many_lines_of_a_response_are_counted():
    assert "  lines  line 1, line 2, line 3" in repr(nouns()["response"])
    assert "… (40)" in repr(nouns()["response"])


def test_what_stands_in_a_file_cannot_move_the_cursor_or_run():
    vessel = sp.vessel.load_vessel("stan-tug-1205").model_copy(update={"name": HOSTILE})
    assert "\x1b" not in repr(vessel)
    assert len(repr(vessel).split("\n")) == len(vessel.summary().facts) + 1
    page = vessel._repr_html_()
    tags = Tags(page)
    assert {tag for tag, _ in tags.opened} == {"table", "caption", "tbody", "tr", "th", "td"}
    assert all(set(attributes) <= {"scope", "style"} for _, attributes in tags.opened)
    assert any("<script>alert(1)</script>" in text for text in tags.texts), "escaped, and still to be read"
    assert "\x1b" not in page


def test_facts_that_are_empty_take_no_row():
    summary = Summary(title="a", facts={"here": "yes", "not here": ""})
    assert summary.text() == "a\n  here  yes"
    assert summary.html().count("<tr>") == 1


def test_a_session_completes_words_of_the_field_only():
    vessel = sp.vessel.load_vessel("stan-tug-1205")
    for noun in (vessel, vessel.engine, sp.campaign.load_campaign("thesis")):
        words = {name for name in dir(noun) if not name.startswith("_")}
        assert set(type(noun).model_fields) <= words
        assert not words & {"copy", "dict", "json", "from_orm", "parse_raw", "model_dump", "model_fields", "schema"}
    fingerprint = {
        name
        for name in dir(sp.fingerprint.Fingerprint.model_construct(verdict=None, parameters=()))
        if not name.startswith("_")
    }
    assert {"verdict", "parameters", "to_pandas", "quantity"} <= fingerprint
    assert not any(re.match("model_|parse_|schema", name) and name != "schema_version" for name in fingerprint)


def test_none_for_a_vessel_is_answered_in_a_sentence():
    with pytest.raises(sp.errors.ShaftprintError, match=r"expected vessel \(Vessel\), found None"):
        sp.open_survey("log.mf4", vessel=None, campaign="thesis")
