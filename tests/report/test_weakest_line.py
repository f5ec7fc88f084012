"""The line that stands out of the noise least is looked for in the set point, the torque and the pick-up of the fit."""

from types import SimpleNamespace

import numpy as np

from shaftprint.report.sections._quality import _weakest


def test_the_pick_up_that_was_identified_counts_and_the_others_do_not():
    ratios = SimpleNamespace(
        lines=("S1", "S2", "S3"),
        channels=("n_set", "n_e", "n_s", "M_s"),
        local_db=np.array([[80.0, 30.0, 1.0, 20.0], [70.0, 2.4, 0.5, 10.6], [60.0, -9.0, 0.0, 4.0]]),
    )
    # the last line is not used
    response = SimpleNamespace(
        lines=("S1", "S2", "S3"), used=np.array([True, True, False]), inputs=("n_set",), outputs=("n", "M_s")
    )
    inputs = SimpleNamespace(spectra=SimpleNamespace(signal_to_noise=ratios, response=response, speed="n_e"))
    assert _weakest(inputs) == (
        "Of the lines that were used, S2 of n_e stands out of the noise least, by 2.4 dB; 1 of 6 ratios is below 3 dB."
    )
