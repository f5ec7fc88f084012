"""``shaftprint validate`` on the short recording of the demo: its staircase is new to a fit of its sines.

A saved fingerprint is validated in ``tests/docs``, as the page shows it.
"""

import re
import shutil
from dataclasses import dataclass
from types import SimpleNamespace

import pytest

from shaftprint.catalogue import structure
from shaftprint.cli.commands._validate import print_validation
from shaftprint.validation import ValidationSettings

GIVEN = ("--vessel", "stan-tug-1205", "--campaign", "short", "--no-progress")


@pytest.mark.slow
def test_identified_in_one_go_with_the_sets_of_the_thesis(run, recording):
    result = run("validate", recording, *GIVEN, "--starts", 20, "--thesis-sets", "--linear-torque")
    assert result.exit_code == 3, result.stderr
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
def test_a_failed_validation_is_said_in_words_and_exits_with_3(run, recording):
    # a governor that is three times too weak
    result = run("validate", recording, *GIVEN, "--starts", 20, "--hold", "K_i=1.0", "--hold", "K_p=1.0")
    assert result.exit_code == 3
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
    own = run("validate", recording, *GIVEN, "--fingerprint", demo[0], "--linear", "--linear-torque")
    # a line about a working point fails the large steps
    assert (by_fmu.exit_code, own.exit_code) == (3, 3), by_fmu.stderr
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


MODEL = structure("GAUGE-CLOSED")
SETTINGS = ValidationSettings()


@dataclass(frozen=True)
class Found:
    """A validation as it is printed."""

    comparisons: tuple
    headline: str = "nothing is proved"
    sentences: tuple = ()
    findings: tuple = ()
    model: object = MODEL
    settings: object = SETTINGS


def step_at(second, outcome):
    number = SimpleNamespace(output="n", unit="%", measured=54.0, measured_std=15.0, expected=70.49, expected_std=0.11)
    misfit = SimpleNamespace(
        output="n", error=0.1, error_interval=(0.0, 0.4), p_value=0.4, fit_percent=41.5, fit_ceiling=40.3
    )
    misfit.outcome = outcome
    title = f"step at {second:.1f} s, 6.46 to 6.82 V"
    return SimpleNamespace(
        excerpt=SimpleNamespace(record="St1", title=title, step_s=second, in_sample=False),
        misfits=(misfit,),
        delays=(SimpleNamespace(delay_s=0.038, std_s=0.089),),
        step_numbers=[SimpleNamespace(**vars(number), name=name, agrees=True) for name in ("overshoot", "peak time")],
        outcome=outcome,
    )


def test_excerpts_that_noise_hides_are_counted_and_others_named_in_every_row(capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "100")
    print_validation(Found(comparisons=(step_at(656.3, "undecided"), step_at(666.3, "passes"))))
    printed = capsys.readouterr().out
    assert "1 excerpt of which noise hides how well the model meets it: --verbose." in printed
    assert "656.3" not in printed
    heading, _, *rows = printed.partition(" step and number")[2].splitlines()
    assert heading.split()[-1] == "agree"
    assert [row.split("   ")[0].strip() for row in rows[:2]] == [
        "St1, 666.3 s: overshoot of n [%]",
        "St1, 666.3 s: peak time of n [%]",
    ]
    print_validation(Found(comparisons=(step_at(656.3, "undecided"),)))
    # no table at all
    assert "\u2500" not in capsys.readouterr().out
