"""Residuals of a record in time: white ones stay within their bounds, and what an input still says stands out."""

from types import SimpleNamespace

import numpy as np
import pytest

from shaftprint.report.figures._left import correlations, left_chart, outside

SAMPLES, RATE_HZ = 4000, 100.0


def part(whitened, *, inputs=None, used=None):
    rng = np.random.default_rng(8)
    record = SimpleNamespace(
        used=np.ones(SAMPLES, dtype=bool) if used is None else used,
        inputs=inputs or {"u": np.cumsum(rng.standard_normal(SAMPLES)), "still": np.full(SAMPLES, 2.0)},
        rate_hz=RATE_HZ,
        time_s=np.arange(SAMPLES) / RATE_HZ,
    )
    return SimpleNamespace(
        whitened=whitened, record=record, structure=SimpleNamespace(outputs={"n": None}), name="record"
    )


def test_white_residuals_stay_within_and_an_input_that_stands_still_is_left_out():
    white = part(np.random.default_rng(1).standard_normal((SAMPLES, 1)), inputs={
        "u": np.random.default_rng(2).standard_normal(SAMPLES), "still": np.full(SAMPLES, 2.0),
    })  # fmt: skip
    assert list(correlations(white)) == [("n", None), ("n", "u")]
    beyond, count = outside(white)
    assert count == 60 + 61
    # 121 draws of 0.05: 6 on average, and 14 in one of a thousand tests
    assert beyond <= 14


def test_residuals_of_first_order_have_its_autocorrelation():
    """Of ``e[k] = 0.5 e[k-1] + w[k]`` it is ``0.5^lag``, here in units of 1/sqrt(4000)."""
    rng, left = np.random.default_rng(3), np.zeros(SAMPLES)
    noise = rng.standard_normal(SAMPLES)
    for k in range(1, SAMPLES):
        left[k] = 0.5 * left[k - 1] + noise[k]
    told = correlations(part(left[:, None]))["n", None] / np.sqrt(SAMPLES)
    assert told[:3] == pytest.approx([0.5, 0.25, 0.125], abs=0.06)


def test_what_an_input_did_seven_samples_before_stands_at_its_lag():
    rng = np.random.default_rng(4)
    cause = rng.standard_normal(SAMPLES)
    left = 0.5 * np.roll(cause, 7) + rng.standard_normal(SAMPLES)
    told = correlations(part(left[:, None], inputs={"u": cause}))["n", "u"]
    assert np.argmax(told) == 7
    assert told[7] / np.sqrt(SAMPLES) == pytest.approx(0.5 / np.sqrt(1.25), abs=0.06)


def test_samples_that_were_not_used_count_as_nothing_and_keep_the_lags():
    rng, used = np.random.default_rng(5), np.ones(SAMPLES, dtype=bool)
    used[1000:1500] = False
    cause = rng.standard_normal(SAMPLES)
    left = np.roll(cause, 3)[used]
    one = part(left[:, None], inputs={"u": cause}, used=used)
    assert np.argmax(correlations(one)["n", "u"]) == 3
    panels = left_chart(one).panels
    assert len(panels) == 3
    assert panels[2].marks[1].x[3] == pytest.approx(0.03)
