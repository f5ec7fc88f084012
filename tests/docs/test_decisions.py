"""Decisions have heads of one form, say what holds today, and two that touch each other both say so."""

import re

import pytest
from decision_index import FOLDER, NO_ROOMS, PAIRS, decisions, head
from room_diagram import floors

NUMBERED = {one.number: one for one in decisions()}


def ids(one):
    return one.path.stem


def test_numbers_have_no_gap():
    assert [one.number for one in decisions()] == list(range(1, len(decisions()) + 1))
    assert [int(one.path.name[:4]) for one in decisions()] == [*NUMBERED]


@pytest.mark.parametrize("one", decisions(), ids=ids)
def test_the_head_names_rooms_that_are_there_and_what_holds(one):
    assert set(one.rooms) <= {*NO_ROOMS, *(name for floor in floors() for name in floor)}
    # one or two sentences that stand alone in the index, or the decision that took its place
    assert (60 < len(one.holds) < 450 and one.holds.endswith(".")) or one.touched("Replaced by")
    # who changes a decision writes anew what holds of it
    assert one.holds_with == one.touched("Changed by")


@pytest.mark.parametrize("one", decisions(), ids=ids)
def test_two_decisions_that_touch_each_other_both_say_so(one):
    for verb, answer in PAIRS.items():
        for number in one.touched(verb):
            other = NUMBERED[number]
            assert one.number in other.touched(answer), f"{other.path.name} does not say {answer}"
            # a later one changes an earlier one
            assert (one.number > number) == (verb in ("Changes", "Replaces"))


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        (("**Holds, with ", "Holds with "), "expected '\\*\\*Holds"),
        (("**Rooms.** ", "Rooms: "), "expected '# N. Title'"),
        (("Changed by [decision 56]", "Changed by 56 [decision 56]"), "expected '# N. Title'"),
        (("Accepted, November 2026.", "Accepted."), "expected '# N. Title'"),
    ],
)
def test_a_head_of_another_form_is_refused(tmp_path, change, expected):
    text = (FOLDER / "0052-legs.md").read_text(encoding="utf-8")
    path = tmp_path / "0052-legs.md"
    path.write_text(text, encoding="utf-8")
    assert head(path).touched("Changed by") == NUMBERED[52].touched("Changed by") != ()
    assert re.search(re.escape(change[0]), text)
    path.write_text(text.replace(*change, 1), encoding="utf-8")
    with pytest.raises(ValueError, match=expected):
        head(path)
