"""How well the structure explains each part of a joint fit within its noise.

At the true parameters the sum of squared distances of a part is on average its number of data. The fit takes from all
parts together as much as there are parameters, and from each as much as it says of them: with the information ``H_i``
of a part and ``H`` of all, ``trace(H^-1 H_i)``, which add up to the number of parameters (the trace of the part's rows
of the hat matrix; Cook and Weisberg, "Residuals and Influence in Regression", section 2.1).
"""

from collections.abc import Sequence

import numpy as np

from shaftprint.identify.fit._fit_test import FitTest
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.fit._pseudo_inverse import PseudoInverse


def part_tests(identification: Identification) -> Sequence[FitTest]:
    """Return the test of every part of a fit, in the order of its parts.

    ``identification``: a joint fit of parameters that several responses share; of a fit to one response it is that of
    the fit.
    """
    objective, values = identification.objective, identification.values
    theta = values[list(objective.free)]
    rows, _ = objective.sensitivity(theta, expected=False)
    inverse = PseudoInverse.of(rows).inverse
    tests = []
    for number, term in enumerate(objective.terms):
        of_term, _ = objective.sensitivity_to(term, theta, expected=False)
        taken = float(np.einsum("ir,ij,jr->", of_term, inverse, of_term))
        _, test = term.assessed(values, number)
        tests.append(
            FitTest(
                chi_square=test.chi_square,
                degrees_of_freedom=round(test.count - taken),
                mean=test.mean - taken,
                variance=test.variance - 2.0 * taken,
                lines=test.lines,
            )
        )
    return tuple(tests)
