"""Campaigns in which limits cannot be told apart."""

import pytest

from shaftprint.campaign import load_campaign
from shaftprint.errors import SignalError
from shaftprint.limits.prediction._governor_test import governor_test


def test_legs_alone_are_refused_before_anything_is_computed():
    with pytest.raises(
        SignalError, match=r"expected sines or steps about one working point.*found legs alone \(M1, M2\)"
    ):
        governor_test(None, load_campaign("two-speeds"), None)
