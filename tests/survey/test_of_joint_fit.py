"""What the records of a joint fit add to its sines is worth less than their noise model says."""

from dataclasses import replace

import numpy as np
import pytest
from tests.drift.test_differ import PRIORS
from tests.known_fits import TRUTH, fitted, taken

from shaftprint.identify import Settings
from shaftprint.survey._everything import of_joint_fit


@pytest.fixture(scope="module")
def sines():
    return fitted("GAUGE-CLOSED", TRUTH, share=0.002, settings=Settings(starts=10, priors=PRIORS))


@pytest.mark.parametrize(
    ("times_better", "share"),
    [
        # nothing was added
        (1.0, 1.0),
        # 1 / sqrt(1 / 9 + 8 / 9 / 1.8^2) = 1.6106 of a third
        (3.0, 0.5369),
        # all of it comes from the records: 1.8 of a hundredth
        (100.0, 0.0180),
    ],
)
def test_deviations_of_records_are_1_8_times_those_of_their_noise_model(sines, times_better, share):
    joint = replace(sines, covariance=sines.covariance / times_better**2)
    found = of_joint_fit(taken(sines), sines, joint)
    names = [one.name for one in joint.parameters]
    added = np.diag(taken(sines).covariance_of(names)) - np.diag(sines.covariance)
    for name, working_point, before in zip(names, added, np.diag(sines.covariance), strict=True):
        assert found.quantity(name).std ** 2 - working_point == pytest.approx(share**2 * before, rel=5e-3), name
