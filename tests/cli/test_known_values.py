"""What ``--prior`` and ``--hold`` understand."""

import click
import pytest

from shaftprint.cli._known_values import named_prior, named_value
from shaftprint.identify import Prior


@pytest.mark.parametrize(
    ("text", "name", "prior"),
    [
        ("g=0+-0.1", "g", Prior(mean=0.0, std=0.1)),
        ("g=0+/-0.1", "g", Prior(mean=0.0, std=0.1)),
        ("tau_up = -1.5e-1 +- 2e-2", "tau_up", Prior(mean=-0.15, std=0.02)),
    ],
)
def test_prior_is_understood(text, name, prior):
    assert named_prior(text) == (name, prior)


@pytest.mark.parametrize("text", ["g", "g=", "g=0", "g=0+-", "g=a+-1", "g=0+-nan", "g=inf+-1", "0+-1"])
def test_prior_that_is_none_is_refused(text):
    with pytest.raises(click.BadParameter, match=r"expected a parameter, its mean and its standard deviation"):
        named_prior(text)


@pytest.mark.parametrize("text", ["g=0+-0", "g=0+--0.1"])
def test_prior_needs_a_positive_deviation(text):
    with pytest.raises(click.BadParameter, match="expected a positive standard deviation; hold the parameter instead"):
        named_prior(text)


def test_value_is_understood():
    assert named_value(" v = 1.25 ") == ("v", 1.25)


@pytest.mark.parametrize("text", ["v", "v=", "v=x", "v=inf", "v=nan"])
def test_value_that_is_none_is_refused(text):
    with pytest.raises(click.BadParameter, match="expected a parameter and its value such as v=1"):
        named_value(text)
