"""The comparison of fingerprints in a real browser, and what it refuses."""

import re
from dataclasses import replace

import numpy as np
import pytest

from shaftprint.errors import ReportError
from shaftprint.report._comparison import render_comparison

pytestmark = pytest.mark.slow


def moved(fingerprint, name, share):
    """The fingerprint of a later test, one physical value of which has moved and all else not."""
    physical = tuple(replace(q, value=q.value * (1.0 + share)) if q.name == name else q for q in fingerprint.physical)
    return fingerprint.model_copy(update={"physical": physical})


@pytest.fixture(scope="module")
def report(tmp_path_factory, fingerprint):
    """A line with half as much inertia again behind the gauge, as with a rope in the propeller, and one unchanged."""
    later = {"2025": fingerprint, "rope": moved(fingerprint, "I_dn", 0.5), "same": fingerprint}
    return render_comparison(tmp_path_factory.mktemp("compared") / "report", later)


def test_the_first_screen_names_what_has_changed(visit, report):
    with visit(report) as found:
        words = found.page.locator("#found").inner_text()
        assert "Something has changed by more than chance" in words
        rope = re.search(r"Has anything changed: rope\?\s*(.*)", words).group(1)
        assert "Yes: more inertia behind the torque gauge, by 50.0" in rope
        assert "No: " in re.search(r"Has anything changed: same\?\s*(.*)", words).group(1)


def test_responses_lie_over_each_other_and_nothing_leaves(visit, report):
    with visit(report) as found:
        for name in ("differences", "responses"):
            found.show(name)
        lines = found.page.evaluate(
            "document.getElementById('plot-responses').data.filter(t => !t.fill).map(t => [t.name, t.xaxis, t.y])"
        )
        by_name = {(name, axis): np.array(y, dtype=float) for name, axis, y in lines}
        assert len(by_name) == 12
        assert by_name["2025", "x"] == pytest.approx(by_name["rope", "x"])
        assert found.messages == []
        assert [address for address in found.requests if not address.startswith("file:///")] == []


def test_a_bar_is_where_the_difference_is(visit, report):
    with visit(report) as found:
        found.show("differences")
        shown = found.page.evaluate(
            "(chart => chart.data.map(t => [t.name, Object.fromEntries(t.y.map((place, i) =>"
            " [chart._fullLayout.yaxis.ticktext[Math.round(place)].replace(/<[^>]*>/g, ''), t.x[i]]))]))"
            "(document.getElementById('plot-differences'))"
        )
        values = dict(shown)
        assert values["rope"]["Idn"] == pytest.approx(50.0)
        assert set(values["same"].values()) == {0}


def test_one_fingerprint_is_no_comparison(tmp_path, fingerprint):
    with pytest.raises(ReportError, match="expected two or more fingerprints, found 1"):
        render_comparison(tmp_path / "one", {"a": fingerprint})
    assert not list(tmp_path.iterdir())


def test_a_structure_that_is_not_known_is_named(tmp_path, fingerprint):
    own = fingerprint.model_copy(update={"structure": "MY-LOOP"})
    page = render_comparison(tmp_path / "own", {"a": fingerprint, "b": own})
    text = page.read_text(encoding="utf-8")
    assert "Not drawn, since its structure is another or not known here: b." in text
    assert "structure MY-LOOP instead of GAUGE-CLOSED" in text


def test_names_of_users_are_text_everywhere(visit, tmp_path, fingerprint):
    """In words, tables, legends of both kinds and data: none is run, parsed as a formula or made a link."""
    evil = (
        "<img src=x onerror=alert(1)>",
        "</script><script>alert(2)</script>",
        "a_b $x^{$ <a href='http://x.y'>z</a>",
    )
    page = render_comparison(tmp_path / "evil", dict.fromkeys(evil, fingerprint))
    with visit(page) as found:
        found.page.on("dialog", lambda dialog: found.messages.append(f"dialog: {dialog.message}"))
        for name in ("differences", "responses"):
            found.show(name)
        assert found.messages == []
        legend = found.page.locator("#plot-responses .legendtext").all_text_contents()
        assert evil[0] in legend
        assert evil[2] in legend
        assert found.page.locator("a[href^=http], img[src=x]").count() == 0
        assert evil[1] in found.page.locator("#found").inner_text()
