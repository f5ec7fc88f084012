"""Causes that a covariance contains and that move all outputs of a line together."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.errors import ResponseError
from shaftprint.spectra import FrequencyResponse, estimate_response, open_loop

FREQUENCY_HZ = np.array([0.1, 0.4, 1.0])


def response(**fields):
    values = np.array([[[0.9 - 0.2j, 0.5 - 0.6j, 0.1 - 0.3j]], [[2.0 + 0.5j, 2.5 - 0.4j, 1.0 - 1.0j]]])
    return FrequencyResponse(
        frequency_hz=FREQUENCY_HZ,
        response=values,
        covariance=np.tile(1e-4 * np.eye(4), (3, 1, 1)),
        inputs=("n_set",),
        outputs=("n", "M_s"),
        lines=("S1", "S2", "S3"),
        **{"common": {"set-point calibration": 0.01 * values}} | fields,
    )


def test_outputs_and_lines_take_their_parts():
    whole = response()
    part = whole.of_outputs("M_s").of_lines("S3", "S1")
    np.testing.assert_allclose(part.common["set-point calibration"], 0.01 * whole.response[1:, :, [0, 2]])


def test_a_smaller_weight_factor_makes_it_smaller_too():
    """Its square takes part in the factor of the covariance: 12 samples, two outputs or one, 12 / 10 and 12 / 11."""
    whole = response(degrees_of_freedom=np.full(3, 24.0))
    part = whole.of_outputs("n")
    np.testing.assert_allclose(
        part.common["set-point calibration"] / whole.common["set-point calibration"][:1], (10.0 / 11.0) ** 0.5
    )
    np.testing.assert_allclose(part.covariance[0, 0, 0] / whole.covariance[0, 0, 0], 10.0 / 11.0)


def test_a_scale_of_the_set_point_turns_the_open_loop():
    """A set point that is 1 % larger: ``n`` and ``M_s`` over it 1 % smaller; by differences of the conversion."""
    whole = response()
    governor, core = open_loop(whole)
    share = 1e-6
    moved = replace(whole, response=whole.response * (1.0 + share))
    for ours, theirs in zip((governor, core), open_loop(moved), strict=True):
        expected = 0.01 * (theirs.response - ours.response) / share
        np.testing.assert_allclose(ours.common["set-point calibration"], expected, rtol=1e-5, atol=1e-9)
    # the ratio of two outputs does not see the set point at all
    np.testing.assert_allclose(core.common["set-point calibration"], 0.0, atol=1e-12)


def test_shapes_are_checked():
    with pytest.raises(ResponseError, match=r"common error set-point calibration: expected shape \(2, 1, 3\)"):
        response(common={"set-point calibration": np.ones(3)})


def test_the_estimate_names_what_it_added(make_signals, make_campaign):
    """Covariance minus the common part is that of the same signals with a set point that is known exactly."""
    rng = np.random.default_rng(3)
    time_s = np.arange(0.0, 460.0, 0.05)
    wave = 0.12 * np.exp(2j * np.pi * 0.05 * time_s)
    set_point = wave.imag
    speed = (0.9 * np.exp(-0.2j) * wave).imag + 0.01 * rng.standard_normal(time_s.size)
    torque = (2.1 * np.exp(0.1j) * wave).imag + 0.03 * rng.standard_normal(time_s.size)
    signals = make_signals(set_point, torque, {"n_e": speed}, scale_std=0.002)
    campaign = make_campaign(("S1", 0.05, 20.0, 420.0))
    found = estimate_response(signals, campaign)
    certain = estimate_response(signals.with_channel("n_set", scale_std=0.0), campaign)
    common = found.common["set-point calibration"][:, 0]
    np.testing.assert_allclose(common, 0.002 * found.response[:, 0])
    direction = np.concatenate([common.real, common.imag]).T
    part = direction[:, :, None] * direction[:, None, :]
    np.testing.assert_allclose(found.covariance - part, certain.covariance, rtol=1e-6, atol=1e-12)
