"""A load that moves and the noise that it carries are no error of the model."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.catalogue import limited
from shaftprint.errors import IdentificationError
from shaftprint.identify import Settings
from shaftprint.time_domain import identify_in_time, output_error, record_from_arrays
from shaftprint.time_domain._simulator import ExactDelays
from shaftprint.time_domain._simulator import on_record as simulated_on

RATE = 20.0
TIME = np.arange(0.0, 120.01, 1.0 / RATE)
# corners every 40 s: a load between them is one that the columns can follow
LOAD = np.interp(TIME, [0.0, 40.0, 80.0, 200.0], [0.985, 1.02, 1.0, 1.06])


@pytest.fixture(scope="module")
def line():
    return limited("torque")


@pytest.fixture(scope="module")
def record(line):
    """The line under a slow sine, exactly as the model has it."""
    drive = 0.15 * np.sin(2.0 * np.pi * 0.1 * TIME)
    empty = record_from_arrays("C1", {"n_set": drive}, {"n": drive, "M_s": drive}, rate_hz=RATE)
    run = simulated_on(ExactDelays(), line, line.vector({}), empty, ())[0]
    names = list(line.outputs)
    return replace(empty, outputs={name: run[:, place] for place, name in enumerate(names)})


def with_torque(record, added):
    return replace(record, outputs={**record.outputs, "M_s": record.outputs["M_s"] + added})


def cost(term, line):
    return 0.5 * float(np.sum(term.rows(line.vector({}))[0] ** 2))


def test_a_load_that_moves_is_found_and_leaves_nothing(line, record):
    moved = with_torque(record, (LOAD - 1.0) * (1.0 + record.outputs["n"]) ** 2)
    plain = output_error(line, moved)
    free = replace(plain, moving_load=True)
    assert cost(plain, line) > 1.0
    assert cost(free, line) < 1e-12 * cost(plain, line)
    # what is shown is torque, with its square and the load that was found
    shown = free.model(line.vector({}))
    assert shown[:, list(line.outputs).index("M_s")] == pytest.approx(moved.outputs["M_s"], abs=1e-8)
    assert np.allclose(free.residuals(line.vector({})), 0.0, atol=1e-8)


def test_noise_of_the_speed_is_as_large_in_torque_whatever_the_speed(line, record):
    """(1 + n + d)^2 - (1 + n)^2 = 2 (1 + n) d + d^2 in the torque; compared, 2 d is left at every speed."""
    # whole periods between two corners, so that no drift takes a part of it
    noise = 0.003 * np.cos(2.0 * np.pi * 0.45 * TIME)
    speed = record.outputs["n"]
    noisy = with_torque(record, (1.0 + speed + noise) ** 2 - (1.0 + speed) ** 2)
    noisy = replace(noisy, outputs={**noisy.outputs, "n": speed + noise})
    own = line.vector({})
    torque = list(line.outputs).index("M_s")
    plain = output_error(line, noisy)
    left = replace(plain, moving_load=True).residuals(own)[:, torque]
    # what is left of the other noise is 2 n d, whose root mean square is 0.15 times that of 2 d, over 2^0.5
    assert np.std(plain.residuals(own)[:, torque] - 2.0 * noise) == pytest.approx(0.15 * 0.006 / 2.0, rel=0.15)
    assert np.std(left - 2.0 * noise) < 0.3 * 0.15 * 0.006 / 2.0


def test_slopes_are_those_of_what_is_compared(line, record):
    term = replace(output_error(line, record), moving_load=True)
    own = line.vector({})
    rows = term.rows(own)
    place = [line.names[i] for i in term.free].index("K_p")
    whole = line.names.index("K_p")
    step = np.zeros(own.size)
    step[whole] = 1e-4
    difference = (term.rows(own + step)[0] - term.rows(own - step)[0]) / 2e-4
    assert rows[1 + place] == pytest.approx(difference, abs=1e-5 * np.abs(difference).max())


def test_a_short_record_has_one_load(line, record):
    short = record_from_arrays(
        "S1", {"n_set": record.inputs["n_set"][:1000]}, {k: v[:1000] for k, v in record.outputs.items()}, rate_hz=RATE
    )
    free, plain = (replace(output_error(line, short), moving_load=moves) for moves in (True, False))
    assert free.data_count == plain.data_count


def test_a_load_that_moves_and_a_slope_that_is_free_are_refused(line, record):
    """With both free, records of ``k_q = 2`` gave 2.43 +/- 0.12: the load takes what the torque tells of it."""
    moving = replace(output_error(line, record), moving_load=True)
    rng = np.random.default_rng(1)
    with pytest.raises(IdentificationError, match=r"record C1: a load that may move .* hold it with .*k_q"):
        identify_in_time([moving], rng=rng, start={})
    noisy = replace(record, outputs={k: v + 1e-3 * rng.standard_normal(v.size) for k, v in record.outputs.items()})
    names = [p.name for p in line.free if p.name not in ("k_q", "K_p")]
    known = line.held_at(**{p.name: p.value for p in line.free if p.name in names})
    held = replace(output_error(known.held_at(k_q=2.0), noisy), moving_load=True)
    other = output_error(known, replace(noisy, name="C2"))
    for terms in ([held], [replace(output_error(known, noisy), moving_load=True), other]):
        found = identify_in_time(terms, rng=rng, settings=Settings(starts=1), start={"K_p": 5.0, "k_q": 2.0})
        gain = next(p for p in found.parameters if p.name == "K_p")
        assert abs(gain.value - line.named(line.vector({}))["K_p"]) < 4.0 * gain.std
