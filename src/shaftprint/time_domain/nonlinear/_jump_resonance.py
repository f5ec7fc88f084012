"""Stretches in which a disturbance too small to see decides what a line does.

A loop whose rate is limited has two ways to follow a fast sine of some amplitudes and frequencies, one at either side
of a jump (jump resonance: Gelb and Vander Velde, Multiple-Input Describing Functions and Nonlinear System Design, 1968,
chapter 3). When a chirp goes through, noise decides in which of its periods the ship jumps. A simulation without
noise jumps at a second that its parameters decide. A fit that compares the two bends gains, delays and limits until
both are the same: on simulated recordings it gained 250 to 500 in log-likelihood over the true parameters within ten
seconds of ten minutes, and paid with errors of up to seven standard deviations.

Such a stretch is found without looking at what the ship did there: the model runs under its set point with noise like
that which is measured, several times, and where the runs part by more than elsewhere noise decides. Beyond a jump, on
its side of larger spread, derivatives of a simulation may be a hundred times those of what they are derivatives of: the
way of the model turns with its parameters as it does with noise. So that side is left out too, and the calmer one kept.
"""

from dataclasses import dataclass, replace

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray, frozen_bool, runs_of
from shaftprint.time_domain._noise_model import NoiseModel
from shaftprint.time_domain._output_error import OutputError
from shaftprint.time_domain._simulator import on_record

RUNS = 8
# Runs part where their spread is larger than its median over the record by this factor: 3.5 at steps, 20 at a jump.
APART = 5.0
# The jump of the ship may lie beyond those of the runs by this [s], and is over by then.
AROUND_S = 4.0
# A side that is shorter than this share of the record is not kept; where both are, all of the record is.
LEAST_SHARE = 0.25
# Samples after which a noise that begins with nothing is what it always is, in multiples of its memory.
BEGINNING = 10


@dataclass(frozen=True, kw_only=True, slots=True)
class JumpStretch:
    """A stretch that says nothing, because noise decides in it what the line does."""

    record: str
    """Name of the record."""
    begin_s: float
    """First sample of the stretch, in seconds of the recording."""
    end_s: float
    """Last sample of the stretch, in seconds of the recording."""


def without_jumps(term: OutputError, values: FloatArray, rng: np.random.Generator) -> OutputError:
    """Return a term that does not use the stretches in which noise decides what its model does.

    ``values``: all parameters of the structure, shape (parameters,).
    """
    record = term.record
    base = on_record(term.simulator, term.structure, values, record, ())
    runs = [] if base is None else [_run(term, values, rng) for _ in range(RUNS)]
    moves = np.array([run - base[0] for run in runs if run is not None and base is not None])
    if not moves.size:
        return term
    spread = np.sqrt(np.mean(moves**2, axis=0))
    apart = np.flatnonzero(np.any(spread > APART * np.median(spread[record.used], axis=0), axis=1))
    if not apart.size:
        return term
    sample, reach = np.arange(record.samples), round(AROUND_S * record.rate_hz)
    sides = [record.used & (sample < apart[0] - reach), record.used & (sample > apart[-1] + reach)]
    long = [side for side in sides if side.sum() >= LEAST_SHARE * record.used.sum()]
    if not long:
        return term
    used = min(long, key=lambda side: float(np.mean(spread[side] ** 2)))
    return replace(term, record=replace(record, used=frozen_bool(used)))


def jump_stretches(name: str, time_s: FloatArray, left_out: BoolArray) -> tuple[JumpStretch, ...]:
    """Return the stretches of a record that were left out, in order of time."""
    return tuple(
        JumpStretch(record=name, begin_s=float(time_s[begin]), end_s=float(time_s[end - 1]))
        for begin, end in runs_of(left_out)
    )


def _run(term: OutputError, values: FloatArray, rng: np.random.Generator) -> FloatArray | None:
    """Return a simulation with noise of the speed added to the set point, shape (samples, outputs)."""
    record = term.record
    noise = _drawn(term.whitening.noise, record.samples, rng)[:, list(term.structure.outputs).index("n")]
    fine = record.drive_time_s - record.margin / record.drive_rate_hz
    added = np.interp(fine, np.arange(record.samples) / record.rate_hz, noise)
    drive = {name: frozen + added for name, frozen in record.drive.items()}
    run = on_record(term.simulator, term.structure, values, replace(record, drive=drive), ())
    return None if run is None else run[0]


def _drawn(noise: NoiseModel, samples: int, rng: np.random.Generator) -> FloatArray:
    """Return noise of a colour, shape (samples, outputs)."""
    order, beginning = noise.order, BEGINNING * (noise.order + 1)
    drawn = rng.standard_normal((samples + beginning, noise.outputs)) @ np.linalg.cholesky(noise.covariance).T
    weights = noise.coefficients.swapaxes(0, 1).reshape(noise.outputs, -1)
    for sample in range(order, drawn.shape[0]):
        drawn[sample] += weights @ drawn[sample - order : sample][::-1].ravel()
    return drawn[beginning:]
