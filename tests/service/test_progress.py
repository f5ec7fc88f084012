"""What a fit has reached comes back as it was, or not at all."""

from types import SimpleNamespace

import numpy as np
import pytest

from shaftprint.service._model import FREE
from shaftprint.service._progress import Progress, Reached


@pytest.fixture
def kept(tmp_path):
    rng = np.random.default_rng(1)
    reached = Reached(
        theta=rng.standard_normal(len(FREE)),
        counts=rng.uniform(size=20) > 0.2,
        noise=SimpleNamespace(
            coefficients=rng.standard_normal((3, 2, 2)) / 7.0, covariance=np.array([[2.0, 0.3], [0.3, 1.0]])
        ),
        steps=2,
        size=1.0 / 3.0,
        is_last=False,
    )
    progress = Progress(path=tmp_path / "fit.json", key="this", free=len(FREE))
    progress.keep(reached)
    return progress, reached


def test_every_bit_comes_back(kept):
    progress, reached = kept
    back = progress.reached(20)
    assert np.array_equal(back.theta, reached.theta)
    assert np.array_equal(back.counts, reached.counts)
    assert np.array_equal(back.noise.coefficients, reached.noise.coefficients)
    assert (back.size, back.steps, back.is_last) == (reached.size, 2, False)


def test_other_segments_begin_anew(kept):
    progress, _ = kept
    assert progress.reached(21) is None
    assert Progress(path=progress.path, key="other", free=len(FREE)).reached(20) is None
    assert Progress(path=progress.path.with_name("none.json"), key="this", free=len(FREE)).reached(20) is None


@pytest.mark.parametrize("text", ["", "{", "[]", '{"key": "this"}', '{"key": "this", "theta": "x"}'])
def test_a_damaged_file_begins_anew(kept, text):
    progress, _ = kept
    progress.path.write_text(text)
    assert progress.reached(20) is None


def test_a_count_that_is_no_number_begins_anew(kept):
    progress, _ = kept
    text = progress.path.read_text(encoding="utf-8")
    assert '"steps": 2' in text
    progress.path.write_text(text.replace('"steps": 2', '"steps": Infinity'))
    assert progress.reached(20) is None
