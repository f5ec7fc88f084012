"""A drive on the page: its numbers test by test, and whether it has changed."""

import numpy as np
from tests.drive_documents import TRUTH, drive_document
from tests.web.conftest import NOW

from shaftprint.store import add_document, open_store
from shaftprint.web.calculator._compared import compared
from shaftprint.web.calculator._line import judged_line


def test_a_drive_has_a_page_with_its_history(made, monkeypatch):
    site = made(users=False)
    rng = np.random.default_rng(1)
    with open_store(site.service.serving.store) as store:
        for month in range(1, 6):
            truth = {"J": 1.03 * TRUTH["J"]} if month > 3 else {}
            add_document(store, drive_document(month, rng, **truth), named="one.json", now=NOW)
    browser = site.browser()
    (row,) = [one for one in browser.get("/api/v1/ships").json["lines"] if one["line"] == "drive"]
    content = browser.get(f"/api/v1{row['address']}").json
    assert [one["name"] for one in content["tests"][0]["numbers"]] == ["R", "J", "d"]
    page = browser.get(row["address"]).text
    assert page.count("2026-0") >= 5
    assert "kg m²" in page
    monkeypatch.setenv("SHAFTPRINT_STORE", site.service.serving.store)
    judged = judged_line({"name": "bench motor"}, "drive")
    assert judged["word"] == "changed"
    assert judged["causes"][0]["words"] == "a higher J"
    assert {one["name"] for one in judged["strips"]} == set(TRUTH)
    # the first test, from which the others are counted, is drawn at its place
    firsts = {(one["points"][0]["at"][:10], one["points"][0]["value"]) for one in judged["strips"]}
    assert firsts == {(content["tests"][-1]["at"][:10], 0.0)}
    test = browser.get(f"/api/v1/fingerprints/{content['tests'][0]['sha256']}")
    assert test.json["drive"] == "bench motor"
    # two tests beside each other, by the process beside the server
    found = compared(content["tests"][4]["sha256"], content["tests"][0]["sha256"], ["January", "May"])
    assert found["word"] == "changed"
    assert found["files"] == []
