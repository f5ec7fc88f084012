"""Speeds of two pick-ups at made-up lines: their ratio, its deviation, and which lines and sensors count."""

from types import SimpleNamespace

import numpy as np
import pytest

from shaftprint.spectra._speed_ratios import speed_ratios


def pick_up(name, pulse_rate_hz=20.0, **changes):
    given = {"by_angle": True, "averaging_s": 0.0, "hold_s": 0.0, "gain": lambda _: 1.0} | changes
    return SimpleNamespace(name=name, pulse_rate_hz=pulse_rate_hz, **given)


def line(frequency_hz, amplitude=(0.02j, 0.03j), covariance=((4e-8, 1e-8), (1e-8, 9e-8))):
    return SimpleNamespace(
        window=SimpleNamespace(frequency_hz=frequency_hz),
        channels=("n_e", "n_s", "M_s"),
        places=lambda *names: [("n_e", "n_s").index(name) for name in names],
        amplitude=np.array(amplitude),
        noise=SimpleNamespace(covariance=np.array(covariance, dtype=complex)),
    )


def test_ratio_and_its_deviation_by_hand():
    (one,) = speed_ratios([line(2.0), line(0.5)], pick_up("n_e"), [pick_up("n_s", gain=lambda _: 0.75)])
    assert one.frequency_hz.tolist() == [0.5, 2.0]
    assert one.size == pytest.approx([2.0, 2.0])
    # relative variances 1e-4 and 1e-4, of which 2 * 1e-8 / (0.02 * 0.03) is shared; half of it is of the size
    assert one.std == pytest.approx(np.sqrt(0.5 * (1e-4 + 1e-4 - 2e-8 / 6e-4)))


def test_lines_above_a_fifth_of_the_slower_pulses_and_without_noise_are_left_out():
    dead = line(1.0, amplitude=(0.02, 0.0))
    same = line(1.0, amplitude=(0.02, 0.02), covariance=((4e-8, 4e-8), (4e-8, 4e-8)))
    none = line(1.0, covariance=((0.0, 0.0), (0.0, 0.0)))
    (one,) = speed_ratios([line(1.9), line(2.1), dead, same, none], pick_up("n_e"), [pick_up("n_s", 10.0)])
    assert one.frequency_hz.tolist() == [1.9]


@pytest.mark.parametrize("changes", [{"by_angle": False}, {"averaging_s": 0.1}, {"hold_s": 0.1}])
def test_what_smooths_is_not_compared(changes):
    assert speed_ratios([line(1.0)], pick_up("n_e"), [pick_up("n_s", **changes)]) == ()
    assert speed_ratios([line(1.0)], pick_up("n_e", **changes), [pick_up("n_s")]) == ()


def test_a_sensor_that_the_lines_do_not_show_is_not_compared():
    assert speed_ratios([line(1.0)], pick_up("n_e"), [pick_up("n_e"), pick_up("n_p")]) == ()
