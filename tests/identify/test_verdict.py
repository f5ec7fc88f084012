"""The verdict on cases whose right answer is known: each branch of the rule once, and what is only a caution."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.identify import (
    Estimate,
    Prior,
    Requirements,
    Settings,
    Unweighted,
    assess,
    identify,
    identify_jointly,
    profile,
)
from shaftprint.models import Delay, Gain, Parameter, PIGovernor, Sensitivity, Shaft, Structure
from shaftprint.spectra import FrequencyResponse, SignalToNoise

LINES_HZ = np.geomspace(0.0044, 3.4, 24)
DENSE = {"frequency_hz": LINES_HZ, "names": tuple(f"S{i}" for i in range(1, 25))}
# thesis table 5.3, CL4: gain margin 1.60; and a governor of half the gain, whose gain margin is 5
LITTLE = {"tau_n": 0.329, "K_p": 1.6, "K_i": 4.4388, "t_d": 0.1161, "omega_n": 9.7705, "zeta": 0.5}
AMPLE = {**LITTLE, "K_p": 0.8, "K_i": 3.0, "zeta": 0.8, "t_d": 0.06}


def fitted(response, name="CL4", **settings):
    made_of = structure(name) if isinstance(name, str) else name
    return identify(made_of, response, rng=np.random.default_rng(1), settings=Settings(**settings))


@pytest.fixture
def draw(make_response):
    def drawn(values, name="CL4", noise=0.01, seed=7, **options):
        return make_response(name, values, noise=noise, rng=np.random.default_rng(seed), **{**DENSE, **options})

    return drawn


def test_a_good_fit_of_a_good_loop_is_trustworthy(draw):
    fit = fitted(draw(AMPLE))
    verdict = assess(fit, profile=profile(fit))
    assert verdict.trustworthy
    assert verdict.trusted == ("tau_n", "K_p", "K_i", "t_d", "omega_n", "zeta")
    assert (verdict.not_trusted, verdict.suspects, verdict.cautions, verdict.loop) == ({}, (), (), "ample")
    assert verdict.reason == verdict.sentences[0]
    assert verdict.reason.startswith(
        "The fit can be trusted: CL4 explains 24 good spectral lines within their noise (p = 0."
    )
    assert verdict.reason.endswith(", the optimum is the only one, and the loop is stable with ample margins.")
    assert verdict.sentences[1:] == ("Trusted: tau_n, K_p, K_i, t_d, omega_n and zeta.",)


def test_without_a_loop_nothing_is_said_of_margins(draw):
    verdict = assess(fitted(draw({"tau_n": 0.4}, "OL1"), "OL1"))
    assert verdict.trustworthy
    assert verdict.loop is None
    assert verdict.reason.endswith("(p = 0.79) and the optimum is the only one.")


# ---- data that are not good enough ----


def test_too_noisy_data_are_refused(draw):
    verdict = assess(fitted(draw(AMPLE, noise=0.5)))
    assert not verdict.trustworthy
    assert verdict.reason.startswith("The data are too noisy: of 24 lines none are known to better than 30 %")
    assert verdict.trusted == ()
    assert set(verdict.not_trusted) == {"tau_n", "K_p", "K_i", "t_d", "omega_n", "zeta"}
    assert set(verdict.not_trusted.values()) == {"the fit as a whole is not trustworthy"}
    patient = Requirements(largest_line_std=1.0)
    assert "too noisy" not in assess(fitted(draw(AMPLE, noise=0.5)), requirements=patient).reason


def test_too_few_lines_are_refused(draw):
    few = identify(structure("CL4"), draw(AMPLE), rng=np.random.default_rng(1), lines=["S20", "S21"])
    verdict = assess(few)
    assert verdict.reason == (
        "There are too few lines: 2 lines give 8 numbers, for 6 parameters that the data must find at least 12 are "
        "wanted; measure more lines."
    )
    known = {name: Prior(value, 0.1 * value) for name, value in AMPLE.items() if name in ("zeta", "omega_n", "t_d")}
    helped = identify(
        structure("CL4"),
        draw(AMPLE),
        rng=np.random.default_rng(1),
        lines=["S20", "S21"],
        settings=Settings(priors=known),
    )
    assert "too few lines" not in assess(helped).reason


def test_a_gap_where_the_loop_decides_is_refused(draw):
    """AMPLE crosses 1 at 1.6 rad/s, 0.25 Hz: between S14 and S18 nothing is measured."""
    response = draw(AMPLE)
    names = [name for name in response.lines if name not in {f"S{i}" for i in range(11, 18)}]
    fit = identify(structure("CL4"), response, rng=np.random.default_rng(1), lines=names)
    verdict = assess(fit)
    assert not verdict.trustworthy
    ratio = LINES_HZ[17] / LINES_HZ[9]
    assert f"a factor {ratio:.1f}, and there the loop decides on its stability" in verdict.reason
    low, high = 2 * np.pi * LINES_HZ[[9, 17]]
    assert f"no good line lies between {low:.2g} and {high:.2g} rad/s" in verdict.reason
    assert assess(fit, requirements=Requirements(largest_spacing=20.0)).trustworthy


def test_a_gap_elsewhere_does_not_matter(draw):
    response = draw(AMPLE)
    names = [name for name in response.lines if name not in {f"S{i}" for i in range(2, 9)}]
    assert assess(identify(structure("CL4"), response, rng=np.random.default_rng(1), lines=names)).trustworthy


def ratios(**poor_db):
    """Local signal-to-noise ratios of 40 dB, but for some channels at all lines."""
    channels = ("n_set", "n_e", "M_s")
    table = np.full((24, 3), 40.0)
    for channel, value in poor_db.items():
        table[:, channels.index(channel)] = value
    return SignalToNoise(lines=DENSE["names"], channels=channels, local_db=table, overall=np.ones(3))


@pytest.mark.parametrize(
    ("poor", "good"),
    [({}, True), ({"M_s": -3.0}, True), ({"n_set": -3.0}, False), ({"M_s": -3.0, "n_e": -1.0}, False)],
)
def test_lines_below_the_noise_of_the_recording_do_not_count(draw, poor, good):
    """Of the outputs one is enough; without the set point there is nothing."""
    fit = fitted(draw(AMPLE))
    assert assess(fit, signal_to_noise=ratios(**poor)).trustworthy is good
    few = replace(ratios(n_set=-3.0), lines=tuple(f"other {i}" for i in range(24)))
    assert assess(fit, signal_to_noise=few).trustworthy


# ---- the structure ----


def test_a_wrong_structure_is_refused_with_where_it_fails_and_a_hint(draw):
    late = draw(AMPLE)
    s = 2j * np.pi * late.frequency_hz
    data = late.response.copy()
    data[0, 0] *= np.exp(-0.03 * s)
    verdict = assess(fitted(replace(late, response=data)))
    assert not verdict.trustworthy
    assert verdict.reason.startswith("The structure CL4 does not explain the data within their noise (chi-square ")
    assert "p < 1e-12); the misfit is largest" in verdict.reason
    assert verdict.suspects[0].words == "the speed pick-up comes late"
    assert verdict.sentences[1].endswith(
        "% of the misfit would disappear if the speed pick-up comes late (by about 0.03 s)."
    )
    assert verdict.trusted == ()


def test_one_bad_line_is_enough_to_refuse(draw):
    response = draw(AMPLE)
    data = response.response.copy()
    data[1, 0, 4] *= 1.06
    verdict = assess(fitted(replace(response, response=data)))
    assert not verdict.trustworthy
    assert "the misfit is largest in M_s at S5 (0.088 rad/s)" in verdict.reason


def test_without_weights_fit_percent_decides(draw):
    right = assess(fitted(draw(AMPLE), weighting=Unweighted()))
    assert right.trustworthy
    assert "explains 24 good spectral lines within what the noise allows, the optimum" in right.reason
    assert right.cautions[-1].startswith("The fit was not weighted by the noise")
    wrong = assess(fitted(draw(AMPLE), "CL1", weighting=Unweighted()))
    assert not wrong.trustworthy
    assert wrong.reason.startswith("The structure CL1 does not explain the data: FitPercent of n 86")
    assert "where a perfect model has 9" in wrong.reason


# ---- the search ----


def test_two_optima_within_the_noise_are_refused():
    """A delay of 0.1 or 0.6 s: the line at 3 Hz that tells them apart is hardly known."""
    time, gain = Parameter("t", "s", 0.0, 0.95, 0.1, "test"), Parameter("k", "-", 0.1, 5.0, 1.0, "test")
    own = Structure(name="late", title="", input="u", outputs={"y": Gain(gain) * Delay(time)})
    frequency = np.array([2.0, 3.0])
    response = FrequencyResponse(
        frequency_hz=frequency,
        response=np.exp(-2j * np.pi * frequency * 0.1)[None, None],
        covariance=np.stack([np.eye(2) * s**2 for s in (0.05, 1.5)]),
        inputs=("u",),
        outputs=("y",),
    )
    verdict = assess(fitted(response, own), requirements=Requirements(data_per_parameter=1.0))
    assert not verdict.trustworthy
    assert verdict.reason.startswith("The result is not unique: another optimum, with t = 0.6 s instead of 0.1 s")


def delayed_loop():
    """OL1 and OL3 in one loop, without the lag of CL4."""
    fields = {"tau_n": (0.0, 5.0), "K_p": (0.0, 10.0), "K_i": (0.0, 10.0), "t_d": (0.0, 0.5)}
    tau, p, i, t = (Parameter(n, "-", *bounds, sum(bounds) / 2.0, "test") for n, bounds in fields.items())
    slope = Parameter("k_q", "-", 1.0, 3.0, 2.0, "test", held=True)
    core = Shaft((tau,), slope)
    torque = PIGovernor(p, i) * Delay(t) * Sensitivity(PIGovernor(p, i) * Delay(t) * core)
    return Structure(name="OL1+OL3", title="", input="n_set", outputs={"n": core * torque, "M_s": torque})


UNSTABLE = {"tau_n": 0.3897, "K_p": 3.4363, "K_i": 4.2639, "t_d": 0.4022}


def test_an_unstable_loop_is_refused(draw):
    fit = fitted(draw(UNSTABLE, delayed_loop()), delayed_loop(), stability="ignored")
    verdict = assess(fit)
    assert not verdict.trustworthy
    assert verdict.loop == "unstable"
    assert verdict.reason.startswith("The identified loop is unstable, with 2 poles in the right half plane")


def test_a_stable_fit_beside_a_better_unstable_one_is_refused(make_response):
    """Data of the unstable loop with so much stated noise that the stable fit is not rejected."""
    fit = fitted(make_response(delayed_loop(), UNSTABLE, noise=0.5, **DENSE), delayed_loop())
    assert fit.clusters[0].stable is False
    verdict = assess(fit, requirements=Requirements(largest_line_std=1.0))
    assert not verdict.trustworthy
    assert verdict.reason.startswith("The best model is unstable and was passed over")


# ---- margins ----


def test_a_small_margin_is_a_caution(draw):
    verdict = assess(fitted(draw(LITTLE)))
    assert verdict.trustworthy
    assert verdict.loop == "small"
    assert verdict.cautions == ("The stability margins are small: a gain margin of 1.60, where 2 is the least.",)
    assert verdict.reason.endswith("the loop is stable with small margins.")
    strict = Requirements(gain_margin=1.2, phase_margin_deg=80.0, delay_margin_share=5.0)
    caution = assess(fitted(draw(LITTLE)), requirements=strict).cautions[0]
    assert (
        "a phase margin of 71 deg, where 80 is the least and a delay margin of 0.4 s for a delay of 0.12 s" in caution
    )


def test_a_small_margin_that_is_not_to_be_used_is_no_finding(draw):
    """What is known to a fifth only is said as a range, and not as a number that is too small."""
    gain = Estimate(name="gain margin", unit="-", value=1.6, std=0.32, interval_95=(1.1, 2.3))
    verdict = assess(fitted(draw(LITTLE)), further=(gain,))
    assert verdict.trustworthy
    assert "gain margin" in verdict.not_trusted
    assert verdict.cautions == (
        "Whether the gain margin is small is not known well enough: the gain margin is between 1.1 and 2.3.",
    )
    assert verdict.reason.endswith("the loop is stable.")


def test_a_data_set_that_allows_an_unstable_loop_is_a_caution(draw):
    """Close to the limit of ``K_p``, which is 2.8, and known to a few percent only."""
    near = {**LITTLE, "K_p": 2.7}
    fit = fitted(draw(near, noise=0.2))
    assert fit.margins.stable
    verdict = assess(fit, profile=profile(fit), requirements=Requirements(largest_std=0.5))
    assert verdict.trustworthy
    assert any(s.startswith("The data allow unstable loops too") for s in verdict.cautions)


def test_margins_beyond_the_lines_are_extrapolated(draw):
    response = draw(AMPLE)
    slow = identify(structure("CL4"), response, rng=np.random.default_rng(1), lines=response.lines[:20])
    verdict = assess(slow, requirements=Requirements(largest_std=5.0))
    assert verdict.trustworthy
    told = next(s for s in verdict.cautions if s.startswith("The margins are extrapolated"))
    assert f"the good spectral lines reach from 0.028 to {2 * np.pi * LINES_HZ[19]:.2g} rad/s" in told


def test_lines_of_all_legs_are_asked_where_the_margins_lie(draw):
    """The slow lines of one leg leave the crossing to the fast ones of the other."""
    parts = [
        draw(AMPLE, seed=seed, frequency_hz=LINES_HZ[of], names=DENSE["names"][of])
        for seed, of in ((7, slice(0, 16)), (8, slice(14, 24)))
    ]
    pair = [(structure("CL4"), one) for one in parts]
    fit = identify_jointly(pair, rng=np.random.default_rng(1), settings=Settings(starts=15))
    verdict = assess(fit, requirements=Requirements(largest_std=5.0))
    assert verdict.trustworthy
    assert not any("extrapolated" in one for one in verdict.cautions)


# ---- the numbers ----


def test_numbers_that_the_data_cannot_tell_are_named_beside_those_that_they_can(draw):
    """Of the initial model ``v K_p`` and ``v K_i`` are found, not their factors (thesis eq. 2.34)."""
    values = {"tau_n": 0.4, "K_p": 3.0, "K_i": 4.0, "g": -0.3, "v": 1.0}
    fit = fitted(draw(values, "INITIAL"), "INITIAL")
    verdict = assess(fit, profile=profile(fit))
    assert verdict.trustworthy
    assert {"tau_n", "g", "K_p / K_i", "v K_p", "v K_i"} == set(verdict.trusted)
    assert set(verdict.not_trusted) == {"K_p", "K_i", "v"}
    assert verdict.sentences[2].startswith("Not trusted: K_p: it is known to ")


def test_a_fit_of_which_no_number_is_known_is_refused(draw):
    own = structure("OL2").held_at(K_i=4.0)
    response = draw({"K_p": 0.05, "K_i": 4.0}, own, noise=0.2)
    verdict = assess(fitted(response, own))
    assert not verdict.trustworthy
    assert verdict.reason.startswith("No number is known well enough: K_p: it ")
    assert set(verdict.not_trusted) == {"K_p"}


def test_a_fit_that_is_too_good_says_that_the_noise_is_overrated(draw, make_response):
    response = make_response("CL4", AMPLE, noise=0.01, **DENSE)
    verdict = assess(fitted(response))
    assert verdict.trustworthy
    assert any(s.startswith("The fit is better than the noise allows (p = 1)") for s in verdict.cautions)


def test_a_joint_fit_has_one_verdict(draw):
    one, two = (draw(AMPLE, seed=seed) for seed in (7, 8))
    pair = [(structure("CL4"), one), (structure("CL4"), two)]
    fit = identify_jointly(pair, rng=np.random.default_rng(1), settings=Settings(starts=15))
    verdict = assess(fit)
    assert verdict.trustworthy
    assert "CL4 explains 48 good spectral lines" in verdict.reason
