"""A tug with controllable pitch, from the raw recording of ``sail`` to FREE-PITCH by ``shaftprint identify``.

Two excitations, one after the other: the set point of the speed, then that of the pitch. Every number is held against
the truth that was put into the recording.
"""

import json

import numpy as np
import pytest
from click.testing import CliRunner
from tests.files_of_pitch import write_pitch_files
from tests.tug.linearised import linearised_response

from shaftprint.campaign import load_campaign
from shaftprint.catalogue import structure
from shaftprint.cli import shaftprint
from shaftprint.tug import Sailing, Tug, normalised_truth, sail
from shaftprint.vessel import load_vessel

RPM = -250.97 * (-6.66 - 0.04947603299199) - 83.467


@pytest.fixture(scope="module")
def tug():
    return Tug(engine_speed_rpm=RPM, sailing=Sailing(pitch_lag_s=1.3))


@pytest.mark.parametrize("lag_s", [0.4, 1.3])
def test_linearised_tug_is_free_pitch(tmp_path, lag_s):
    """The tie: the tug shares no physics with the structure; at the same truth both inputs show the same ship."""
    vessel = load_vessel(write_pitch_files(tmp_path)[0])
    tug = Tug(engine_speed_rpm=RPM, sailing=Sailing(pitch_lag_s=lag_s))
    model = structure("FREE-PITCH")
    truth = normalised_truth(tug, vessel) | {"c_set": 1.0}
    omega = np.geomspace(0.01, 10.0, 60)
    composed = model.response(model.vector({k: v for k, v in truth.items() if k in model.names}), 1j * omega)
    for place, name in enumerate(model.inputs):
        simulated = linearised_response(tug, vessel, omega / (2.0 * np.pi), outputs=("n", "M_s", "v_s"), input=name)
        assert simulated[:, 0] == pytest.approx(composed.reshape(3, 2, -1)[:, place], rel=2e-5)


@pytest.mark.long
def test_pitch_is_identified_from_the_raw_recording(tmp_path, tug):
    """The truth lies in every 95 % interval; what the pitch's sines show is sharp.

    ``a``, ``e``, ``tau_u`` and ``p`` share one direction that nothing shows, as without the pitch; their intervals are
    wide, those of the combinations are not.
    """
    vessel_path, campaign_path = write_pitch_files(tmp_path)
    recording, out = tmp_path / "pitch.nc", tmp_path / "out"
    truth = sail(load_vessel(vessel_path), load_campaign(campaign_path), recording, tug=tug, seed=4).normalised
    files = (recording, "--vessel", vessel_path, "--campaign", campaign_path, "-o", out)
    arguments = ["identify", *map(str, files), "--structure", "FREE-PITCH", "--no-progress"]
    done = CliRunner().invoke(shaftprint, arguments, catch_exceptions=False)
    assert done.exit_code == 0, done.output
    fingerprint = json.loads((out / "fingerprint.json").read_text())
    quantities = {q["name"]: q for q in (*fingerprint["parameters"], *fingerprint["combinations"])}
    known = truth | {
        "(e - a) / tau_u": (truth["e"] - truth["a"]) / truth["tau_u"],
        "b (2 - a) / tau_u": truth["b"] * (2.0 - truth["a"]) / truth["tau_u"],
        "(2 - a) / tau_u": (2.0 - truth["a"]) / truth["tau_u"],
        "p / tau_u": truth["p"] / truth["tau_u"],
        "t_d + t_sp": truth["t_d"] + truth["t_sp"],
        "K_p / K_i": truth["K_p"] / truth["K_i"],
        "c_set": 1.0,
        "t_gauge": 0.0,
    }
    assert set(quantities) <= set(known)
    for name, quantity in quantities.items():
        lower, upper = quantity["interval_95"]
        assert lower <= known[name] <= upper, name
    for name in ("q", "tau_th", "b", "p / tau_u", "(e - a) / tau_u"):
        assert quantities[name]["std"] < 0.03 * abs(known[name]), name
