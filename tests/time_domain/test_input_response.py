"""Noise of short records: white stays white at the frequencies of the inputs, whatever the structure leaves there."""

import subprocess
import sys

import numpy as np
import pytest

from shaftprint.time_domain import record_from_arrays
from shaftprint.time_domain._flexible_directions import LAGS, _lagged
from shaftprint.time_domain._input_response import noise_of
from shaftprint.time_domain._noise_model import estimate_noise

RATE_HZ, SAMPLES = 100.0, 400
TIME_S = np.arange(SAMPLES) / RATE_HZ
CHIRP = 4.0 * np.sin(2.0 * np.pi * (0.3 + 0.8 * TIME_S) * TIME_S)
INPUTS = {"step": np.where(TIME_S > 0.5, 6.0, 0.0), "chirp": CHIRP}


def found(inputs, residuals):
    """Return the power density of the noise that is found over that of white noise of unit size, at 0.1 to 45 Hz."""
    record = record_from_arrays("short", {"u": inputs}, {"y": residuals}, rate_hz=RATE_HZ)
    noise = estimate_noise(noise_of(residuals[:, None], record), record.stretches, max_order=40)
    return RATE_HZ * noise.spectrum(np.array([0.1, 1.0, 3.0, 20.0, 45.0]), RATE_HZ)[:, 0, 0].real


@pytest.mark.parametrize("kind", INPUTS)
def test_white_noise_is_white_where_the_inputs_are(kind):
    rng = np.random.default_rng(8)
    density = np.mean([found(INPUTS[kind], rng.standard_normal(SAMPLES)) for _ in range(12)], axis=0)
    assert density == pytest.approx(np.ones(5), abs=0.15)


@pytest.mark.parametrize("kind", INPUTS)
def test_what_a_structure_leaves_of_its_input_is_no_noise(kind):
    """A wrong gain, whose misfit is ten times the noise, neither raises the noise nor gives it a colour."""
    rng, moved = np.random.default_rng(9), INPUTS[kind] - INPUTS[kind].mean()
    left = 10.0 * moved / moved.std()
    density = np.mean([found(INPUTS[kind], left + rng.standard_normal(SAMPLES)) for _ in range(12)], axis=0)
    assert density == pytest.approx(np.ones(5), abs=0.35)


def test_rows_behind_a_lag_follow_its_recursion():
    """Ten samples a second; each lag begins as if its input had always been so."""
    rows = np.random.default_rng(3).standard_normal((2, 60))
    record = record_from_arrays("r", {"u": rows[0]}, {"y": rows[1]}, rate_hz=10.0)
    itself, *behind = np.split(_lagged(record, rows), 1 + LAGS)
    np.testing.assert_array_equal(itself, rows)
    # the quickest lag takes two samples
    pole, by_hand = np.exp(-0.5), rows.copy()
    for k in range(1, 60):
        by_hand[:, k] = pole * by_hand[:, k - 1] + (1.0 - pole) * rows[:, k]
    np.testing.assert_allclose(behind[0], by_hand, rtol=1e-12, atol=1e-14)


@pytest.mark.slow
def test_a_fit_of_a_drive_loads_neither_filters_nor_statistics_nor_minimisers():
    """Each of them takes as long to load as a fit of a short record."""
    script = (
        "import sys\n"
        "import numpy as np\n"
        "from shaftprint.bench import identify_drive\n"
        "from shaftprint.time_domain import record_from_arrays\n"
        "from shaftprint.time_domain._flexible_directions import small_and_large\n"
        "moves = np.sin(np.arange(400) / 9.0)\n"
        "record = record_from_arrays('r', {'u': moves}, {'y': moves}, rate_hz=10.0)\n"
        "print(small_and_large(record, moves[:, None]).shape[1:])\n"
        "print({'scipy.signal', 'scipy.stats', 'scipy.optimize', 'matplotlib', 'pandas'} & set(sys.modules))\n"
    )
    found = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert found.stdout == "(400, 1)\nset()\n"
