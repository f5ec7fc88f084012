"""Stability of every set that the thesis identified, with exact delay, and of the gauge-aware set of the simulator.

The expected numbers were found apart from the package (roots of ``1 + L`` and a fine frequency sweep); the thesis only
says "stable". It prints the denominator of the lag as ``s^2 + zeta omega_n s + omega_n^2`` (eqs 4.22, 4.23); that is
half the damping in ``s^2 + 2 zeta omega_n s + omega_n^2``.
"""

from dataclasses import dataclass

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.models import Delay, Parameter, PIGovernor, Shaft, Structure, feedback, margins

FIRST = {"g": 0.0, "v": 1.0}
CL3 = {"tau_n": 0.3537, "K_p": 1.1833, "K_i": 5.3967, "omega_n": 7.2133, "zeta": 0.4}
CL4 = {"tau_n": 0.3290, "K_p": 1.6004, "K_i": 4.4388, "t_d": 0.1161, "omega_n": 9.7705, "zeta": 0.4}
OL14 = {"tau_n": 0.3897, "K_p": 2.902, "K_i": 4.2699, "omega_n": 8.2912, "zeta": 0.5616}
OL15 = {"tau_n": 0.3897, "K_p": 4.36, "K_i": 4.2664, "t_d": 0.1023, "omega_n": 8.202, "zeta": 0.88}


@dataclass(frozen=True)
class Row:
    """One set and what is known of its loop; ``nan`` where nothing was printed."""

    structure: str
    values: dict
    poles: tuple[complex, ...]
    stable: bool = True
    gain_margin: float = np.nan
    delay_margin: float = np.nan
    speed_peak: tuple[float, float] = (np.nan, np.nan)
    torque_peak: tuple[float, float] = (np.nan, np.nan)


def governor_with_delay():
    """OL1 and OL3 together: a delay in the loop, but no lag."""
    tau, k_q, k_p, k_i, t_d = (
        Parameter(name, "-", 0.0, 10.0, 2.0, "of the set") for name in ("tau_n", "k_q", "K_p", "K_i", "t_d")
    )
    loop = PIGovernor(k_p, k_i) * Delay(t_d) * Shaft((tau,), k_q)
    return Structure(name="CL-DELAY", title="", input="n_set", outputs={"n": feedback(loop)})


def shipped_or_own(name):
    return governor_with_delay() if name == "CL-DELAY" else structure(name)


def halved(values):
    return values | {"zeta": values["zeta"] / 2.0}


ROWS = {
    "benchmark": Row(
        "BENCHMARK",
        {"tau_n": 0.275, "K_p": 0.01, "K_i": 10.0, "g": -0.314, "v": 1.0},
        (-4.225 + 4.302j,),
        gain_margin=np.inf,
        delay_margin=0.291,
        speed_peak=(1.00, np.nan),
        torque_peak=(2.12, 3.4),
    ),
    "CL1": Row(
        "CL1",
        {"tau_n": 0.278, "K_p": 0.01, "K_i": 5.99},
        (-3.615 + 2.912j,),
        gain_margin=np.inf,
        delay_margin=0.432,
        speed_peak=(1.00, np.nan),
        torque_peak=(2.00, np.nan),
    ),
    "CL2": Row(
        "CL1",
        {"tau_n": 0.6027, "K_p": 0.01, "K_i": 5.0534},
        (-1.667 + 2.367j,),
        gain_margin=np.inf,
        delay_margin=0.472,
        speed_peak=(1.06, 1.7),
        torque_peak=(2.47, 2.2),
    ),
    "CL3, zeta omega_n": Row("CL3", halved(CL3), (0.040 + 7.380j,), stable=False),
    "CL3": Row("CL3", CL3, (-1.136 + 6.758j,), True, 2.01, 0.374, (1.38, 6.5), (4.23, 6.6)),
    "CL4, zeta omega_n": Row("CL4", halved(CL4), (0.259 + 8.330j,), stable=False),
    "CL4": Row("CL4", CL4, (-0.815 + 7.507j,), True, 1.387, 0.393, (2.65, 7.4), (8.38, 7.5)),
    "OL1 and OL2": Row(
        "CL1",
        {"tau_n": 0.3897, "K_p": 1.003, "K_i": 4.2725},
        (-1.883, -5.823),
        gain_margin=np.inf,
        delay_margin=0.743,
        speed_peak=(1.00, np.nan),
        torque_peak=(2.00, np.nan),
    ),
    "OL1 and OL3": Row(
        "CL-DELAY",
        {"tau_n": 0.3897, "K_p": 3.4363, "K_i": 4.2639, "t_d": 0.4022},
        (0.437 + 5.355j,),
        stable=False,
        gain_margin=0.811,
        delay_margin=-0.127,
    ),
    "OL1 and OL4, zeta omega_n": Row("CL3", halved(OL14), (0.123 + 9.294j,), stable=False),
    "OL1 and OL4": Row("CL3", OL14, (-0.987, -1.463 + 8.384j), True, 2.145, 0.151, (1.58, 8.15), (5.97, 8.3)),
    "OL1 and OL5, zeta omega_n": Row("CL4", halved(OL15), (0.947 + 7.644j,), stable=False),
    "OL1 and OL5": Row("CL4", OL15, (-0.284 + 6.670j,), True, 1.139, 0.0323, (8.80, 6.7), (28.9, 6.7)),
    "start values of the benchmark": Row(
        "BENCHMARK",
        {"tau_n": 1.2, "K_p": 10.0, "K_i": 3.0, "g": -0.5, "v": 1.0},
        (-0.246, -10.17),
        gain_margin=np.inf,
        delay_margin=0.221,
        speed_peak=(1.00, np.nan),
    ),
}


def sweep(row):
    shipped = shipped_or_own(row.structure)
    omega = np.geomspace(0.01, 60.0, 60001)
    found = np.abs(shipped.response(shipped.vector(row.values), 1j * omega))
    best = np.argmax(found, axis=1)
    return [(found[i, at], omega[at]) for i, at in enumerate(best)]


@pytest.mark.parametrize("name", ROWS)
def test_dominant_roots_and_verdict(name):
    row = ROWS[name]
    shipped = shipped_or_own(row.structure)
    found = margins(shipped, shipped.vector(row.values))
    assert found.stable is row.stable
    assert found.unstable_poles == (0 if row.stable else 2)
    for expected in row.poles:
        nearest = found.poles[np.argmin(np.abs(found.poles - expected))]
        tolerance = 0.0051 if abs(expected) > 10.0 else 0.00051
        assert nearest.real == pytest.approx(np.real(expected), abs=tolerance)
        assert nearest.imag == pytest.approx(np.imag(expected), abs=tolerance)
    assert found.poles[0].real == pytest.approx(np.real(row.poles[0]), abs=0.00051)


@pytest.mark.parametrize("name", [name for name, row in ROWS.items() if not np.isnan(row.gain_margin)])
def test_gain_and_delay_margins(name):
    row = ROWS[name]
    shipped = shipped_or_own(row.structure)
    found = margins(shipped, shipped.vector(row.values))
    assert found.gain_margin == pytest.approx(row.gain_margin, abs=0.0055 if name == "CL3" else 0.00055)
    assert found.delay_margin_s == pytest.approx(
        row.delay_margin, abs=0.00005 if row.delay_margin == 0.0323 else 0.0005
    )


@pytest.mark.parametrize("name", [name for name, row in ROWS.items() if not np.isnan(row.speed_peak[0])])
def test_peaks_of_the_closed_loop(name):
    row = ROWS[name]
    for (height, at), (expected, where) in zip(sweep(row), (row.speed_peak, row.torque_peak), strict=True):
        if not np.isnan(expected):
            assert height == pytest.approx(expected, abs=0.051 if expected > 10.0 else 0.0051)
        if not np.isnan(where):
            assert at == pytest.approx(where, abs=0.051)


def test_thesis_structure_of_choice_is_one_sixth_short_of_instability():
    """OL1 with OL5: 11.5 degrees of phase margin, 32 ms of delay margin."""
    shipped = structure("CL4")
    found = margins(shipped, shipped.vector(OL15))
    assert np.degrees(found.phase_margin_rad) == pytest.approx(11.5, abs=0.05)
    assert found.delay_margin_s == pytest.approx(0.0323, abs=0.00005)


def test_levels_at_s10_and_s11_are_the_dip_and_the_peak_of_section_5_5():
    levels = {"CL4": (0.83, 1.05), "OL1 and OL4": (0.77, 0.89), "OL1 and OL5": (0.90, 1.64)}
    for name, expected in levels.items():
        shipped = structure(ROWS[name].structure)
        values = shipped.vector(ROWS[name].values)
        speed = np.abs(shipped.response(values, 2j * np.pi * np.array([0.3728, 0.7814]))[0])
        assert speed == pytest.approx(expected, abs=0.0051)


GAUGE = {"tau_up": 1.016, "tau_dn": 0.320, "k_q": 2.0, "g": 0.0, "K_p": 5.7, "K_i": 4.27, "omega_n": 10.3, "zeta": 0.47}


def test_gauge_aware_set_has_its_peak_between_the_lines_of_the_campaign():
    """Fitted set (``t_d`` 0.068 s): 1.17 at S11, but 1.88 at 7.4 rad/s; a gain margin of 1.61 alone forces 1.64."""
    shipped = structure("GAUGE-CLOSED")
    values = shipped.vector(GAUGE | {"t_d": 0.068, "t_sp": 0.0})
    found = margins(shipped, values)
    omega = np.geomspace(1.0, 30.0, 20001)
    speed, torque = np.abs(shipped.response(values, 1j * omega))
    assert speed.max() == pytest.approx(1.881, abs=0.001)
    assert omega[speed.argmax()] == pytest.approx(7.41, abs=0.01)
    assert torque.max() == pytest.approx(5.870, abs=0.002)
    assert found.gain_margin == pytest.approx(1.611, abs=0.001)
    assert speed.max() >= 1.0 / (found.gain_margin - 1.0)
    at_s11 = np.abs(shipped.response(values, [2j * np.pi * 0.7814]))[:, 0]
    assert at_s11 == pytest.approx([1.166, 2.965], abs=0.001)


def test_margins_of_the_simulator_reference():
    """``t_d`` 0.07 s: gain margin 1.60, phase margin 53.6 degrees, dominant pair -1.355 +/- 7.60j."""
    shipped = structure("GAUGE-CLOSED")
    found = margins(shipped, shipped.vector(GAUGE | {"t_d": 0.07, "t_sp": 0.0}))
    assert found.gain_margin == pytest.approx(1.60, abs=0.005)
    assert np.degrees(found.phase_margin_rad) == pytest.approx(53.6, abs=0.05)
    pair = found.poles[found.poles.imag > 1.0][0]
    assert pair == pytest.approx(-1.355 + 7.60j, abs=0.0011)
    assert found.poles[0] == pytest.approx(-0.633, abs=0.001)
