"""Information line by line, against the covariance of a whole test and one line by hand."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.identify import Prior, planned_lines
from shaftprint.identify.prediction._accuracy import predict_joint_accuracy
from shaftprint.identify.prediction._line_information import line_information
from shaftprint.survey import STAN_TUG_NOISE

FREQUENCY = np.geomspace(0.02, 3.0, 14)


def test_lines_and_priors_add_up_to_the_inverse_of_the_covariance():
    """Each line with its own amplitude and length: its term for a unit of both, times length and squared amplitude."""
    gauge = structure("GAUGE-CLOSED")
    slow = gauge.scaled(**dict.fromkeys(("tau_dn", "tau_up", "K_p", "K_i", "g"), 1.4))
    amplitude = np.linspace(0.02, 0.2, FREQUENCY.size)
    fields = {"noise": STAN_TUG_NOISE}
    unit = planned_lines(FREQUENCY, amplitude=1.0, duration_s=1.0, **fields)
    real = planned_lines(FREQUENCY, amplitude=amplitude, duration_s=50.0, **fields)
    priors = {"t_sp": Prior(0.05, 0.003)}
    terms = line_information([(gauge, unit), (slow, unit)], priors=priors)
    total = terms.of_priors + sum(np.einsum("l,lfg->fg", 50.0 * amplitude**2, lines) for lines in terms.of_lines)
    covariance = predict_joint_accuracy([(gauge, real), (slow, real)], priors=priors).covariance
    assert np.linalg.inv(total) == pytest.approx(covariance, rel=1e-6, abs=1e-6 * covariance.max() * 1e-6)
    assert terms.names == tuple(p.name for p in gauge.free)
    both = terms.slopes["t_d + t_sp"]
    assert [terms.names[place] for place in np.flatnonzero(np.abs(both) > 1e-9)] == ["t_d", "t_sp"]


def test_one_line_of_the_core_by_hand():
    """``dH/dtau = -s / (tau s + 2)^2``; each part has the variance ``S`` for unit time and amplitude."""
    noise = STAN_TUG_NOISE.of_outputs("n")
    line = replace(planned_lines([0.5], noise=noise, amplitude=1.0, duration_s=1.0), inputs=("M_s",))
    s = 2j * np.pi * 0.5
    slope = np.abs(s / (0.3897 * s + 2.0) ** 2)
    information = line_information([(structure("OL1"), line)], values={"tau_n": 0.3897})
    assert information.of_lines[0][0, 0, 0] == pytest.approx(slope**2 / noise.at([0.5])[0, 0, 0].real, rel=1e-9)
    assert information.values["tau_n"] == 0.3897
