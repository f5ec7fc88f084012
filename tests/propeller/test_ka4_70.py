"""Ka4-70 in nozzle 19A against tabulated values at bollard pull and slopes worked out apart from the polynomial."""

import numpy as np
import pytest

from shaftprint.errors import PropellerError
from shaftprint.propeller import ka4_70_in_19a

# P/D, K_T, K_TN, K_Q at J = 0
BOLLARD = [
    (1.00, 0.5257, 0.2688, 0.04424),
    (1.05, 0.5669, 0.2916, 0.04941),
    (1.10, 0.6088, 0.3145, 0.05492),
    (1.11, 0.6172, 0.3191, 0.05606),
    (1.20, 0.6938, 0.3602, 0.06683),
]


@pytest.mark.parametrize(("pitch_ratio", "thrust", "nozzle", "torque"), BOLLARD)
def test_bollard_pull_table(pitch_ratio, thrust, nozzle, torque):
    point = ka4_70_in_19a().at(0.0, pitch_ratio)
    assert point.thrust == pytest.approx(thrust, abs=5e-5)
    assert point.nozzle_thrust == pytest.approx(nozzle, abs=5e-5)
    assert point.torque == pytest.approx(torque, abs=5e-6)


def test_the_tug_underway_at_nearly_ten_knots():
    """J .494 at P/D 1.11: K_T .329, K_Q .0468, a -.90, b -.41, as worked out for the Stan Tug at full speed."""
    point = ka4_70_in_19a().at(0.494, 1.11)
    assert point.thrust == pytest.approx(0.329, abs=5e-4)
    assert point.torque == pytest.approx(0.0468, abs=5e-5)
    assert point.a == pytest.approx(-0.90, abs=5e-3)
    assert point.b == pytest.approx(-0.41, abs=5e-3)


@pytest.mark.parametrize(("advance", "p", "q"), [(0.0, 1.52, 2.27), (0.5, 2.38, 2.67)])
def test_slopes_to_pitch(advance, p, q):
    point = ka4_70_in_19a().at(advance, 1.11)
    assert point.p == pytest.approx(p, abs=5e-3)
    assert point.q == pytest.approx(q, abs=5e-3)


def test_at_the_quay_the_speed_of_advance_does_not_matter():
    point = ka4_70_in_19a().at(0.0, 1.11)
    assert (point.a, point.b) == (0.0, 0.0)


def test_figure_of_merit_is_nearly_the_same_at_every_pitch():
    """``(K_T / pi)^1.5 / K_Q`` is 1.55: a property of nozzle 19A at the quay."""
    for pitch_ratio in (1.0, 1.1, 1.2):
        point = ka4_70_in_19a().at(0.0, pitch_ratio)
        assert (point.thrust / np.pi) ** 1.5 / point.torque == pytest.approx(1.55, abs=0.005)


@pytest.mark.parametrize(("advance", "pitch_ratio"), [(0.1, 0.7), (0.37, 0.7), (0.1, 1.11), (0.7, 1.11), (0.7, 1.37)])
def test_slopes_are_those_of_the_curve(advance, pitch_ratio):
    """Against differences of the logarithms, in the room's own range."""
    curve, step = ka4_70_in_19a(), 1e-5
    ahead, behind = curve.at(advance * (1 + step), pitch_ratio), curve.at(advance * (1 - step), pitch_ratio)
    more, less = curve.at(advance, pitch_ratio * (1 + step)), curve.at(advance, pitch_ratio * (1 - step))
    point = curve.at(advance, pitch_ratio)
    assert point.a == pytest.approx(np.log(ahead.thrust / behind.thrust) / (2 * step), rel=1e-6)
    assert point.b == pytest.approx(np.log(ahead.torque / behind.torque) / (2 * step), rel=1e-6)
    assert point.p == pytest.approx(np.log(more.thrust / less.thrust) / (2 * step), rel=1e-6)
    assert point.q == pytest.approx(np.log(more.torque / less.torque) / (2 * step), rel=1e-6)


def test_efficiency_has_the_open_water_maximum_of_a_ducted_propeller():
    """``J K_T / (2 pi K_Q)`` peaks between 0.55 and 0.65 near J = 0.6 for P/D 1.0 to 1.2."""
    curve = ka4_70_in_19a()
    advance = np.linspace(0.05, 0.75, 141)
    efficiency = np.array([curve.at(j, 1.11).efficiency for j in advance])
    assert 0.5 < efficiency.max() < 0.65
    assert 0.5 < advance[efficiency.argmax()] < 0.7


def test_thrust_ends_where_the_curve_does():
    curve = ka4_70_in_19a()
    last = curve.zero_thrust_advance(1.11)
    assert 0.8 < last < 1.0
    assert curve.at(last - 1e-9, 1.11).thrust == pytest.approx(0.0, abs=1e-7)


@pytest.mark.parametrize(
    ("advance", "pitch_ratio", "words"),
    [
        (0.3, 0.5, "P/D from 0.6 to 1.4, found 0.5"),
        (0.3, 1.5, "P/D from 0.6 to 1.4, found 1.5"),
        (-0.1, 1.0, "advance ratio J from 0 to"),
        (1.2, 1.0, "advance ratio J from 0 to"),
        (float("nan"), 1.0, "advance ratio J from 0 to"),
    ],
)
def test_outside_of_the_range_is_refused(advance, pitch_ratio, words):
    with pytest.raises(PropellerError, match=words):
        ka4_70_in_19a().at(advance, pitch_ratio)
