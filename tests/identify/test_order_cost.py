"""What an order costs a steady sine: sinc functions and random walks by hand."""

import numpy as np
import pytest

from shaftprint.campaign import Campaign, Sine
from shaftprint.identify import NoiseLevels, planned_response
from shaftprint.identify.prediction._order_cost import common_share


def levels(speed_density, *, orders_hz=(5.0,)):
    matrix = np.diag([speed_density, 1e-5]).astype(complex)
    return NoiseLevels(
        frequency_hz=np.array([0.001, 10.0]),
        density=np.stack([matrix, matrix]),
        outputs=("n", "M_s"),
        set_point_per_v=0.2,
        orders_hz=orders_hz,
    )


def sine(hertz):
    one = Sine(name="S1", frequency_hz=hertz, amplitude_v=0.6, start_s=0.0, settled_s=10.0, stop_s=10.0 + 200.0 / hertz)
    return Campaign(name="one sine", duration_s=200.0, offset_v=-5.0, sines=(one,))


@pytest.mark.parametrize("bins", [0.0, 0.2, 0.5, 1.3])
def test_at_constant_speed_line_and_order_have_a_sinc_in_common(bins):
    share = common_share(5.0, bins / 40.0, 40.0, levels(1e-14))
    assert share == pytest.approx(np.sinc(bins) ** 2, abs=1e-3)


def test_a_speed_of_white_noise_makes_the_angle_walk():
    """The angle of white speed noise walks: ``D = 2 pi^2 f^2 S t``, of which a mean over the window keeps a sixth."""
    density, order_hz, seconds = 2e-6, 5.0, 40.0
    walk = 2.0 * np.pi**2 * order_hz**2 * density * seconds
    share = common_share(order_hz, 0.0, seconds, levels(density))
    # what is slower than a tenth of a turn of the window is another mean speed, a few hundredths of it
    assert 1.0 - share == pytest.approx(walk / 6.0, rel=0.15)


def test_a_planned_line_on_an_order_has_a_doubtful_torque_and_a_remark():
    plain = planned_response(sine(5.005), levels(1e-14, orders_hz=()))
    beside = planned_response(sine(5.005), levels(1e-14))
    seconds = 200.0 / 5.005
    enlarged = 1.0 / (1.0 - np.sinc(0.005 * seconds) ** 2)
    assert beside.covariance[0, 1, 1] / plain.covariance[0, 1, 1] == pytest.approx(enlarged, rel=1e-2)
    assert beside.covariance[0, 0, 0] == plain.covariance[0, 0, 0]
    assert beside.remarks["S1"].startswith(f"beside an order of the shaft: its torque is {np.sqrt(enlarged):.2g} times")
    assert not plain.remarks


def test_a_planned_line_away_from_orders_is_as_it_was():
    plain, other = (planned_response(sine(4.5), levels(1e-6, orders_hz=orders)) for orders in ((), (5.0,)))
    assert np.array_equal(plain.covariance, other.covariance)
    assert not other.remarks
