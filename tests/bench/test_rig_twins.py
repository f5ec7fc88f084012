"""Twins of measured rigs, from files to numbers by the command line; ``benchmarks/rig_twins.py`` makes the table."""

import numpy as np
import pytest
from benchmarks.rig_twins import outcome_of
from benchmarks.rigs_made import TWINS

# Cheap ones, which take a response in frequency, a table and a delay.
CHEAP = ("flexible_beam", "brushless_axis")
# Three delays under inputs that nearly repeat: one start alone ends at the right one, and the verdict says so.
ALONE = ("shaft_behind_loggers",)


@pytest.mark.parametrize(
    "maker", [pytest.param(name, marks=pytest.mark.slow if name in CHEAP else pytest.mark.long) for name in TWINS]
)
def test_numbers_of_a_rig_are_found_without_a_line_of_python(maker, tmp_path):
    twin = TWINS[maker](np.random.default_rng([0, list(TWINS).index(maker)]))
    outcome = outcome_of(twin, tmp_path)
    assert "error" not in outcome, outcome
    assert set(outcome["numbers"]) == set(twin.truth)
    for name, one in outcome["numbers"].items():
        # one of sixteen thousand lies further by chance
        assert abs(one["value"] - one["true"]) < 4.0 * one["std"], name
    assert outcome["trustworthy"] or maker in ALONE, outcome["verdict"]
