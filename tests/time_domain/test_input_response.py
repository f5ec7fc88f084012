"""Noise of short records: white stays white at the frequencies of the inputs, whatever the structure leaves there."""

import numpy as np
import pytest

from shaftprint.time_domain import record_from_arrays
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
