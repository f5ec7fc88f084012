"""What pages say: the word of each line, places of strip charts, how far a job is."""

import json
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from types import SimpleNamespace

from tests.web.conftest import ADA, HIDDEN, NOW

from shaftprint.store import claim, refuse, renew
from shaftprint.store._overview import lines_now
from shaftprint.web._standing import standing_of
from shaftprint.web._strip import TimeAxis, strip
from shaftprint.web.pages._ships import headline_of

STEP = {"name": "propeller", "shape": "step", "since": "2026-03-01", "size": 4.2, "std": 0.8, "unit": "%"}


def stands(site, found=None, *, now=NOW, overdue_days=365, **changed):
    line = replace(next(one for one in lines_now(site.service.store) if one.line.ship.name == "Ada"), **changed)
    kept = None if found is None else (line.state, {"causes": [], "because": "", "since": "2025-03-01"} | found)
    return standing_of(line, kept, now=now, overdue_days=overdue_days)


def test_words_of_a_line(site):
    assert stands(site).word == "being judged"
    assert stands(site, {}).word == "no change seen since 2025-03"
    changed = stands(site, {"causes": [STEP]})
    assert (changed.word, changed.look) == ("changed: propeller", "look")
    assert changed.note == "4.20 ± 0.80 %, seen on 2026-03-01"
    assert stands(site, {"causes": [STEP | {"shape": "ramp"}]}).note == "4.20 ± 0.80 % a year since 2026-03-01"
    worn = STEP | {"shape": "ramp", "expected": True, "now": {"size": 6.3, "std": 0.8}}
    fouled = stands(site, {"causes": [worn]})
    assert (fouled.kind, fouled.word, fouled.look) == ("worn as expected", "worn as expected: propeller", "worn")
    assert fouled.note == "6.30 ± 0.80 % by now, 4.20 ± 0.80 % a year since 2026-03-01"
    # 4.5 years of 4.2 % are 19 %, of which 6.3 % are left: the page says what took the others off
    off = [{"at": "2028-06-19", "kind": "docking", "size": 12.6, "std": 1.2}]
    assert stands(site, {"causes": [worn | {"off": off}]}).note == (
        "6.30 ± 0.80 % by now, 4.20 ± 0.80 % a year since 2026-03-01, of which the docking of 2028-06-19 took off "
        "12.6 ± 1.2 %"
    )
    within = STEP | {"size": 0.9, "std": 0.7}
    assert stands(site, {"nearest": within}).note == "nearest to one: propeller 0.90 ± 0.70 %, within chance"
    cleaned = stands(site, {"causes": [worn | {"to_do": "cleaning the propeller takes it off"}]})
    assert cleaned.note.endswith(" a year since 2026-03-01. Cleaning the propeller takes it off")
    gain = STEP | {"name": "proportional gain of the governor", "to_do": "read the gains"}
    both = stands(site, {"causes": [worn, gain]})
    assert both.word == "changed: proportional gain of the governor"
    assert both.note == "4.20 ± 0.80 %, seen on 2026-03-01; beside it propeller 6.30 ± 0.80 % by now. Read the gains"
    assert (both.clearness, fouled.clearness) == (4.2 / 0.8, 0.0)
    assert stands(site, {}, trustworthy=False).word == "not trustworthy"
    assert stands(site, {"because": "two of them differ"}).note == "two of them differ"
    assert stands(site, {}, tests=0, tested_at=None, trustworthy=None).word == "no test yet"


def test_a_line_is_overdue_after_its_days_and_not_before(site):
    newest = datetime(2026, 3, 1, 9, tzinfo=UTC)
    assert stands(site, {}, now=newest + timedelta(days=365)).kind == "unchanged"
    late = stands(site, {}, now=newest + timedelta(days=366))
    # what is seen stays the word, in its own colour
    assert (late.kind, late.overdue) == ("test overdue", True)
    assert (late.word, late.look, late.note) == ("no change seen since 2025-03", "fine", "")
    # what is not judged yet is not told as overdue, but beside it
    unknown = stands(site, now=newest + timedelta(days=366))
    assert (unknown.kind, unknown.overdue) == ("being judged", True)
    both = stands(site, {"causes": [STEP]}, now=newest + timedelta(days=366))
    assert (both.kind, both.overdue) == ("changed", True)
    # of those that only want a test, what wears stands above what does not
    wearing = stands(site, {"causes": [STEP | {"expected": True}]}, now=newest + timedelta(days=366))
    assert (wearing.kind, wearing.clearness > late.clearness) == ("test overdue", True)
    assert (wearing.word, wearing.look) == ("worn as expected: propeller", "worn")
    # three rows carry the word, so three are counted: one is nothing else
    rows = [SimpleNamespace(standing=standing) for standing in (late, unknown, both)]
    assert headline_of(rows) == "3 shaft lines: 1 changed, 3 with a test overdue, 1 being judged"


def test_places_of_a_strip_chart():
    begin, end = datetime(2024, 7, 2, tzinfo=UTC), datetime(2026, 7, 2, tzinfo=UTC)
    axis = TimeAxis.over([end, begin])
    # margins of 2.5 % on both sides
    assert (axis.place(begin), axis.place(end)) == ("2.50%", "97.50%")
    middle = begin + (end - begin) / 2
    assert axis.place(middle) == "50.00%"
    assert [one["text"] for one in axis.ticks] == ["2025", "2026"]
    points = [
        {"at": begin.isoformat(), "value": 0.0, "low": -1.0, "high": 1.0},
        {"at": end.isoformat(), "value": 3.0, "low": 2.0, "high": 4.0},
    ]
    drawn = strip(points, axis, [{"at": middle, "number": 1}], zero=True)
    # from -2 to 4 in steps of 2: heights of 90 to 8 px
    assert [one["text"] for one in drawn["ticks"]] == ["−2", "0", "2", "4"]
    assert [one["y"] for one in drawn["ticks"]] == ["90.0", "62.7", "35.3", "8.0"]
    assert [one["zero"] for one in drawn["ticks"]] == [False, True, False, False]
    assert drawn["points"][0]["y"] == "62.7"
    assert drawn["points"][1]["high"] == "8.0"
    assert drawn["events"] == [{"x": "50.00%", "text": "1"}]


def test_dates_at_the_ends_of_a_strip_are_written_inwards():
    begin, end = datetime(2026, 2, 1, tzinfo=UTC), datetime(2026, 11, 30, tzinfo=UTC)
    assert [(one["text"], one["anchor"]) for one in TimeAxis.over([begin, end]).ticks] == [
        ("2026-02", "start"),
        ("2026-11", "end"),
    ]
    ticks = TimeAxis.over([datetime(2025, 2, 1, tzinfo=UTC), datetime(2027, 1, 15, tzinfo=UTC)]).ticks
    assert [(one["text"], one["anchor"]) for one in ticks] == [("2026", "middle"), ("2027", "end")]


def test_strips_of_one_value_and_of_open_ends_are_drawn():
    at = datetime(2026, 1, 5, tzinfo=UTC)
    axis = TimeAxis.over([at])
    drawn = strip([{"at": at.isoformat(), "value": 5.0, "low": None, "high": float("inf")}], axis, [], zero=False)
    assert drawn["points"][0]["low"] == drawn["points"][0]["y"] == drawn["points"][0]["high"]
    assert [one["text"] for one in axis.ticks] == ["2026-01"]
    assert strip([], axis, [], zero=True)["points"] == []


def test_pages_and_their_twins_say_the_same(site):
    browser = site.person("reader-ada")
    content = browser.get(f"/api/v1/ships/{ADA}/port").json
    page = browser.get(f"/ships/{ADA}/port").text
    assert content["events"][0]["note"] == "dock of Ada"
    assert "dock of Ada" in page
    assert [one["sha256"] for one in content["tests"]] == list(reversed(site.shas[ADA]))
    assert all(one["sha256"] in page for one in content["tests"])
    document = browser.get(f"/api/v1/fingerprints/{site.shas[ADA][0]}")
    assert json.loads(document.body)["conditions"]["ship"]["name"] == "Ada"


def test_an_event_is_noted_in_the_time_of_its_zone(site):
    tester = site.person("tester-ada")
    fields = {"what": "propeller-polished", "at": "2026-05-01T08:00", "zone": "Europe/Amsterdam", "numbers": "K_Q"}
    assert tester.post(f"/ships/{ADA}/port/events", fields).status == 303
    (event,) = [one for one in tester.get(f"/api/v1/ships/{ADA}/port").json["events"] if one["kind"] == fields["what"]]
    assert datetime.fromisoformat(event["at"]) == datetime(2026, 5, 1, 6, tzinfo=UTC)
    assert event["numbers"] == ["K_Q"]
    for wrong in ({"at": "yesterday"}, {"zone": "Atlantis"}, {"what": "sunk"}, {"what": "other"}):
        assert tester.post(f"/ships/{ADA}/port/events", fields | wrong).status == 400


def events_of(answer):
    return [json.loads(line[6:]) for line in answer.text.splitlines() if line.startswith("data: ")]


def test_events_of_a_job_go_on_where_the_browser_was(site):
    reader, store = site.person("reader-ada"), site.service.store
    path = f"/jobs/{site.jobs[ADA]}/events"
    first = reader.get(path, most_events=1)
    assert first.heads["content-type"].startswith("text/event-stream")
    assert events_of(first)[0]["state"] == "waiting"
    number = next(line[4:] for line in first.text.splitlines() if line.startswith("id: "))
    taken = claim(store, owner="w", version="0.1.0")
    assert taken.id == site.jobs[ADA]
    renew(store, taken, progress="Fitting")
    # nothing is missed, and what was seen is not told again
    (now,) = events_of(reader.get(path, heads=[("last-event-id", number)], most_events=1))
    assert (now["state"], now["progress"]) == ("running", "Fitting")
    refuse(store, taken, f"{site.service.recordings.absolute()}/ab/log.nc: expected a channel, found none.")
    told = reader.get(path, heads=[("last-event-id", number)])
    (end,) = events_of(told)
    assert (end["state"], end["sentence"]) == ("refused", "ab/log.nc: expected a channel, found none.")
    last = next(line[4:] for line in told.text.splitlines() if line.startswith("id: "))
    assert events_of(reader.get(path, heads=[("last-event-id", last)])) == []


def test_text_of_a_file_is_no_markup(made):
    site = made()
    tester = site.person("tester-ada")
    note = '<script>alert(1)</script>" onload=x'
    tester.post(f"/ships/{ADA}/port/events", {"what": "other", "at": "2026-05-01T08:00", "zone": "UTC", "note": note})
    page = tester.get(f"/ships/{ADA}/port").text
    assert "<script>alert" not in page
    assert "&lt;script&gt;alert(1)" in page


def test_who_sees_nothing_reads_that_nothing_is_here(site):
    assert site.person("reader-hidden").get("/api/v1/ships?q=Ada").json["lines"] == []
    assert site.person("reader-hidden").get("/api/v1/ships").json["lines"][0]["imo"] == HIDDEN
