"""Choosing by eye: what a process beside the server says of a recording, and what the form makes of it."""

import shutil
import tomllib

import pytest
from tests.web.conftest import ADA

from shaftprint.campaign import Campaign, load_campaign
from shaftprint.errors import ServerError
from shaftprint.web._kept import Making
from shaftprint.web._recorded import drawn_recording
from shaftprint.web.calculator._windows import _with_more, chosen_campaign, windows

FILES = "vessel=stan-tug-1205&campaign=short"
TEST = {"name": "S1", "words": "sine of 0.5 Hz", "used": True, "has_window": True, "start_s": 20.0, "settled_s": 24.0,
        "stop_s": 40.0, "window_stop_s": 40.0, "shortest_s": 2.0, "missing": "", "later_s": 1.25,
        "differences": ["begins at 21.25 s where the campaign says 20 s"]}  # fmt: skip
SINE = {"name": "S1", "frequency_hz": 0.5, "amplitude_v": 0.5, "start_s": 20.0, "settled_s": 24.0, "stop_s": 40.0}
OTHER = SINE | {"name": "S2", "start_s": 50.0, "settled_s": 54.0, "stop_s": 90.0}


def recorded(**changed):
    """Return what is said of a made-up recording with two sines."""
    campaign = Campaign(name="two", duration_s=100.0, offset_v=-5.0, sines=(SINE, OTHER))
    times = {name: OTHER[name] for name in ("name", "start_s", "settled_s", "stop_s")}
    second = TEST | times | {"window_stop_s": 90.0, "later_s": None, "differences": []}
    return {
        "campaign": campaign.model_dump(mode="json"),
        "more": [],
        "tests": [TEST, second],
        "strips": [{"name": "set point", "unit": "V", "low": [-5.5, -5.0], "high": [-4.5, -5.0]}],
        "start_s": 0.0, "stop_s": 100.0,
        "repairs": [{"channel": "<b>M</b>", "kind": "outlier", "time_s": 25.0, "count": 3}], "repaired": 1,
        "gaps": [{"channel": "n", "reason": "has no values", "start_s": 60.0, "stop_s": 70.0}], "lost": 1,
        "refusal": "", "findings": [], "found": 0,
    } | changed  # fmt: skip


def looked(site, **changed):
    """Let the windows of Ada's upload have been looked at; return the address of their page."""
    number = site.uploads[ADA]
    key, args = f"windows {number} stan-tug-1205 short", {"answer": recorded(**changed)}
    site.service.kept.put_making(Making(key=key, kind="windows", args=args, state="done", sentence=""))
    return f"/recordings/{number}/windows"


class Answering:
    """Answers as the process beside the server does."""

    async def ask(self, question, *, longest_s):
        assert question.pop("kind") == "chosen"
        return chosen_campaign(**question)


@pytest.fixture
def choosing(site, monkeypatch):
    monkeypatch.setattr(type(site.service.desk), "ask", Answering.ask)
    return site


FORM = {"vessel": "stan-tug-1205", "campaign": "short", "use.0": "on", "later.0": "1.25", "from.0": "0.5"}


def test_a_form_gives_the_campaign_that_it_shows(choosing):
    address = looked(choosing)
    tester = choosing.person("tester-ada")
    assert "Windows of Ada.nc" in tester.get(f"{address}?{FILES}").text
    told = tester.post(f"/api/v1{address}/campaign", FORM)
    assert told.status == 200, told.text
    campaign = Campaign.model_validate(tomllib.loads(told.json["file"]))
    # the second was not ticked
    assert [(one.name, one.start_s, one.settled_s, one.stop_s) for one in campaign.sines] == [
        ("S1", 21.25, 25.75, 41.25)
    ]
    page = tester.post(f"{address}/campaign", FORM).text
    assert "settled_s = 25.75" in page
    assert "<b>M</b>" not in page


def test_a_form_that_is_shown_again_has_the_seconds_to_the_last_digit(choosing):
    """A second look at the file must not move a window: it lies an hour later in the recording than in the plan."""
    address = looked(choosing)
    page = choosing.person("tester-ada").post(f"{address}/campaign", FORM | {"later.0": "3725.384"}).text
    assert 'name="later.0" value="3725.384"' in page
    assert "start_s = 3745.384" in page


def test_a_file_of_a_folder_is_found_again_whatever_it_is_called(made, tmp_path):
    """In an address & and # begin something else."""
    folder = tmp_path / "lies-here"
    folder.mkdir()
    (folder / "a&b #1.toml").write_bytes(b"x")
    site = made(folders=(folder,))
    tester = site.person("tester-all")
    form = {"vessel": "folder:0:a&b #1.toml", "campaign": "short"}
    asked = tester.post(f"/recordings/{site.uploads[ADA]}/windows", form)
    assert asked.status == 303, asked.text
    assert "It is being read" in tester.get(asked.heads["location"]).text
    # whether a file lies there is nothing that a reader is told
    reader = site.person("reader-all")
    for name in ("a%26b%20%231.toml", "none.toml"):
        address = f"/recordings/{site.uploads[ADA]}/windows?vessel=folder:0:{name}&campaign=short"
        assert (name, reader.get(address).status) == (name, 403)


def test_a_campaign_that_is_kept_is_a_file_of_the_line_which_its_form_has_chosen(choosing):
    tester = choosing.person("tester-ada")
    kept = tester.post(f"{looked(choosing)}/campaign", FORM | {"do": "save"})
    assert kept.status == 303
    place = kept.heads["location"]
    number = place.partition("campaign=")[2].partition("#")[0]
    (path,) = (choosing.service.recordings / number).iterdir()
    assert path.name == "Ada-by-eye.toml"
    assert load_campaign(path).sines[0].settled_s == 25.75
    form = tester.get(place.partition("#")[0]).text
    assert f'<option value="{number}" selected>Ada-by-eye.toml' in form
    # its kind is known: it is offered where a campaign is asked for, and nowhere else
    assert form.count(f'value="{number}"') == 2
    assert "settled_s = 25.75" in tester.get(f"/recordings/{number}").text
    assert tester.get("/api/v1/recordings/" + number).json["file"]["kind"] == "campaign"


@pytest.mark.parametrize(
    ("fields", "status", "words"),
    [
        ({"later.0": "soon"}, 400, "expected a number of seconds"),
        ({"later.0": "nan"}, 400, "expected a number of seconds"),
        ({"to.0": "-15"}, 400, "at least one period of 2 s"),
        ({"vessel": "none"}, 404, "no such page"),
        ({"campaign": "as-recorded"}, 409, "not looked at yet"),
    ],
)
def test_what_cannot_be_chosen_is_refused_in_a_sentence(choosing, fields, status, words):
    told = choosing.person("tester-ada").post(f"/api/v1{looked(choosing)}/campaign", FORM | fields)
    assert (told.status, words in told.json["refused"]) == (status, True), told.text


def test_places_along_time_are_shares_of_the_recording():
    drawn = drawn_recording(recorded(start_s=-100.0, stop_s=100.0))
    assert drawn["tests"][0] == {
        "start": "60.0000%", "length": "10.0000%", "from": "62.0000%", "to": "70.0000%", "window": "8.0000%",
    }  # fmt: skip
    assert drawn["repairs"][0]["x"] == "62.5000%"
    assert (drawn["gaps"][0]["x"], drawn["gaps"][0]["width"]) == ("80.0000%", "5.0000%")
    # from -5.5 to -4.5 V in 84 of 96 px
    assert drawn["strips"][0]["path"] == "M0.5,6.0L1.5,48.0L1.5,48.0L0.5,90.0Z"


def test_what_the_set_point_shows_beside_the_campaign_can_be_taken_in():
    planned = Campaign(name="one", duration_s=100.0, offset_v=-5.0, sines=(SINE,))
    seen = Campaign(name="seen", duration_s=100.0, offset_v=-5.01, sines=(SINE, OTHER))
    both, more = _with_more(planned, seen, [(20.0, 40.0)])
    assert (more, both.sines[1].start_s) == (["seen 1"], 50.0)
    # where it was not found, what is there in its place is offered too
    assert _with_more(planned, seen, [])[1] == ["seen 1", "seen 2"]
    # another middle would be another voltage of every sine
    assert _with_more(planned, seen.model_copy(update={"offset_v": -4.0}), [(20.0, 40.0)])[1] == []
    taken = chosen_campaign(both.model_dump(mode="json"), {}, "by eye")
    assert taken["tests"] == ["S1", "seen 1"]
    left = chosen_campaign(both.model_dump(mode="json"), {"seen 1": {"is_used": False}}, "by eye")
    assert left["tests"] == ["S1"]


def test_what_the_set_point_shows_may_take_the_place_of_a_test_that_was_not_made_as_planned():
    planned = Campaign(name="one", duration_s=100.0, offset_v=-5.0, sines=(SINE,))
    late = {"name": "S2", "start_s": 150.0, "settled_s": 154.0, "stop_s": 190.0}
    seen = Campaign(name="seen", duration_s=200.0, offset_v=-5.0, sines=(SINE, OTHER | late))
    both, more = _with_more(planned, seen, [])
    assert more == ["seen 1", "seen 2"]
    content, left_out = both.model_dump(mode="json"), {"is_used": False}
    # S1 and what was seen in its place are one test: either can be chosen, and both cannot
    made = chosen_campaign(content, {"S1": left_out, "seen 2": left_out}, "by eye")
    assert made["tests"] == ["seen 1"]
    made = chosen_campaign(content, {"seen 1": left_out, "seen 2": left_out}, "by eye")
    assert tomllib.loads(made["text"])["duration_s"] == 100.0
    # behind the last test of the plan come 60 s
    made = chosen_campaign(content, {"seen 1": left_out}, "by eye")
    assert made["tests"] == ["S1", "seen 2"]
    assert tomllib.loads(made["text"])["duration_s"] == 250.0
    with pytest.raises(ServerError, match="expected seen 1 to start after S1 has stopped"):
        chosen_campaign(content, {"seen 2": left_out}, "by eye")


def test_a_test_that_was_found_later_is_not_offered_once_more():
    planned = Campaign(name="one", duration_s=100.0, offset_v=-5.0, sines=(SINE,))
    later = SINE | {"start_s": 120.0, "settled_s": 124.0, "stop_s": 140.0}
    seen = Campaign(name="seen", duration_s=200.0, offset_v=-5.0, sines=(SINE, later | {"name": "S2"}))
    both, more = _with_more(planned, seen, [(119.9, 139.9)])
    assert [one.start_s for one in both.sines if one.name in more] == [20.0]
    # one that begins where another ends is not the same
    assert _with_more(planned, seen, [(100.0, 120.2), (139.8, 150.0), (20.0, 40.0)])[1] == ["seen 1"]


@pytest.mark.slow
def test_a_recording_is_shown_with_its_windows(demo, tmp_path):
    recording = tmp_path / "log.nc"
    shutil.copy(demo[0] / "recording.nc", recording)
    told = windows(str(recording), "stan-tug-1205", "short")
    planned = load_campaign("short")
    assert told["refusal"] == ""
    assert [one["name"] for one in told["tests"]] == [one.name for one in planned.excitations]
    assert all(not one["differences"] for one in told["tests"])
    assert told["stop_s"] == pytest.approx(planned.duration_s, abs=1.0)
    strips = {one["name"]: one for one in told["strips"]}
    # the staircase goes from -6 to -3 V
    assert min(strips["set point"]["low"]) < -5.95
    assert max(strips["set point"]["high"]) > -3.05
