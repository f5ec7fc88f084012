"""The picture of the detector shows what was found, and nothing where there is nothing."""

import numpy as np
import pytest

from shaftprint.nonlinearity import HarmonicEvidence, LevelEvidence, LimitEvidence, Nonlinearities, StepEvidence
from shaftprint.report import plot_nonlinearities

NONE = np.empty(0)


def found(*, limited: bool, sines: bool) -> Nonlinearities:
    shape = (1, 2, 2)
    harmonics = HarmonicEvidence(
        lines=("S1",), frequency_hz=np.array([0.1]), fundamental=np.full((1, 2), 0.1), amplitude=np.full(shape, 0.008),
        expected=np.full(shape, 0.006), std=np.full(shape, 0.001), p_value=np.full(shape, 0.2),
    )  # fmt: skip
    time = np.arange(-1.0, 6.0, 0.1)
    curves = np.where(time > 0.0, 1.0, 0.0)[np.newaxis].repeat(2, axis=0)
    four = np.ones((2, 4))
    steps = StepEvidence(
        names=("St/1", "St/2"), rising=np.array([True, False]), size=np.array([0.2, -0.2]), measured=four,
        expected=four,
        std=four, up_minus_down=np.zeros(4), up_minus_down_std=np.ones(4), p_value=np.ones(4), time_s=time,
        speed=curves, torque=curves, expected_speed=curves, expected_torque=curves,
    )  # fmt: skip
    one = np.array([1.0]) if limited else NONE
    curve = np.array([-0.5, 0.5]) if limited else NONE
    limits = LimitEvidence(
        start_s=one, duration_s=one, speed=0.2 * one, torque=2.8 * one, torque_std=0.1 * one, limit=2.8 * one, rack=one,
        curve_speed=curve, curve_torque=5.6 * np.abs(curve), curve_std=0.05 * np.abs(curve),
        cloud_speed=np.linspace(-0.4, 0.4, 50), cloud_torque=np.linspace(0.4, 2.0, 50),
    )  # fmt: skip
    levels = LevelEvidence(
        tests=(), size=NONE, gain=NONE, gain_std=NONE, delay_s=NONE, delay_std_s=NONE, large_minus_small=np.nan,
        large_minus_small_std=np.nan, p_value=1.0,
    )  # fmt: skip
    return Nonlinearities(
        findings=(), sentence="", suspicions=(), false_alarm=1e-3, governor={}, governor_std={},
        harmonics=harmonics if sines else None, levels=levels, steps=steps, limits=limits,
    )  # fmt: skip


def labels(figure):
    return {text.get_text() for legend in figure.legends for text in legend.get_texts()}


@pytest.mark.parametrize("limited", [True, False])
def test_a_limit_is_shown_where_one_was_found(limited):
    shown = labels(plot_nonlinearities(found(limited=limited, sines=True)))
    assert ("limit found, 95 %" in shown) == limited
    assert ("stretches on a limit, 95 %" in shown) == limited
    assert {"steps up", "steps down", "harmonic 2, 95 %"} <= shown


def test_a_campaign_without_sines_says_so():
    figure = plot_nonlinearities(found(limited=False, sines=False))
    assert any("no sines" in text.get_text() for axes in figure.axes for text in axes.texts)
