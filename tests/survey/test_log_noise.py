"""The noise of a log: white noise of single values by hand, and nothing beyond half of their rate."""

import numpy as np
import pytest

from shaftprint.errors import IdentificationError
from shaftprint.identify.prediction._noise_levels import stated_noise
from shaftprint.spectra._line_responses import NOT_MEASURED_STD
from shaftprint.survey._assumed_noise import with_log
from shaftprint.survey._shipped_noise import STAN_TUG_NOISE_UNDERWAY


def shown(levels, hertz):
    place = levels.outputs.index("v_s")
    return levels.at([hertz])[0, place, place].real


def test_the_log_of_the_tug_shows_what_it_did():
    levels = with_log(STAN_TUG_NOISE_UNDERWAY, cycle_s=0.2, highest_hz=2.25, ship_speed_m_s=4.75)
    for hertz in (0.01, 0.3, 2.0):
        assert levels.at([hertz]) == pytest.approx(STAN_TUG_NOISE_UNDERWAY.at([hertz]), rel=1e-9)
    assert shown(levels, 2.3) == pytest.approx(NOT_MEASURED_STD**2)
    # white noise of 0.02 m/s in values of 5 Hz, over 4.75 m/s: what is left of a log where no ship moves any more
    assert shown(levels, 2.0) == pytest.approx(2.0 * 0.02**2 * 0.2 / 4.75**2, rel=0.3)


@pytest.mark.parametrize("speed", [2.5, 9.0])
def test_the_same_log_is_less_of_a_higher_speed(speed):
    levels = with_log(STAN_TUG_NOISE_UNDERWAY, cycle_s=0.2, highest_hz=2.25, ship_speed_m_s=speed)
    assert shown(levels, 2.0) == pytest.approx(2.0 * 0.02**2 * 0.2 / speed**2, rel=0.35)
    # slowly it shows how the ship moves, of which each has its share
    assert shown(levels, 0.01) == pytest.approx(shown(STAN_TUG_NOISE_UNDERWAY, 0.01), rel=0.2)


def test_a_slower_log_has_more_noise_and_ends_earlier():
    levels = with_log(STAN_TUG_NOISE_UNDERWAY, cycle_s=1.0, highest_hz=0.45, ship_speed_m_s=9.5)
    more = shown(levels, 0.3) - shown(STAN_TUG_NOISE_UNDERWAY, 0.3)
    assert more == pytest.approx(2.0 * 0.02**2 * (1.0 / 9.5**2 - 0.2 / 4.75**2), rel=0.35)
    assert shown(levels, 0.5) == pytest.approx(NOT_MEASURED_STD**2)
    # speed and torque of the shaft are what they were
    alone = levels.of_outputs("n", "M_s").at([0.3, 2.0])
    assert alone == pytest.approx(STAN_TUG_NOISE_UNDERWAY.of_outputs("n", "M_s").at([0.3, 2.0]), rel=1e-9)


def test_a_table_of_three_outputs_has_the_coherence_of_each_pair():
    levels = stated_noise(
        frequency_hz=[0.1, 1.0],
        densities=[(4.0, 9.0, 16.0)] * 2,
        coherences=[(0.1 + 0.2j, 0.3, -0.4j)] * 2,
        set_point_per_v=0.2,
        outputs=("n", "M_s", "v_s"),
    )
    expected = np.array([[4.0, 0.6 + 1.2j, 2.4], [0.6 - 1.2j, 9.0, -4.8j], [2.4, 4.8j, 16.0]])
    assert levels.density[0] == pytest.approx(expected)


@pytest.mark.parametrize(
    ("changed", "message"),
    [({"cycle_s": 0.0}, "0 s"), ({"highest_hz": -1.0}, "-1 Hz"), ({"ship_speed_m_s": 0.0}, "0 m/s")],
)
def test_a_log_without_a_rate_or_a_speed_is_refused(changed, message):
    numbers = {"cycle_s": 0.2, "highest_hz": 2.25, "ship_speed_m_s": 4.75}
    with pytest.raises(IdentificationError, match=f"expected v_s among the outputs and positive numbers.*{message}"):
        with_log(STAN_TUG_NOISE_UNDERWAY, **(numbers | changed))


def test_levels_without_a_log_are_refused():
    quay = STAN_TUG_NOISE_UNDERWAY.of_outputs("n", "M_s")
    with pytest.raises(IdentificationError, match="expected v_s among the outputs"):
        with_log(quay, cycle_s=0.2, highest_hz=2.25, ship_speed_m_s=4.75)
