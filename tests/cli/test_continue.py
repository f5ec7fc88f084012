"""``shaftprint continue``: what is refused; what it does with a recording is held in ``tests/rehearsal``."""

import json

import pytest

SHIP = ("--vessel", "stan-tug-1205", "--no-progress")


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (None, "name the folder in which shaftprint plan has put it"),
        ("{", "expected a plan in JSON, found something else"),
        (json.dumps({"schema_version": 9}), "expected a plan of schema 1, found schema 9"),
        (json.dumps({"schema_version": 1, "\x1b[2J": "\x1b]0;evil\x07"}), "is not a plan of schema 1"),
    ],
)
def test_a_folder_that_holds_no_plan_is_refused_in_a_sentence(run, tmp_path, content, message):
    if content is not None:
        (tmp_path / "plan.json").write_text(content, encoding="utf-8")
    result = run("continue", "nothing.nc", "--plan", tmp_path, *SHIP)
    assert result.exit_code == 1
    assert message in " ".join(result.stderr.split())
    # no text out of a file moves the cursor
    assert "\x1b" not in result.stderr
    assert not (tmp_path / "next").exists()


def test_a_plan_is_asked_for(run):
    result = run("continue", "recording.nc", *SHIP)
    assert result.exit_code == 2
    assert "--plan" in result.stderr
