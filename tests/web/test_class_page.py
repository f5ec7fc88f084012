"""The page of a class: who is held against whom follows the rights by ship."""

from tests.web.conftest import ADA, HIDDEN

ADDRESS = "/classes/Stan%20Tug%201205"


def judged_for(site, name):
    answer = site.person(name).get(ADDRESS)
    assert answer.status == 200
    (question,) = site.service.desk.asked
    site.service.desk.asked.clear()
    return question["lines"], answer.text


def test_only_ships_that_a_person_sees_are_held_against_each_other(site):
    lines, page = judged_for(site, "reader-ada")
    assert lines == [[str(ADA), "port"]]
    assert "Hidden" not in page
    lines, page = judged_for(site, "reader-all")
    assert sorted(lines) == sorted([[str(ADA), "port"], [str(HIDDEN), "port"]])
    assert "Hidden" in page
    assert "No ship is other than its sisters" in page
