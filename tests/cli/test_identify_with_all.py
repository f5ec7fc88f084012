"""Sines, steps and limits in one fit: the short demo, whose governor its ten sines hardly know."""

import pytest

from shaftprint.fingerprint import read_fingerprint

TRIAL = ("--vessel", "stan-tug-1205", "--campaign", "short", "--no-progress")
# the reference truth of the simulated tug
TRUTH = {"K_p": 5.7, "K_i": 4.27, "t_d": 0.0703, "t_sp": 0.0518, "omega_n": 10.3, "zeta": 0.47, "T_aw": 0.5}


@pytest.mark.long
def test_one_fit_of_everything(invoke, recording, tmp_path):
    result = invoke("identify", recording, *TRIAL, "--with", "all", "-o", tmp_path / "result")
    assert result.exit_code == 0, result.output
    assert "The line with its limits: all of the test in one fit" in result.output
    fingerprint = read_fingerprint(tmp_path / "result" / "fingerprint.json")
    line = fingerprint.with_limits
    assert line.found_by == "joint fit"
    found = {quantity.name: quantity for quantity in line.parameters}
    for name, value in TRUTH.items():
        assert abs(found[name].value - value) < 3.0 * found[name].std, name
    for name in ("K_p", "t_d", "t_sp", "zeta"):
        # three times as well as the sines alone by the noise model, of which 1.8 are taken off again
        assert found[name].std < 0.6 * fingerprint.quantity(name).std
    assert found["K_p"].std < 0.05 * TRUTH["K_p"]
    assert fingerprint.validation.model == "GAUGE-TORQUE"


def test_with_all_is_refused_where_there_is_no_ship(run, recording, tmp_path):
    refused = run("identify", recording, *TRIAL, "--with", "all", "--mode", "thesis", "-o", tmp_path / "result")
    assert refused.exit_code == 2
    assert "--with all is for ships" in refused.output
    assert not (tmp_path / "result").exists()
