"""``shaftprint explain`` without a folder; ``tests/docs`` looks at tables and report, made as the pages show it."""

import pytest

GIVEN = ("--vessel", "stan-tug-1205", "--campaign", "short", "--no-progress")


@pytest.mark.slow
def test_without_a_folder_nothing_is_written(run, recording, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = run("explain", recording, *GIVEN)
    assert result.exit_code == 0
    assert "Report:" not in result.output
    assert not list(tmp_path.iterdir())


def test_a_recording_that_is_not_there_is_named(run, tmp_path):
    result = run("explain", tmp_path / "none.nc", *GIVEN)
    assert result.exit_code == 1
    assert "none.nc" in result.output
