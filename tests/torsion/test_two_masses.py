"""Two masses for a whole line: what is exact, what is not, and the structure that is fitted."""

import math

import numpy as np
import pytest
from scipy.signal import TransferFunction, freqresp

from shaftprint.catalogue import two_mass_line
from shaftprint.models import check_structure
from shaftprint.torsion import modes
from shaftprint.torsion._two_masses import forced_response, two_masses

CYLINDERS = tuple(f"Cylinder {number}" for number in range(1, 7))


@pytest.fixture(scope="module")
def reduced(line):
    return two_masses(line, driven=CYLINDERS)


def test_a_line_of_two_masses_stays_what_it_is(chain):
    found = two_masses(chain([2.0, 3.0], [600.0], damping=0.7, load=0.2), driven=["mass 0"])
    assert (found.engine_kg_m2, found.propeller_kg_m2, found.load_nm_s_rad) == (2.0, 3.0, 0.2)
    assert found.stiffness_nm_rad == pytest.approx(600.0, rel=1e-3)
    assert found.damping_nm_s_rad == pytest.approx(0.7, rel=1e-3)
    assert found.series_hz == pytest.approx(math.sqrt(500.0) / (2.0 * math.pi), rel=1e-12)
    assert found.gauge_error < 1e-3
    assert found.accurate_to_hz == pytest.approx(3.0 * found.frequency_hz, rel=1e-12)


def test_sums_on_either_side_of_the_gauge(reduced):
    assert reduced.engine_kg_m2 == pytest.approx(54.006, abs=5e-5)
    assert reduced.propeller_kg_m2 == pytest.approx(17.0, abs=1e-9)


def test_first_mode_is_kept(line, reduced):
    found = modes(line)
    assert reduced.frequency_hz == found.frequency_hz[0]
    assert reduced.frequency_std_hz == found.frequency_std_hz[0]
    # omega^2 = k (1/J_e + 1/J_p)
    omega = math.sqrt(reduced.stiffness_nm_rad * (1.0 / 54.006 + 1.0 / 17.0))
    assert omega / (2.0 * math.pi) == pytest.approx(found.frequency_hz[0], rel=1e-6)


def test_errors_are_those_of_the_whole_line(line, reduced):
    """At the mode, and at the frequency up to which both responses are within a tenth."""
    share = dict.fromkeys(CYLINDERS, 1.0 / 6.0)
    frequency = np.array([0.5, reduced.accurate_to_hz, reduced.frequency_hz, 1.3 * reduced.accurate_to_hz])
    whole = forced_response(line, frequency, share)
    speed, torque = reduced.response(frequency)
    errors = np.abs(np.stack([speed / whole.speed_of("Cylinder 1"), torque / whole.gauge_torque_nm]) - 1.0)
    assert errors[1, 2] == pytest.approx(reduced.gauge_error, rel=1e-9)
    assert errors[:, 0].max() < 0.01
    assert errors[:, 1].max() <= 0.1 < errors[:, 3].max()
    # the gauge torque at resonance is 8 to 9 % off, because the gear swings with neither side
    assert 0.07 < reduced.gauge_error < 0.1


def test_coupling_and_shaft_behind_each_other_not_the_coupling_alone(reduced):
    """The spring is not that of the coupling: referred to the propeller shaft the propeller shaft is the softer one.

    15 kN m/rad times 3.82^2 = 219 kN m/rad against 172: behind each other 96; the coupling between all before it and
    all after it would swing at 19 to 20 Hz.
    """
    coupling, shaft = 15e3 * 14.5924, 172e3
    assert reduced.stiffness_nm_rad == pytest.approx(1.0 / (1.0 / coupling + 1.0 / shaft), rel=0.03)
    assert reduced.series_hz == pytest.approx(reduced.frequency_hz, rel=0.03)
    before = (3.64656 - 0.2096) * 14.5924
    alone = math.sqrt(coupling * (1.0 / before + 1.0 / (71.006 - before))) / (2.0 * math.pi)
    assert alone > 1.35 * reduced.frequency_hz


def test_a_line_that_is_never_near(chain):
    """A driven mass behind a soft spring of its own: two masses stand for nothing there."""
    found = two_masses(chain([0.01, 50.0, 20.0], [1e-3, 1e6]), driven=["mass 0"])
    assert found.accurate_to_hz < 0.1 * 3.0 * found.frequency_hz


# ---- the structure ----


def test_structure_has_the_equations_of_the_reduction(reduced):
    """Coefficients by hand against the parallel and series of impedances, and exact derivatives."""
    fitted = two_mass_line()
    check_structure(fitted)
    frequency = np.geomspace(0.1, 60.0, 25)
    values = {
        "J_e": reduced.engine_kg_m2,
        "J_p": reduced.propeller_kg_m2,
        "k": reduced.stiffness_nm_rad,
        "c": reduced.damping_nm_s_rad,
        "d": reduced.load_nm_s_rad,
    }
    found = fitted.response(fitted.vector(values), 2j * math.pi * frequency)
    assert found == pytest.approx(np.stack(reduced.response(frequency)), rel=1e-10)
    assert fitted.inputs == ("M_e",)
    assert tuple(fitted.outputs) == ("w_e", "M_s")


def test_structure_with_round_numbers():
    """J_e = 2, J_p = 1, k = 8, c = 1, d = 3: numerators s^2 + 4 s + 8 and s^2 + 11 s + 24, hand-derived denominator."""
    fitted = two_mass_line(
        engine_kg_m2=2.0, propeller_kg_m2=1.0, stiffness_nm_rad=8.0, damping_nm_s_rad=1.0, load_nm_s_rad=3.0
    )
    omega = np.array([0.3, 2.0, 9.0])
    denominator = [2.0, 9.0, 27.0, 24.0]
    expected = [freqresp(TransferFunction(top, denominator), omega)[1] for top in ([1.0, 4.0, 8.0], [1.0, 11.0, 24.0])]
    assert fitted.response(fitted.vector({}), 1j * omega) == pytest.approx(np.array(expected), rel=1e-12)
    bounds = {p.name: (p.lower, p.upper) for p in fitted.free}
    assert bounds["J_e"] == (0.4, 10.0)
    assert bounds["c"] == (0.0, 5.0)


def test_natural_frequency_of_the_structure():
    """sqrt(8 (1/2 + 1)) / (2 pi), and the damping ratio (1 (1.5) + 3 2 / (1 3)) / (2 sqrt(12))."""
    fitted = two_mass_line(
        engine_kg_m2=2.0, propeller_kg_m2=1.0, stiffness_nm_rad=8.0, damping_nm_s_rad=1.0, load_nm_s_rad=3.0
    )
    named = fitted.named(fitted.vector({}))
    found = {item.name: float(item.of(named)) for item in fitted.combinations}
    assert found["f_1"] == pytest.approx(math.sqrt(12.0) / (2.0 * math.pi), rel=1e-12)
    assert found["zeta_1"] == pytest.approx(3.5 / (2.0 * math.sqrt(12.0)), rel=1e-12)
    assert found["J_e + J_p"] == 3.0
