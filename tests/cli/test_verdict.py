"""The verdict comes first on the terminal, and structures beside each other are compared."""

import json
import re

import pytest


def test_the_verdict_comes_first(run, demo):
    """The simulated line of the demo: all but delay and priors is found, the governor has little to spare."""
    folder, result = demo
    shown = run("show", folder).output
    lines = shown.splitlines()
    assert lines[0] == "Verdict: trustworthy, but not governor gains"
    assert lines[1].startswith(
        "  * The fit can be trusted: GAUGE-CLOSED explains 10 good spectral lines within their noise (p = "
    )
    kept = json.loads((folder / "fingerprint.json").read_text(encoding="utf-8"))["verdict"]["not_trusted"]
    first, second = (re.search(r"(\d+) %", kept[name])[1] for name in ("K_p", "K_i"))
    assert lines[2].startswith("  * Inertia, propeller, total delay, gain margin")
    assert f"can be used; governor gains (known to {first} and {second} %)" in lines[2]
    assert lines[3].startswith("  * Trusted: ")
    assert "k_q" in lines[3]
    assert re.match(r"  \* Not trusted: K_p \(\d+ %\), K_i \(\d+ %\)", lines[4]), lines[4]
    told = " ".join(shown.split())
    assert told.count("known to this share of the value only") == 1
    assert "The stability margins are small: a gain margin of 1." in shown
    assert "Verdict: trustworthy" in result.output
    # mostly its prior, and so among those that are not trusted: it stands behind those that may be used, and says why
    usable, unusable = result.output.split("Found too, but not to be used")
    assert "(I_dn)" in usable
    assert "Engine, coupling" in unusable
    found = next(
        words for words in " ".join(result.output.split()).split(" * ") if words.startswith("Engine, coupling")
    )
    assert "with the prior of the vessel file" in found
    # by hand: the rows of the vessel file at the engine sum up to 3.6466 kg m2, as its own comment says
    assert "(3.65 kg m2 at the engine shaft, times 3.82^2 at the propeller shaft, and 0.794 kg m2 there)" in found
    assert "; the test adds almost nothing to what was known before" in found


def test_the_report_of_the_demo_says_which_structure_the_data_want(demo):
    folder, _ = demo
    page = " ".join((folder / "index.html").read_text(encoding="utf-8").split())
    assert "GAUGE-CLOSED wins: its BIC is " in page
    assert "CL4 is rejected" in page


@pytest.mark.slow
def test_a_structure_that_does_not_fit_is_not_trustworthy(run, recording, tmp_path):
    given = ("--vessel", "stan-tug-1205", "--campaign", "short", "--no-progress", "--starts", 20)
    structures = ("--structure", "CL4", "--structure", "CL3")
    result = run("identify", recording, *given, *structures, "-o", tmp_path / "out")
    assert result.exit_code == 3
    lines = result.output.splitlines()
    assert lines[0] == "Verdict: not trustworthy"
    assert lines[1].startswith("  * The structure CL4 does not explain the data within their noise (chi-square ")
    assert "would disappear if there is inertia between engine and torque gauge" in lines[2]
    assert "Which structure: CL4" in result.output
    page = (tmp_path / "out" / "index.html").read_text(encoding="utf-8")
    assert "Verdict: the fit is not trustworthy" in page
    assert "Which structure" in page
