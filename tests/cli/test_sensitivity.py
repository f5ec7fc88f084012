"""``shaftprint sensitivity`` draws the Bode families of a structure."""

import pytest


@pytest.mark.slow
def test_one_figure_an_output(run, tmp_path):
    folder = tmp_path / "cl1"
    result = run("sensitivity", "cl1", "-o", folder, "--no-progress")
    assert result.exit_code == 0
    assert result.output == f"{folder / 'CL1_n.svg'}\n{folder / 'CL1_M_s.svg'}\n"
    assert all((folder / name).read_text().startswith("<?xml") for name in ("CL1_n.svg", "CL1_M_s.svg"))


@pytest.mark.parametrize(("suffix", "start"), [("png", b"\x89PNG"), ("pdf", b"%PDF")])
def test_other_kinds_of_picture(run, tmp_path, suffix, start):
    result = run("sensitivity", "OL1", "-o", tmp_path / "out", "--format", suffix)
    assert result.exit_code == 0
    assert (tmp_path / "out" / f"OL1_n.{suffix}").read_bytes().startswith(start)


@pytest.mark.long
@pytest.mark.slow
def test_figures_of_the_thesis_with_measured_responses_where_it_has_them(run, recording, tmp_path):
    test = ("--recording", recording, "--vessel", "stan-tug-1205", "--campaign", "short")
    result = run("sensitivity", "thesis", *test, "-o", tmp_path / "out", "--no-progress")
    assert result.exit_code == 0, result.stderr
    drawn = {path.stem.removeprefix("figure_"): path.read_text() for path in (tmp_path / "out").glob("*.svg")}
    assert set(drawn) == {"4.2", "4.3", "4.4", "4.5", "4.6", "4.7", "4.8", "B.1-B.2", "B.3-B.4", "D.1"}
    assert {figure for figure, text in drawn.items() if "data, 95" in text} == {"4.4", "4.5", "4.6", "4.7", "4.8"}


def test_a_recording_comes_with_its_vessel_and_campaign(run, recording, tmp_path):
    result = run("sensitivity", "thesis", "--recording", recording, "--vessel", "stan-tug-1205", "-o", tmp_path / "out")
    assert result.exit_code == 2
    assert "missing: --campaign" in result.stderr
    result = run("sensitivity", "CL1", "--recording", recording, "-o", tmp_path / "out")
    assert result.exit_code == 2
    assert "shaftprint sensitivity thesis" in result.stderr


def test_unknown_structure_and_kind(run, tmp_path):
    result = run("sensitivity", "OL9", "-o", tmp_path / "out")
    assert result.exit_code == 1
    assert "there is no structure 'OL9'" in result.stderr
    assert not (tmp_path / "out").exists()
    assert run("sensitivity", "OL1", "-o", tmp_path / "out", "--format", "bmp").exit_code == 2
