"""``shaftprint validate`` on the short recording of the demo: its staircase is new to a fit of its sines.

A saved fingerprint is validated in ``tests/docs``, as the page shows it.
"""

import re
import shutil

import pytest

GIVEN = ("--vessel", "stan-tug-1205", "--campaign", "short", "--no-progress")


@pytest.mark.slow
def test_identified_in_one_go_with_the_sets_of_the_thesis(run, recording):
    result = run("validate", recording, *GIVEN, "--starts", 20, "--thesis-sets", "--linear-torque")
    assert result.exit_code == 0, result.stderr
    heading = next(line for line in result.output.splitlines() if "right model" in line and "benchmark" in line)
    assert [name for name in ("GAUGE-CLOSED", "CL4", "OL1+OL5", "CL3", "OL1+OL4", "benchmark") if name in heading] == [
        "GAUGE-CLOSED",
        "CL4",
        "OL1+OL5",
        "CL3",
        "OL1+OL4",
        "benchmark",
    ]
    assert "linear in its speed" in result.output


@pytest.mark.slow
def test_a_failed_validation_is_said_in_words_and_exits_with_0(run, recording):
    # a governor that is three times too weak
    result = run("validate", recording, *GIVEN, "--starts", 20, "--hold", "K_i=1.0", "--hold", "K_p=1.0")
    assert result.exit_code == 0
    assert result.output.startswith("Validation: the linear model ")
    words = r"The linear validation fails: GAUGE-CLOSED misses more than 15 % of the motion in \d+ of 8 excerpts"
    assert re.search(words, result.output)


def test_a_record_that_is_not_there_ends_in_a_sentence(run, recording, demo):
    result = run("validate", recording, *GIVEN, "--fingerprint", demo[0], "--record", "C11")
    assert result.exit_code == 1
    assert "record C11: expected a chirp or staircase of campaign" in result.stderr


@pytest.mark.slow
def test_a_record_of_the_identification_is_refused(run, recording, demo):
    refused = run("validate", recording, *GIVEN, "--fingerprint", demo[0], "--record", "St1", "--used", "St1")
    assert refused.exit_code == 1
    assert "the model was identified from it, so that it proves nothing" in refused.stderr
    marked = run(
        "validate", recording, *GIVEN, "--fingerprint", demo[0], "--record", "St1", "--used", "St1", "--allow-in-sample"
    )
    assert marked.exit_code == 0
    assert "(identified from it)" in marked.output
    assert "Nothing is proved" in marked.output


@pytest.mark.slow
def test_the_fmu_of_a_fingerprint_is_judged_as_the_fingerprint_is(run, recording, demo, tmp_path):
    """Without the square of the speed, which the linear FMU has not either."""
    pytest.importorskip("fmpy")
    if shutil.which("cc") is None:
        pytest.skip("there is no C compiler called cc")
    path = tmp_path / "yard.fmu"
    assert run("export", "fmu", demo[0], "--linear", "-o", path, "--no-progress").exit_code == 0
    by_fmu = run("validate", recording, *GIVEN, "--model", path)
    assert by_fmu.exit_code == 0, by_fmu.stderr
    own = run("validate", recording, *GIVEN, "--fingerprint", demo[0], "--linear", "--linear-torque")
    fit = re.compile(r"\b\d\d\.\d\b")
    assert "yard.fmu" in by_fmu.output
    assert len(fit.findall(own.output)) > 4
    assert fit.findall(by_fmu.output)[:4] == fit.findall(own.output)[:4]


def test_a_model_is_named_alone(run, recording, demo):
    for words, said in (
        (("--model-variable", "speed=w"), "name it too"),
        (("--model", "a.fmu", "--fingerprint", demo[0]), "leave those out"),
    ):
        result = run("validate", recording, *GIVEN, *words)
        assert result.exit_code == 2
        assert said in " ".join(result.stderr.split())
