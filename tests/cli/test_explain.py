"""``shaftprint explain``: the thesis' way and the gauge-aware one side by side."""

GIVEN = ("--vessel", "stan-tug-1205", "--campaign", "short", "--no-progress")


def test_three_tables_and_their_words(run, recording, tmp_path):
    result = run("explain", recording, *GIVEN, "-o", tmp_path / "out")
    assert result.exit_code == 0
    for heading in ("The factor:", "The damping:", "The drift:"):
        assert heading in result.output
    assert "calculation, downstream of the gauge" in result.output
    assert "GAUGE-CLOSED" in result.output
    assert not set("\N{MINUS SIGN}\N{PLUS-MINUS SIGN}\N{DEGREE SIGN}") & set(result.output)
    page = (tmp_path / "out" / "index.html").read_text(encoding="utf-8")
    assert 'id="explanation"' in page
    assert (tmp_path / "out" / "figures" / "missing_damping.svg").is_file()


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
