"""A pitch that its feedback shows late is told, and costs the delay of the pitch alone."""

import numpy as np
import pytest

from shaftprint.campaign import load_campaign
from shaftprint.recording import read_recording
from shaftprint.survey import run
from shaftprint.tug import like_stan_tug_1205, sail
from shaftprint.vessel import load_vessel

pytestmark = pytest.mark.slow

OF_FEEDBACK = {"t_th", "t_th + tau_th"}


def _with_latency(vessel, latency_s):
    pitch = vessel.sensors.pitch.model_copy(update={"latency_s": latency_s})
    return vessel.model_copy(update={"sensors": vessel.sensors.model_copy(update={"pitch": pitch})})


def _apart(fingerprint, name, true):
    one = fingerprint.quantity(name)
    return (one.value - true) / one.std


def test_a_pitch_that_is_logged_late_costs_its_delay_alone(tmp_path):
    vessel, campaign, path = load_vessel("nifs-research-vessel"), load_campaign("pitch"), tmp_path / "pitch.nc"
    late = _with_latency(vessel, vessel.sensors.pitch.latency_s + 0.02)
    truth = sail(late, campaign, path, seed=3, tug=like_stan_tug_1205(vessel))
    with read_recording(path) as recording:
        stated, unknown = (
            run(recording, one, campaign, judge=False, rng=np.random.default_rng(1)).fingerprint
            for one in (late, vessel)
        )
    assert stated.verdict.reasons == ()
    assert set(stated.verdict.trusted) >= OF_FEEDBACK
    assert abs(_apart(stated, "t_th", truth.normalised["t_th"])) < 3.0
    (reason,) = unknown.verdict.reasons
    assert reason.sentence.startswith("The pitch comes late: t_blade is -0.0")
    assert abs(_apart(unknown, "t_blade", -0.02)) < 3.0
    # wrong by nearly a seventh, and not trusted
    assert unknown.quantity("t_th").value == pytest.approx(truth.normalised["t_th"] + 0.02, abs=0.003)
    assert set(stated.verdict.trusted) - set(unknown.verdict.trusted) == OF_FEEDBACK
    assert "t_th and t_th + tau_th rest on the clocks of U_pitch and P_feedback" in " ".join(stated.verdict.assumptions)
