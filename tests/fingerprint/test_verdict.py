"""The verdict that a fingerprint keeps: that of its fit, in words, and the same again from its file."""

from dataclasses import replace
from datetime import UTC, datetime

import numpy as np

from shaftprint.catalogue import structure
from shaftprint.fingerprint import read_fingerprint, take_fingerprint, write_fingerprint
from shaftprint.identify import Settings, Unweighted, identify


def test_a_trustworthy_fit_says_which_numbers_may_be_used(fingerprint):
    """Noise-free responses known to 0.1 %: all is known but what the priors know of inertia and engine slope."""
    verdict = fingerprint.verdict
    assert verdict.trustworthy
    assert verdict.loop == "small"
    assert {"tau_dn", "k_q", "t_d + t_sp", "K_p / K_i"} <= set(verdict.trusted)
    assert verdict.sentences[0] == verdict.reason
    where = fingerprint.conditions
    every = (*fingerprint.parameters, *fingerprint.combinations, *fingerprint.physical, *fingerprint.margins)
    names = {quantity.name for quantity in (*every, where.engine_speed, where.shaft_torque)}
    assert set(verdict.trusted) | set(verdict.not_trusted) == names
    assert "I_dn" in verdict.trusted


def test_a_fit_that_fails_keeps_where_and_what_may_be_missing(fit, take, tmp_path):
    """The data of a loop whose speed comes 20 ms late, by a structure that does not know of it."""
    values = {"tau_n": 0.33, "K_p": 1.2, "K_i": 4.0, "t_d": 0.1, "omega_n": 10.0, "zeta": 0.6}
    exact = fit("CL4", values, share=0.005)
    late = exact.response.response.copy()
    late[0] *= np.exp(-0.02j * exact.response.omega_rad_s)
    data = replace(exact.response, response=late)
    failing = identify(structure("CL4"), data, rng=np.random.default_rng(7), settings=Settings(starts=20))
    kept = take(failing)
    assert not kept.verdict.trustworthy
    assert kept.verdict.trusted == ()
    assert kept.verdict.suspects[0].words == "the speed pick-up comes late"
    assert kept.verdict.sentences[1] == kept.verdict.suspects[0].sentence
    write_fingerprint(kept, tmp_path / "fingerprint.json")
    assert read_fingerprint(tmp_path / "fingerprint.json").verdict == kept.verdict


def test_an_unweighted_fit_has_a_verdict_too(fit, take):
    verdict = take(fit("OL1", {"tau_n": 0.39}, settings=Settings(weighting=Unweighted(), starts=5))).verdict
    assert verdict.trustworthy
    assert verdict.loop is None
    assert any("was not weighted" in caution for caution in verdict.cautions)


def test_lines_below_the_noise_of_the_recording_speak_against_the_fit(
    gauge_fit, signals, signal_to_noise, vessel, campaign
):
    poor = replace(signal_to_noise, local_db=np.full_like(signal_to_noise.local_db, -5.0))
    verdict = take_fingerprint(
        gauge_fit,
        signals=signals,
        signal_to_noise=poor,
        vessel=vessel,
        campaign=campaign,
        settings_files=(),
        now=datetime(2026, 3, 14, tzinfo=UTC),
    ).verdict
    assert not verdict.trustworthy
    assert verdict.reason.startswith("The data are too noisy")
