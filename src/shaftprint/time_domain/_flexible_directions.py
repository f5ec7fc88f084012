"""What a structure may lack, as directions in which its residuals may lie, each of shape (samples, outputs)."""

import numpy as np
import scipy

from shaftprint.arrays import FloatArray
from shaftprint.time_domain._input_response import delayed_inputs
from shaftprint.time_domain._noise_model import NoiseModel
from shaftprint.time_domain._record import Record

# Lengths of the lags: so many, from two samples to this share of the record.
LAGS, LONGEST_SHARE = 4, 1.0 / 40.0
# Motion, over its standard deviation, at which its sign is complete.
SIGN_WIDTH = 0.05
# An output reverses where at least this share of its samples lies on either side of zero.
REVERSES = 0.02
# Lags of the inputs through the poles of the noise: a mode has two poles, straight lines between samples one more.
MODE_LAGS = 6
# Half turns of a number that moves slowly, within a record.
SLOW = 5
# One lag of the impulse response for so many samples.
SAMPLES_A_LAG = 10


def impulse_responses(record: Record, outputs: int) -> FloatArray:
    """Return finite impulse responses from the inputs, shape (directions, samples, outputs)."""
    most = max(int(record.used.sum()) // (SAMPLES_A_LAG * len(record.inputs)), 1)
    return _on_each(delayed_inputs(record, most=most), outputs)


def through_poles(record: Record, noise: NoiseModel) -> FloatArray:
    """Return the latest samples of the inputs as if they were innovations of a noise, and those of them in turn.

    A mode rings through poles of the noise for as long as these are right. What has passed them twice is the derivative
    of what has passed them once, so that a mode whose poles are known a little off is explained too.
    """
    recent = delayed_inputs(record, most=MODE_LAGS, longest_s=(MODE_LAGS - 1) / record.rate_hz)
    once = noise.driven(_on_each(recent, noise.outputs))
    return np.concatenate([once, noise.driven(once)])


def small_and_large(record: Record, simulated: FloatArray) -> FloatArray:
    """Return what large motions may do other than small ones, odd in the motion, shape (directions, samples, outputs).

    ``simulated``: outputs of the structure, shape (samples, outputs).
    """
    motion, size = _centred(simulated), simulated.std(axis=0)
    scaled = motion / np.where(size > 0.0, size, 1.0)
    rows = np.concatenate([np.clip(scaled / SIGN_WIDTH, -1.0, 1.0), scaled * np.abs(scaled)], axis=1)
    return _on_each(_lagged(record, rows.T), simulated.shape[1])


def up_and_down(record: Record, simulated: FloatArray) -> FloatArray:
    """Return what motions up may do other than motions down, even in the motion; see ``small_and_large``."""
    return _on_each(_lagged(record, np.abs(_centred(simulated)).T), simulated.shape[1])


def slow_course(record: Record) -> FloatArray:
    """Return courses of a number that moves slowly from the beginning of a record to its end, shape (courses, samples).

    Cosines of half a turn and more: of a random walk, of what warms up, softens or jumps once they hold nearly all.
    """
    share_over = (np.cumsum(record.used) - 0.5) / record.used.sum()
    return np.asarray(np.cos(np.pi * np.arange(1, SLOW + 1)[:, None] * share_over))


def _centred(simulated: FloatArray) -> FloatArray:
    """Return outputs about zero where they reverse, and about their mean where they do not."""
    up = np.mean(simulated > 0.0, axis=0)
    reverses = (up > REVERSES) & (up < 1.0 - REVERSES)
    return np.asarray(simulated - np.where(reverses, 0.0, simulated.mean(axis=0)))


def _lagged(record: Record, rows: FloatArray) -> FloatArray:
    """Return rows, shape (rows, samples), as they are and behind first-order lags."""
    rate = record.rate_hz
    lagged = [rows]
    for lag_s in np.geomspace(2.0 / rate, max(LONGEST_SHARE * record.samples, 4.0) / rate, LAGS):
        pole = np.exp(-1.0 / (rate * lag_s))
        driven = (1.0 - pole) * rows
        driven[:, 0] = rows[:, 0]
        # the recursion as a system of equations: the package of filters takes a second to load
        bands = np.array([np.ones(rows.shape[1]), np.full(rows.shape[1], -pole)])
        lagged.append(scipy.linalg.solve_banded((1, 0), bands, driven.T).T)
    return np.concatenate(lagged)


def _on_each(rows: FloatArray, outputs: int) -> FloatArray:
    """Return every row, shape (rows, samples), on every output alone: (rows outputs, samples, outputs)."""
    directions = np.zeros((outputs, *rows.shape, outputs))
    for output in range(outputs):
        directions[output, :, :, output] = rows
    return directions.reshape(-1, rows.shape[1], outputs)
