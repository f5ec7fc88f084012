"""Ends of intervals against a brute-force scan, in cases where the climb from the estimate stops too early.

The scan holds the number on a grid and fits all else from many starts (``benchmarks/interval_ends.py``, which does it
in two hundred random cases).
"""

import numpy as np
import pytest
from benchmarks.interval_ends import SAME_END, Compared, fitted, scanned

from shaftprint.identify import profile


@pytest.mark.slow
@pytest.mark.parametrize(
    ("case", "name"),
    [
        # from the estimate alone omega_n stops at 9.6 where the data allow 8.25
        (17, "omega_n"),
        # and tau_dn at 0.42 where they allow 0.37
        (9, "tau_dn"),
        # a case in which it does not
        (3, None),
    ],
)
def test_are_those_of_a_scan(case, name):
    fit = fitted(case)
    found = profile(fit)
    free = list(fit.objective.free)
    interval = found.intervals[name or fit.structure.free[0].name]
    lower, upper = scanned(fit, interval, found.points[:, free], np.random.default_rng(1))
    compared = Compared(case=case, structure=fit.structure.name, interval=interval, lower=lower, upper=upper)
    assert compared.difference <= SAME_END
