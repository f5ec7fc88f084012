"""The smooth function that a search makes small: its gradient, and optima that are known by hand."""

import numpy as np
import pytest

from shaftprint.design import Effort
from shaftprint.design.search._criterion import DeterminantWithFloor, WorstWish
from shaftprint.design.search._problem import Possibility, Problem
from shaftprint.design.search._search import random_start, search
from shaftprint.design.search._uses import Uses

ODD = tuple(range(1, 40, 2))


def uses(*rows, harmonics=ODD, samples=512):
    return Uses(transfer=np.array(rows, dtype=complex), harmonics=harmonics, samples=samples, draws=1)


def two_legs(criterion, rng, power=30.0):
    """Random information of four parameters by two legs, with bounds of three signals each."""

    def information():
        rows = rng.standard_normal((len(ODD), 4, 2))
        return rows @ rows.swapaxes(1, 2)

    def leg():
        return uses(*(rng.standard_normal((3, len(ODD))) + 1j * rng.standard_normal((3, len(ODD)))))

    possibilities = tuple(
        Possibility(
            of_lines=(information(), information()), of_priors=0.1 * np.eye(4), slopes=rng.standard_normal((4, 3))
        )
        for _ in range(2)
    )
    return Problem(
        possibilities=possibilities, uses=(leg(), leg()), seconds=(100.0, 50.0), criterion=criterion, power=power
    )


@pytest.mark.parametrize("criterion", [WorstWish(), DeterminantWithFloor(0.1)])
@pytest.mark.parametrize("power", [10.0, 100.0])
def test_gradient_is_exact(criterion, power):
    """Against differences over four points, whose error goes with the fourth power of the step."""
    rng = np.random.default_rng(3)
    problem = two_legs(criterion, rng, power)
    start = random_start(problem, rng)
    _, gradient = problem.value_and_gradient(start)
    step = 1e-4
    for place in rng.integers(0, start.size, size=12):
        move = np.zeros(start.size)
        move[place] = step
        ahead, behind = (problem.value_and_gradient(start + k * move)[0] for k in (1, -1))
        far, back = (problem.value_and_gradient(start + k * move)[0] for k in (2, -2))
        slope = (8.0 * (ahead - behind) - (far - back)) / (12.0 * step)
        assert gradient[place] == pytest.approx(slope, rel=1e-6, abs=1e-8)


def test_size_of_a_leg_does_not_matter():
    rng = np.random.default_rng(4)
    problem = two_legs(WorstWish(), rng)
    start = random_start(problem, rng)
    scaled = start * np.repeat([3.0, 0.2], 2 * len(ODD))
    value, gradient = problem.value_and_gradient(start)
    assert problem.value_and_gradient(scaled)[0] == pytest.approx(value, rel=1e-12)
    # so the gradient stands at right angles to the amplitudes of every leg
    halves = (gradient * start).reshape(2, -1).sum(axis=1)
    assert halves == pytest.approx([0.0, 0.0], abs=1e-12 * np.linalg.norm(gradient) * np.linalg.norm(start))


def test_norm_of_one_sine_by_hand():
    """The mean of ``sin^p`` over its positive half is ``C(p, p/2) / 2^(p + 1)``: of ``sin^4`` it is 3/16."""
    single = uses([2.0], harmonics=(3,), samples=64)
    norm, _ = single.norm(np.array([0.5j]), 4.0)
    assert norm == pytest.approx((3.0 / 16.0) ** 0.25)
    assert single.largest(np.array([0.5j])) == pytest.approx(1.0)


def test_equal_lines_become_a_square_wave():
    """Power under a peak of one: of a sine 1/2, of a square wave 1, which nothing passes.

    All lines tell equally much of one number, so that the power alone counts. With twenty odd harmonics there is a
    signal near the square wave.
    """
    flat = np.ones((len(ODD), 1, 1))
    possibility = Possibility(of_lines=(flat,), of_priors=np.zeros((1, 1)), slopes=np.ones((1, 1)))
    both = uses(np.ones(len(ODD)), -np.ones(len(ODD)))
    problem = Problem(possibilities=(possibility,), uses=(both,), seconds=(1.0,), criterion=WorstWish(), power=100.0)
    rng = np.random.default_rng(0)
    values = [search(problem, random_start(problem, rng), Effort(), share_held=1.0) for _ in range(3)]
    (amplitudes,) = problem.split(min(values, key=lambda value: value[0])[1])
    power = 0.5 * np.sum(np.abs(amplitudes) ** 2) / both.largest(amplitudes).max() ** 2
    assert 0.8 < power < 1.0


def test_criteria_of_a_diagonal_covariance_by_hand():
    """Variances 4 and 1 with a floor of 2: half of the mean logarithm of 8 and 5; ratios 2 and 1: of the p-norm."""
    inverse, slopes = np.diag([4.0, 1.0]), np.eye(2)
    value, weight = DeterminantWithFloor(2.0).value_and_weight(inverse, slopes)
    assert value == pytest.approx(np.log(8.0 * 5.0) / 4.0)
    assert weight == pytest.approx(np.diag([16.0 / 8.0, 1.0 / 5.0]) / 4.0)
    value, _ = WorstWish(power=2.0).value_and_weight(inverse, slopes)
    assert value == pytest.approx(0.5 * np.log(4.0 + 1.0))
