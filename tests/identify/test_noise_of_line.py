"""The noise of one line as another line shows it, against a loop written by hand."""

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.identify import NoiseLevels
from shaftprint.identify.prediction._noise_of_line import noise_of_line
from shaftprint.survey import STAN_TUG_NOISE_AT_SPEEDS
from shaftprint.survey._shipped_noise import STAN_TUG_LINE
from shaftprint.tug import Tug, normalised_truth
from shaftprint.vessel import load_vessel

CLOSED = structure("GAUGE-CLOSED")
TUG = {CLOSED.named_as(role): value for role, value in STAN_TUG_LINE.items()}
OTHER = TUG | {"K_p": 4.0, "K_i": 3.0, "t_d": 0.09, "tau_dn": 0.8, "tau_up": 1.9, "g": -0.1}
HERTZ = np.array([0.02, 0.1, 0.5, 1.3, 2.0, 4.0])
# Densities of what disturbs the torque of the propeller and of the engine [1/Hz], and of the gauge alone.
OF_PROPELLER, OF_ENGINE, OF_GAUGE = 1e-4, 3e-4, 2e-6


def by_hand(line):
    """Noise of speed and shaft torque of a rigid line whose torques are disturbed.

    ``M_s = (tau_dn s + k_q) n + d_p`` and ``M_s = -(C exp(-s t_d) + tau_up s - g) n + d_e``.
    """
    s = 2j * np.pi * HERTZ
    lag = line["omega_n"] ** 2 / (s**2 + 2.0 * line["zeta"] * line["omega_n"] * s + line["omega_n"] ** 2)
    governor = (line["K_p"] + line["K_i"] / s) * lag * np.exp(-s * line["t_d"])
    load = line["tau_dn"] * s + line["k_q"]
    engine = -(governor + line["tau_up"] * s - line["g"])
    speed = np.stack([1.0 / (engine - load), -1.0 / (engine - load)])
    torque = load * speed + np.array([[1.0], [0.0]])
    both = np.stack([speed, torque])
    density = np.einsum("apf,p,bpf->fab", both, [OF_PROPELLER, OF_ENGINE], both.conj())
    density[:, 1, 1] += OF_GAUGE
    return NoiseLevels(frequency_hz=HERTZ, density=density, outputs=("n", "M_s"), set_point_per_v=0.2)


def test_what_disturbs_the_torques_goes_through_the_loop_of_the_other_line():
    moved = noise_of_line(by_hand(TUG), CLOSED, measured_at=TUG, values=OTHER)
    expected = by_hand(OTHER)
    assert np.abs(moved.density / expected.density - 1.0).max() < 1e-6
    assert moved.outputs == ("n", "M_s")


def test_the_same_line_has_the_same_noise():
    level = STAN_TUG_NOISE_AT_SPEEDS[1.0]
    same = noise_of_line(level, CLOSED, measured_at=TUG, values=TUG)
    assert np.abs(same.density - level.density).max() <= 1e-9 * np.abs(level.density).max()


def test_the_line_of_the_stored_noise_is_the_simulated_tug():
    truth = normalised_truth(Tug.stan_tug_1205(), load_vessel("stan-tug-1205"))
    assert {name: truth[name] for name in TUG} == pytest.approx(TUG, rel=1e-3)
