"""Ends of intervals where no step leads to the contour itself."""

from dataclasses import dataclass

import numpy as np
import pytest

from shaftprint.distributions import NORMAL_95
from shaftprint.identify.uncertainty._contour import furthest


@dataclass
class Stepped:
    """Half the square of x, which is 3 higher from a place on: the derivatives tell nothing of that."""

    jump: float
    lower: np.ndarray
    upper: np.ndarray

    def residuals(self, theta):
        beyond = np.sqrt(6.0) * (np.abs(theta[:, 0]) >= self.jump)
        return np.column_stack([theta[:, 0], beyond]), np.tile([[[1.0, 0.0]]], (theta.shape[0], 1, 1))

    def following(self, starts):
        return lambda theta, rows: self.residuals(theta)


@dataclass
class Itself:
    """The number is the parameter."""

    objective: Stepped

    def chosen(self, rows):
        return self

    def values(self, theta):
        return theta[:, 0]

    def slopes(self, theta, curvature):
        return np.ones_like(theta)


def ends(jump, bound=10.0):
    objective = Stepped(jump, np.array([-bound]), np.array([bound]))
    return furthest(Itself(objective), np.zeros(1), np.array([-1.0, 1.0]), np.full(2, NORMAL_95))


def test_where_the_cost_is_rough_the_end_is_that_of_the_way_so_far():
    found = ends(jump=1.85)
    assert found.value == pytest.approx([-NORMAL_95, NORMAL_95], rel=1e-6)
    assert np.all(np.abs(found.theta) < 1.85)
    assert not found.is_open.any()
    assert not found.failed.any()


def test_an_end_that_is_far_from_the_contour_is_none_and_not_open():
    found = ends(jump=0.9)
    assert found.failed.all()
    assert not found.is_open.any()


def test_what_a_bound_stops_is_open():
    found = ends(jump=5.0, bound=0.9)
    assert found.value == pytest.approx([-0.9, 0.9])
    assert found.is_open.all()
    assert not found.failed.any()
