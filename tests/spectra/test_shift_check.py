"""A torque that comes later than load and inertia let expect, also where a lever moves a pitch with the speed."""

from dataclasses import replace

import numpy as np
import pytest
from tests.known_fits import exact_response

from shaftprint.catalogue import structure
from shaftprint.spectra._shift_check import shift_reasons

PITCH = {"q": 1.9, "c_comb": 0.75, "tau_th": 0.6, "t_th": 0.15}
LINES = [("GAUGE-CLOSED", {}), ("GAUGE-COMBINATOR", PITCH)]


@pytest.mark.parametrize(("name", "given"), LINES)
def test_a_late_gauge_is_named_with_its_size(name, given):
    (reason,) = shift_reasons(exact_response(structure(name), given | {"t_gauge": 0.05}, 0.001))
    assert reason.kind == "gauge latency"
    assert "about 50 ms later" in reason.sentence


def test_a_late_pick_up_is_a_gauge_that_comes_too_early():
    (reason,) = shift_reasons(exact_response(structure("GAUGE-CLOSED"), {"t_pickup": 0.05}, 0.001))
    assert "about 50 ms earlier" in reason.sentence


@pytest.mark.parametrize(("name", "given"), LINES)
def test_a_gauge_behind_a_slow_filter_is_told_from_a_late_one(name, given):
    """A low-pass of first order: 1 / (1 + j f / 1 Hz)."""
    response = exact_response(structure(name), given, 0.001)
    size = np.ones((len(response.outputs), 1, response.omega_rad_s.size), dtype=complex)
    size[response.outputs.index("M_s"), 0] = 1.0 / (1.0 + 1j * response.omega_rad_s / (2.0 * np.pi * 1.0))
    (reason,) = shift_reasons(replace(response, response=response.response * size))
    assert reason.kind == "gauge latency"
    assert "as behind a low-pass of 1 Hz" in reason.sentence


@pytest.mark.parametrize(("name", "given"), LINES)
def test_a_line_as_it_is_has_no_shift(name, given):
    assert shift_reasons(exact_response(structure(name), given, 0.001)) == ()


def test_a_torque_that_no_line_has_is_not_told_as_a_shift():
    """Loads far above and below what a propeller takes fit no delay at all: nothing is said, and nothing warned of."""
    response = exact_response(structure("GAUGE-CLOSED"), {}, 0.001)
    size = np.ones((len(response.outputs), 1, 1))
    size[response.outputs.index("M_s")] = -30.0
    turned = replace(response, response=response.response * size)
    assert shift_reasons(turned) == ()
