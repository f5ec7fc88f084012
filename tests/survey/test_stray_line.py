"""One line that something else moved, and what is no such line."""

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.identify import identify
from shaftprint.spectra import FrequencyResponse
from shaftprint.survey._stray_line import _without, stray_line

GAUGE = structure("GAUGE-CLOSED")
FREQUENCY_HZ = np.geomspace(0.02, 2.5, 14)
STD = 2e-3


def fit_to(*moved, of=GAUGE, values=None, seed=1):
    """Return a fit of GAUGE-CLOSED to the response of a structure whose lines of some numbers are moved by 2 %."""
    exact = of.response(of.vector(values or {}), 2j * np.pi * FREQUENCY_HZ)
    rng = np.random.default_rng(seed)
    response = exact + STD * (rng.standard_normal(exact.shape) + 1j * rng.standard_normal(exact.shape))
    response[:, list(moved)] += 0.02
    measured = FrequencyResponse(
        frequency_hz=FREQUENCY_HZ,
        response=response[:, np.newaxis],
        covariance=np.broadcast_to(STD**2 * np.eye(4), (FREQUENCY_HZ.size, 4, 4)),
        inputs=("n_set",),
        outputs=("n", "M_s"),
        lines=tuple(f"S{number}" for number in range(1, 15)),
    )
    return identify(GAUGE, measured, rng=np.random.default_rng(1))


def test_a_line_that_a_swell_moved_is_left_out_with_its_chance_and_the_rest_is_right():
    fit = fit_to(4)
    assert stray_line(fit).name == "S5"
    rest = _without(fit.response, "S5", "a swell")
    assert rest.remarks == {"S5": "a swell"}
    again = identify(GAUGE, rest, rng=np.random.default_rng(1))
    assert again.p_value > 0.05
    assert "S5" in fit.response.lines


@pytest.mark.parametrize("moved", [(), (0,), (13,), (4, 9), (4, 5)])
def test_none_two_or_the_first_and_last_line_are_no_stray_line(moved):
    assert stray_line(fit_to(*moved)) is None


def test_a_structure_that_lacks_something_has_no_stray_line():
    elastic = structure("GAUGE-ELASTIC")
    # a mode at 3.2 Hz, just above the lines, of two bodies of 1 and 0.3 s
    stiff = (2.0 * np.pi * 3.2) ** 2 / (1.0 + 1.0 / 0.3)
    assert stray_line(fit_to(of=elastic, values={"k_c": stiff, "d_c": 0.5})) is None
