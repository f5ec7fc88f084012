"""``shaftprint show`` prints a saved fingerprint."""

import json

from shaftprint.fingerprint import read_fingerprint


def test_file_and_folder_show_the_same(run, demo):
    folder, _ = demo
    from_file, from_folder = run("show", folder / "fingerprint.json"), run("show", folder)
    assert from_file.exit_code == 0
    assert from_file.output == from_folder.output


def test_all_that_is_in_it(run, demo):
    folder, _ = demo
    output = run("show", folder).output
    found = read_fingerprint(folder / "fingerprint.json")
    for quantity in (*found.parameters, *found.combinations, *found.physical, *found.margins, *found.calibration):
        assert f" {quantity.name} " in output
    for finding in found.findings:
        assert finding in output
    assert found.conditions.vessel in output
    assert "priors: " in output
    assert "g = 0.00 +/- 0.10" in output
    # the truth is not for those who identify
    assert "truth" not in output


def test_fingerprint_of_another_schema(run, demo, tmp_path):
    content = json.loads((demo[0] / "fingerprint.json").read_text())
    content["schema_version"] = 99
    path = tmp_path / "later.json"
    path.write_text(json.dumps(content))
    result = run("show", path)
    assert result.exit_code == 1
    assert str(path) in result.stderr
    assert "schema" in result.stderr


def test_files_that_are_none(run, tmp_path, recording):
    for path in (tmp_path / "missing.json", tmp_path, recording):
        result = run("show", path)
        assert result.exit_code == 1
        assert "expected a fingerprint in JSON" in result.stderr
    foreign = tmp_path / "foreign.json"
    foreign.write_text("[1, 2]")
    result = run("show", foreign)
    assert result.exit_code == 1
    assert f"{foreign}: expected a fingerprint" in result.stderr


def test_what_is_common_to_tables_is_said_once(run, demo):
    words = " ".join(run("show", demo[0]).output.split())
    assert words.count("+/- is one standard deviation. It is not shown where") == 1
