"""Where noise decides what a line does, a fit shall not look."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.catalogue import limited
from shaftprint.time_domain import output_error, record_from_arrays
from shaftprint.time_domain._decimator import Decimator
from shaftprint.time_domain._noise_model import NoiseModel
from shaftprint.time_domain._simulator import ExactDelays
from shaftprint.time_domain._simulator import on_record as simulated_on
from shaftprint.time_domain._whitening import Whitening
from shaftprint.time_domain.nonlinear._jump_resonance import JumpStretch, jump_stretches, without_jumps

RATE = 20.0
NOISE = 0.01
TIME = np.arange(0.0, 120.0, 1.0 / RATE)
# 0.4 to 1 Hz in two minutes: the rate limit is reached at 0.6 Hz
PHASE = 2.0 * np.pi * (0.4 * TIME + 0.5 * (0.6 / 120.0) * TIME**2)
TRUE = {"K_p": 5.7, "K_i": 4.27, "t_d": 0.0703, "omega_n": 10.3, "zeta": 0.47, "tau_dn": 0.32, "tau_up": 1.016}
TRUE |= {"m_max": 2.87, "m_min": -0.65, "r_x": 3.83}


@pytest.fixture(scope="module")
def line():
    return limited("torque", "rate")


def chirp(line, amplitude):
    drive = amplitude * np.sin(PHASE)
    fine = np.interp(np.arange(TIME.size * 10 - 9) / (10 * RATE), TIME, drive)
    record = record_from_arrays("C1", {"n_set": drive}, {"n": drive, "M_s": drive}, rate_hz=RATE)
    # the drive is finer than the record, as that of a recording
    margin = replace_every(record, fine)
    run = simulated_on(ExactDelays(), line, line.vector(TRUE), margin, ())[0]
    return replace(margin, outputs={name: run[:, place] for place, name in enumerate(line.outputs)})


def replace_every(record, fine):
    half = Decimator(every=10).half
    return replace(record, drive={"n_set": np.pad(fine, half, mode="edge")}, every=10)


def term_of(line, record):
    white = NoiseModel(coefficients=np.zeros((0, 2, 2)), covariance=np.diag([NOISE**2, (3.0 * NOISE) ** 2]))
    return output_error(line, record).with_noise(Whitening(noise=white))


def test_what_lies_beyond_a_jump_is_left_out_and_the_rest_stays(line):
    record = chirp(line, 0.17)
    term = term_of(line, record)
    steady = without_jumps(term, line.vector(TRUE), np.random.default_rng(1))
    left_out = record.used & ~steady.record.used
    # one stretch, to the end
    assert left_out[-1]
    assert np.count_nonzero(np.diff(left_out)) == 1
    assert steady.record.used.sum() > 0.25 * record.used.sum()
    # an independent ship: slow noise on its set point moves its jump by whole periods, and only there
    rng = np.random.default_rng(7)
    apart = np.zeros((6, TIME.size))
    for number in range(6):
        slow = np.convolve(rng.standard_normal(TIME.size + 40), np.ones(40) / np.sqrt(40.0), "valid")[: TIME.size]
        fine = np.interp(np.arange(record.drive["n_set"].size) / (10 * RATE), TIME, NOISE * slow)
        ship = replace(record, drive={"n_set": record.drive["n_set"] + fine})
        run = simulated_on(ExactDelays(), line, line.vector(TRUE), ship, ())[0]
        apart[number] = np.abs(run[:, 0] - record.outputs["n"])
    inside = apart[:, left_out].max(axis=1)
    outside = apart[:, ~left_out].max(axis=1)
    assert np.median(inside) > 2.0 * np.median(outside)
    assert inside.max() > 0.1


def test_where_no_limit_acts_nothing_is_left_out(line):
    term = term_of(line, chirp(line, 0.02))
    assert without_jumps(term, line.vector(TRUE), np.random.default_rng(1)) is term


def test_stretches_are_named_in_time():
    left_out = np.array([False, True, True, False, True])
    found = jump_stretches("C1", 10.0 + np.arange(5.0), left_out)
    assert found == (
        JumpStretch(record="C1", begin_s=11.0, end_s=12.0),
        JumpStretch(record="C1", begin_s=14.0, end_s=14.0),
    )
