"""What a fit has simulated a moment ago is what it would simulate anew, and nothing else's."""

import gc
import weakref
from dataclasses import replace

import numpy as np
import pytest
from tests.limits.conftest import made_record

from shaftprint.arrays import frozen_float
from shaftprint.catalogue import limited_governor
from shaftprint.limits.prediction._prediction_error import PredictionError
from shaftprint.limits.prediction._recent_simulations import RecentSimulations

pytestmark = pytest.mark.slow
FREE = ("K_p", "t_d", "m_max")
VALUES = {"K_p": 5.7, "K_i": 4.27, "t_d": 0.07, "omega_n": 10.3, "zeta": 0.47, "t_sp": 0.05, "c_set": 1.0, "e_set": 0.0}
IDLE = {"m_max": 1.3, "m_min": -60.0, "T_aw": 0.5, "r_x": 1e5, "r_s": 1e5, "d_e": 1e-12, "a_0": 1.0, "g": 1e-12}
WHOLE = limited_governor("torque", "rate", "deadband", "ramp", "smoke")


@pytest.fixture
def record():
    """Twenty seconds of a set point that goes up and down, and of noise in the place of everything else."""
    rng = np.random.default_rng(5)
    made = made_record(
        250,
        lambda time: {
            **{name: 0.01 * rng.standard_normal(time.size) for name in ("n", "M_b", "c")},
            "n_set": np.where(np.sin(time) > 0.0, 0.1, 0.0),
        },
    )
    return replace(made, outputs={"y": frozen_float(0.1 * rng.standard_normal(250))})


def term_of(record):
    return PredictionError.of(WHOLE, record, {p.name: p.value for p in WHOLE.parameters} | VALUES | IDLE, FREE)


def values_at(**changed):
    known = {p.name: p.value for p in WHOLE.parameters} | VALUES | IDLE | changed
    return np.array([known[name] for name in WHOLE.names])


def test_a_second_question_has_the_answer_of_a_fresh_term(record):
    term = term_of(record)
    places = [values_at(), values_at(K_p=5.0), values_at(m_max=1.1), values_at()]
    for place in places:
        rows = term.rows(place)
        for own in (term, term.with_scale_at(place)):
            again, fresh = own.rows(place), term_of(record).with_scale_at(place).rows(place)
            np.testing.assert_allclose(again * own.scale, rows * term.scale, rtol=1e-12)
            np.testing.assert_allclose(again[0] * own.scale, fresh[0] * term_of(record).with_scale_at(place).scale)
        np.testing.assert_allclose(term.predicted(place), term_of(record).predicted(place), atol=1e-12)
    assert np.abs(term.predicted(places[0]) - term.predicted(places[1])).max() > 1e-3
    assert np.abs(term.predicted(places[0]) - term.predicted(places[2])).max() > 1e-3


def test_derivatives_come_by_name_and_another_record_is_another_question(record):
    term = term_of(record)
    term.rows(values_at())
    less = PredictionError.of(WHOLE, record, dict(zip(WHOLE.names, values_at(), strict=True)), ("m_max", "K_p"))
    shared = replace(less, recent=term.recent)
    np.testing.assert_allclose(shared.rows(values_at()), less.rows(values_at()), rtol=1e-9, atol=1e-12)
    louder = replace(record, drive={**record.drive, "n_set": frozen_float(2.0 * record.drive["n_set"])})
    moved = replace(term, record=louder).predicted(values_at())
    np.testing.assert_allclose(moved, term_of(louder).predicted(values_at()), atol=1e-12)
    assert np.abs(moved - term.predicted(values_at())).max() > 1e-3


def test_a_record_is_kept_no_longer_than_what_was_simulated_of_it(record):
    made = replace(record, outputs={"y": frozen_float(np.ones(250))})
    recent, torque = RecentSimulations(), weakref.ref(made.outputs["y"])
    coarse = recent.coarser(made)
    assert recent.coarser(made) is coarse
    assert 2 * coarse.every == made.every
    del made, coarse, recent
    gc.collect()
    assert torque() is None
