"""The first torsional mode of the whole line, found from noisy records of speed and torque with two masses."""

import numpy as np
import pytest
from scipy.signal import chirp
from tests.torsion.traced_line import simulate_line

from shaftprint.catalogue import two_mass_line
from shaftprint.identify import Settings, identify
from shaftprint.spectra import response_from_arrays
from shaftprint.torsion import modes
from shaftprint.torsion._two_masses import two_masses

CYLINDERS = tuple(f"Cylinder {number}" for number in range(1, 7))
RATE_HZ, LENGTH_S = 250.0, 60.0
TIME_S = np.arange(round(LENGTH_S * RATE_HZ)) / RATE_HZ
# 0.2 rpm on the propeller shaft, 2 % of the working-point torque
SPEED_NOISE_RAD_S, TORQUE_NOISE_NM = 0.02, 40.0


def sweep(rng):
    """An engine torque of 200 N m at the propeller shaft, an eighth of the working point, from 2 to 24 Hz."""
    return 200.0 * chirp(TIME_S, 2.0, LENGTH_S, 24.0)


def impulses(rng):
    """Half-sines of 20 ms, about one a second."""
    starts = np.arange(0.5, LENGTH_S - 1.0) + 0.3 * rng.random(59)
    since = TIME_S - starts[np.searchsorted(starts, TIME_S, side="right").clip(1) - 1]
    return np.where((since >= 0.0) & (since < 0.02), 1500.0 * np.sin(np.pi * since / 0.02), 0.0)


@pytest.fixture(scope="module")
def expected(line):
    return two_masses(line, driven=["Flywheel"])


@pytest.fixture(scope="module")
def find(line, expected):
    """Fit two masses, started from a wrong stiffness, to noisy records of the line with all its bodies."""
    structure = two_mass_line(
        engine_kg_m2=expected.engine_kg_m2,
        propeller_kg_m2=expected.propeller_kg_m2,
        stiffness_nm_rad=1.6 * expected.stiffness_nm_rad,
        damping_nm_s_rad=expected.damping_nm_s_rad,
        load_nm_s_rad=expected.load_nm_s_rad,
    )

    def run(excite, seed):
        rng = np.random.default_rng(seed)
        torque = excite(rng)
        motion = simulate_line(
            line, TIME_S, dict.fromkeys(CYLINDERS, torque / 6.0), damping_at_hz=expected.frequency_hz
        )
        response = response_from_arrays(
            {"M_e": torque},
            {
                "w_e": motion.speed_of("Flywheel") + SPEED_NOISE_RAD_S * rng.standard_normal(TIME_S.size),
                "M_s": motion.gauge_torque_nm + TORQUE_NOISE_NM * rng.standard_normal(TIME_S.size),
            },
            RATE_HZ,
            band_hz=(2.0, 24.0),
        )
        found = identify(structure, response, rng=rng, settings=Settings(starts=20))
        return {item.name: item for item in (*found.parameters, *found.combinations)}

    return run


@pytest.mark.parametrize("excite", [sweep, impulses])
@pytest.mark.parametrize("seed", range(3))
def test_first_mode_within_one_percent(line, find, excite, seed):
    """The structure leaves out all bodies but two: that and the noise together stay within 1 %, mostly within 0.2 %."""
    true = modes(line)
    found = find(excite, seed)
    frequency, damping = found["f_1"], found["zeta_1"]
    assert frequency.value == pytest.approx(true.frequency_hz[0], rel=0.01)
    assert 0.0 < frequency.std < 0.003 * frequency.value
    assert damping.value == pytest.approx(true.damping_ratio[0], rel=0.05)
    assert 0.0 < damping.std < 0.05 * damping.value


@pytest.mark.slow
def test_stated_deviation_is_the_scatter_of_repeats(find):
    """Twelve sweeps that differ in their noise only: the scatter is known to a fifth."""
    found = [find(sweep, 100 + seed)["f_1"] for seed in range(12)]
    stated = np.mean([item.std for item in found])
    assert np.std([item.value for item in found], ddof=1) == pytest.approx(stated, rel=0.5)


def test_masses_are_those_that_swing_together(find, expected):
    """The gear swings with neither side: the masses found are a few percent from the sums of the table."""
    found = find(sweep, 0)
    assert found["J_e"].value == pytest.approx(expected.engine_kg_m2, rel=0.1)
    assert found["J_p"].value == pytest.approx(expected.propeller_kg_m2, rel=0.15)
    assert found["k"].value == pytest.approx(expected.stiffness_nm_rad, rel=0.1)
