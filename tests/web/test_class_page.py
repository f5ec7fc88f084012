"""The page of a class: who is held against whom follows the rights by ship."""

from dataclasses import replace
from datetime import UTC, datetime

from tests.web.conftest import ADA, HIDDEN

from shaftprint.errors import ServerError
from shaftprint.store import open_store, record_event

ADDRESS = "/classes/Stan%20Tug%201205"


def judged_for(site, name):
    answer = site.person(name).get(ADDRESS)
    assert answer.status == 200
    (question,) = site.service.desk.asked
    site.service.desk.asked.clear()
    return question["lines"], answer.text


def test_only_ships_that_a_person_sees_are_held_against_each_other(site):
    lines, page = judged_for(site, "reader-ada")
    assert lines == [[{"name": "Ada", "imo_number": ADA}, "port"]]
    assert "Hidden" not in page
    lines, page = judged_for(site, "reader-all")
    assert {ship["imo_number"] for ship, _ in lines} == {ADA, HIDDEN}
    assert "Hidden" in page
    assert "No ship is other than its sisters" in page


def test_what_is_asked_again_is_not_judged_again_until_a_line_has_something_new(site):
    reader = site.person("reader-all")
    first = reader.get(ADDRESS)
    assert reader.get(f"{ADDRESS}?number=I_dn").status == 200
    assert reader.get(ADDRESS).text == first.text
    assert len(site.service.desk.asked) == 1
    # whoever sees one ship only has another answer
    site.person("reader-ada").get(ADDRESS)
    assert [len(one["lines"]) for one in site.service.desk.asked] == [2, 1]
    with open_store(site.service.serving.store) as store:
        record_event(store, str(HIDDEN), "docking", at=datetime(2026, 9, 1, tzinfo=UTC))
    site.person("reader-ada").get(ADDRESS)
    assert len(site.service.desk.asked) == 2
    reader.get(ADDRESS)
    reader.get(ADDRESS)
    assert [len(one["lines"]) for one in site.service.desk.asked] == [2, 1, 2]


def test_a_refusal_is_not_kept(site):
    class Dying:
        async def ask(self, question, *, longest_s):
            raise ServerError("The process that read it has died.")

        async def close(self):
            """Do nothing."""

    reader = replace(site, service=replace(site.service, desk=Dying())).person("reader-all")
    assert "has died" in reader.get(ADDRESS).text
    assert "No ship is other than its sisters" in site.person("reader-all").get(ADDRESS).text
