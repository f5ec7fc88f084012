"""What planned tests would see of a change, against what two tests of that accuracy say of themselves."""

import numpy as np
import pytest
from tests.drift.test_differ import PRIORS
from tests.known_fits import TRUTH, exact_response, fitted, taken

from shaftprint.catalogue import structure
from shaftprint.drift import differ
from shaftprint.drift._along import p_value_of_largest, whitened
from shaftprint.drift._pair import pair_of
from shaftprint.drift._visible import visible_changes
from shaftprint.identify import Settings, predict_accuracy

# Standard normal quantile of four fifths.
POWER = 0.8416


def visible(share):
    model = structure("GAUGE-CLOSED")
    return {one.cause.name: one.size for one in visible_changes(_accuracy(model, share))}


def _accuracy(model, share):
    return predict_accuracy(model, exact_response(model, TRUTH, share), values=TRUTH, priors=PRIORS)


def test_half_the_noise_sees_half_the_change():
    """What was known beforehand cancels, so that nothing but the noise counts."""
    plain, calm = visible(0.002), visible(0.001)
    assert len(plain) == 7
    for name, size in plain.items():
        assert calm[name] == pytest.approx(0.5 * size, rel=1e-3)


@pytest.mark.slow
def test_sizes_are_those_that_a_pair_of_such_tests_states():
    """The size at which four of five scores pass the limit: the deviation of the pair times limit and power."""
    test = taken(fitted("GAUGE-CLOSED", TRUTH, share=0.002, settings=Settings(starts=20, priors=PRIORS)))
    pair = pair_of(test, test, load_repeatability=0.005)
    white = whitened(pair.difference, pair.covariance, pair.directions)
    limit = next(at for at in np.arange(1.9, 3.5, 0.001) if p_value_of_largest(at, white.cosines()) <= 0.05)
    stated = {cause.name: (limit + POWER) * float(white.sizes((at,))[1][0]) for at, cause in enumerate(pair.causes)}
    for name, size in visible(0.002).items():
        assert size == pytest.approx(stated[name], rel=0.15), name
    assert differ(test, test).changes == ()


def test_nothing_is_predicted_where_a_parameter_is_not_known_at_all():
    model = structure("GAUGE-CLOSED")
    accuracy = predict_accuracy(model, exact_response(model, TRUTH, 0.002), values=TRUTH, priors={})
    assert all(np.isfinite(one.size) and one.size > 0.0 for one in visible_changes(accuracy))
