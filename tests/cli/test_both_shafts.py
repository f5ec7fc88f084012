"""Both shafts of a ship on the command line: sailed into one recording, identified from it, compared."""

import json
from pathlib import Path
from typing import Any

import pytest

from shaftprint.cli import _identify_both
from shaftprint.fingerprint import read_fingerprint

PORT, STARBOARD = "stan-tug-1205", "stan-tug-1205-starboard"
SIDES = ("--vessel", PORT, "--starboard", STARBOARD, "--campaign", "at-once", "--no-progress")


@pytest.fixture
def found_once(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """What was found in the one recording: a command that asks for it again is given it, and prints or writes it."""
    found: list[Any] = []
    run_both = _identify_both.run_both

    def give(*arguments: Any, **options: Any) -> Any:
        found.append(found[0] if found else run_both(*arguments, **options))
        return found[-1]

    monkeypatch.setattr(_identify_both, "run_both", give)
    return found


@pytest.mark.slow
def test_one_recording_gives_a_fingerprint_of_each_side_and_how_they_differ(
    run: Any, tmp_path: Path, found_once: list[Any]
) -> None:
    recording, result = tmp_path / "both.nc", tmp_path / "result"
    sailed = run("sail", PORT, "at-once", "--starboard", STARBOARD, "-o", recording, "--seed", "3", "--no-progress")
    assert sailed.exit_code == 0, sailed.output
    truth = json.loads((tmp_path / "both.truth.json").read_text(encoding="utf-8"))
    assert truth["port"]["normalised"] == truth["starboard"]["normalised"]
    found = run("identify", recording, *SIDES, "-v", "-o", result)
    assert found.exit_code == 0, found.output
    document = run("identify", recording, *SIDES, "--no-report", "--json", "-o", tmp_path / "plain")
    given = json.loads(document.output)["result"]
    assert len(found_once) == 2
    assert "Is starboard other than port? No:" in found.output
    words = " ".join(found.output.split())
    assert "Not the same in both tests, so that the error counts in full: gauge scale" in words
    assert {"fingerprint of port", "fingerprint of starboard", "differences", "causes", "wash"} <= given.keys()
    for side in ("port", "starboard"):
        wash = given["wash"][side]
        assert abs(wash["share"] - truth["water"][f"{side}_share"]) < 3.0 * wash["std"]
        assert (result / side / "index.html").exists()
        fingerprint = read_fingerprint(result / side / "fingerprint.json")
        for name, true in (("I_dn", 17.0), ("I_up", 54.006), ("omega_n", 10.3)):
            number = next(one for one in (*fingerprint.physical, *fingerprint.parameters) if one.name == name)
            assert abs(number.value - true) < 3.0 * number.std, name
    page = (result / "comparison" / "index.html").read_text(encoding="utf-8")
    assert "No difference of the lines is seen" in page
    assert "The wash of the other propeller takes" in page
    # the same by two fingerprints alone
    compared = run("compare", result / "port", result / "starboard")
    assert "Is starboard other than port? No:" in compared.output


@pytest.mark.parametrize(
    ("more", "said"),
    [
        (("--with", "limits"), "--starboard goes with neither --with nor --leg"),
        (("--leg", "M1"), "--starboard goes with neither --with nor --leg"),
        (("--mode", "thesis"), "--starboard goes with neither --with nor --leg"),
        (("--starboard", PORT), "expected channels of their own, found M_s, PTM_1"),
        (("--campaign", "thesis"), "expected a path that ends in .toml or one of the shipped names at-once, in-turn"),
    ],
)
def test_what_does_not_go_with_both_shafts_is_refused(
    run: Any, tmp_path: Path, more: tuple[str, ...], said: str
) -> None:
    refused = run("identify", tmp_path / "x.nc", *SIDES, *more, "-o", tmp_path / "result")
    assert refused.exit_code != 0
    assert said in " ".join(refused.output.split())
    assert not (tmp_path / "result").exists()


def test_both_lines_are_sailed_into_the_native_container_alone(run: Any, tmp_path: Path) -> None:
    refused = run("sail", PORT, "in-turn", "--starboard", STARBOARD, "-o", tmp_path / "both.csv")
    assert refused.exit_code == 1
    assert "`shaftprint convert` writes the other formats" in " ".join(refused.output.split())
