"""``shaftprint compare-structures``: which of several structures a recording wants."""

import pytest

GIVEN = ("--vessel", "stan-tug-1205", "--campaign", "short", "--no-progress", "--starts", 20)


def of(*names):
    return [word for name in names for word in ("--structure", name)]


@pytest.fixture(scope="module")
def call(recording):
    def arguments(*names, more=()):
        return ("compare-structures", recording, *GIVEN, *of(*names), *more)

    return arguments


@pytest.mark.slow
def test_the_gauge_aware_loop_beats_those_of_the_thesis_and_the_output_says_why(run, call):
    result = run(*call("CL3", "gauge-closed", "CL4"))
    assert result.exit_code == 0
    lines = result.output.splitlines()
    assert lines[0] == "Which structure: GAUGE-CLOSED"
    assert lines[1].startswith("  * GAUGE-CLOSED wins: its BIC is ")
    assert lines[1].endswith("below that of CL4, the next (very strong evidence).")
    assert any(line.startswith("  * GAUGE-CLOSED explains the data (chi-square") for line in lines)
    assert any(line.startswith("  * CL3 is rejected (chi-square") and "p < 1e-12" in line for line in lines)
    assert any(line.startswith("  * GAUGE-CLOSED holds CL4 as a special case") for line in lines)
    assert any(line.startswith("  * Lines left out of the fit are predicted") for line in lines)
    assert "Fitted to the same 40 data" in result.output
    assert "within larger ones" in result.output
    table = result.output[result.output.index("lowest BIC first") :]
    assert table.index("GAUGE-CLOSED") < table.index("CL4") < table.index("CL3")


def test_open_loops_without_weights_and_without_leaving_lines_out(run, call):
    result = run(*call("OL2", "OL3", more=("--unweighted", "--folds", 0)))
    assert result.exit_code == 0
    assert "reaches a FitPercent of M_s" in result.output
    assert "left out" not in result.output
    # no law: OL2 is OL3 without delay, but the fits are not weighted
    assert "199 drawn tests" in result.output


def test_structures_that_are_not_nested_have_no_second_table(run, call):
    result = run(*call("CL1", "CL3", more=("--folds", 0)))
    assert result.exit_code == 0
    assert "within larger ones" not in result.output


def test_what_cannot_be_compared_ends_in_one_sentence(run, call):
    result = run(*call("OL3", "CL4"))
    assert result.exit_code == 1
    assert "structures OL3 and CL4 explain different data" in result.stderr
    result = run(*call("CL4"))
    assert result.exit_code == 1
    assert "expected 2 or more structures, found 1" in result.stderr


def test_what_is_held_and_known_counts(run, call):
    result = run(*call("CL3", "CL4", more=("--folds", 0, "--hold", "t_d=0.1", "--prior", "tau_n=0.3+-0.1")))
    assert result.exit_code == 0
    assert "CL4" in result.output.splitlines()[0]
    result = run(*call("CL3", "CL4", more=("--hold", "kappa=1")))
    assert result.exit_code == 1
    assert "--hold kappa: expected a parameter of CL3, CL4" in result.stderr
