"""Two legs at two speeds, from the raw recording on, with nothing known beforehand."""

from dataclasses import replace

import numpy as np
import pytest
from tests.measured_truth import as_measured

from shaftprint.campaign import load_campaign
from shaftprint.catalogue import structure
from shaftprint.errors import StructureError
from shaftprint.identify import Settings
from shaftprint.recording import cut, read_recording, write_recording
from shaftprint.survey import STAN_TUG_NOISE, fit, leg_tests, load_trial, measure, priors_of, run
from shaftprint.survey._fits import comparisons_of
from shaftprint.survey._legs_apart import apart_reasons, legs_alone
from shaftprint.survey._limit_hints import hints_of
from shaftprint.survey._measurement import of_legs
from shaftprint.survey._survey import fingerprint_of
from shaftprint.tug import Noise, Tug, sail
from shaftprint.vessel import load_vessel

pytestmark = pytest.mark.slow

GAUGE = structure("GAUGE-CLOSED")
# What one speed does not tell at any length, and how well eleven minutes at two speeds must know it.
KNOWN = {"K_p": 0.03, "K_i": 0.05, "t_d": 0.13, "tau_up": 0.06, "tau_dn": 0.001, "k_q": 0.001}


@pytest.fixture(scope="module")
def trial():
    return load_trial(load_vessel("stan-tug-1205"), load_campaign("two-speeds"))


@pytest.fixture(scope="module")
def voyage(trial, tmp_path_factory):
    path = tmp_path_factory.mktemp("legs") / "legs.nc"
    return path, sail(trial.vessel, trial.campaign, path, seed=12)


def _fitted(measurement):
    (found,) = fit([GAUGE], measurement, settings={GAUGE.name: Settings()}, rng=np.random.default_rng(1))
    return found


def test_two_speeds_find_the_truth_with_nothing_known_beforehand(trial, voyage):
    path, truth = voyage
    assert max(truth.limited.values()) == 0.0
    measurement = measure(path, trial)
    found = _fitted(measurement)
    true = as_measured(truth, measurement.signals)
    distance = {one.name: (one.value - true[one.name]) / one.std for one in found.parameters}
    # twelve numbers: one beyond three deviations in 3 % of the recordings
    assert max(map(abs, distance.values())) < 3.0
    share = {one.name: one.std / one.value for one in found.parameters}
    assert [name for name, most in KNOWN.items() if share[name] > most] == []
    assert found.p_value > 0.01
    assert all(one.test.p_value > 0.01 for one in leg_tests(found, measurement.working_points))
    slow = measurement.legs[1].working_point
    # 0.70 of the working speed, and the torque with its square: 1725 N m at 1183.8 rpm
    assert slow.engine_speed_rev_s * 60.0 == pytest.approx(0.70 * 1183.8, rel=2e-3)
    assert slow.shaft_torque_nm == pytest.approx(1725.0 * (slow.engine_speed_rev_s * 60.0 / 1183.8) ** 2, rel=0.02)


def test_a_recording_that_ends_in_the_second_leg_still_gives_a_result(trial, voyage, tmp_path):
    path, truth = voyage
    short = tmp_path / "short.nc"
    with read_recording(path) as recording:
        write_recording(short, cut(recording, to_s=480.0).channels.values())
    measurement = measure(short, trial)
    # M2 is settled at 342 s: four periods of 32 s until 480 s
    assert measurement.legs[1].spectra.remarks["M2"] == "4 of 9 periods are in the recording"
    found = _fitted(measurement)
    true = as_measured(truth, measurement.signals)
    assert max(abs(one.value - true[one.name]) / one.std for one in found.parameters) < 3.5
    assert found.p_value > 0.01
    fingerprint = fingerprint_of(found, measurement, trial)
    first, second = fingerprint.legs
    assert (first.name, first.periods, first.load) == ("M1", 9, 1.0)
    assert (second.name, second.periods, second.period_s) == ("M2", 4, 32.0)
    assert second.engine_speed_rpm == pytest.approx(0.70 * 1183.8, rel=2e-3)
    # a line of either leg that drowns in noise is no good one: what the verdict knows of them
    lines = [line for leg in measurement.legs for line in leg.spectra.response.lines]
    assert list(fingerprint.quality.snr_local_db["M_s"]) == lines
    # the load of a propeller wanders by about a per cent
    assert second.load == pytest.approx(1.0, abs=0.02)
    assert [leg.p_value for leg in fingerprint.legs] == [
        one.test.p_value for one in leg_tests(found, measurement.working_points)
    ]
    # the noise of both speeds, from either number of periods, is of the size that is stored for this tug
    for levels in fingerprint.noise_at_speeds.values():
        ratio = (
            levels.of_outputs("M_s").density[:, 0, 0].real
            / STAN_TUG_NOISE.of_outputs("M_s").at(levels.frequency_hz)[:, 0, 0].real
        )
        assert 0.3 < np.median(ratio) < 3.0
    assert sorted(fingerprint.noise_at_speeds) == sorted(leg.engine_speed_rpm for leg in fingerprint.legs)


def test_a_generator_that_stops_in_the_second_leg_still_gives_a_result(trial, tmp_path):
    """The recorder goes on: what the set point does after the fourth of nine periods belongs to no period."""
    first, second = trial.campaign.multisines
    stopped = trial.campaign.model_copy(
        update={"multisines": (first, second.model_copy(update={"stop_s": second.settled_s + 4.6 * second.period_s}))}
    )
    path = tmp_path / "stopped.nc"
    truth = sail(trial.vessel, stopped, path, seed=21)
    measurement = measure(path, trial)
    assert measurement.legs[1].spectra.remarks["M2"] == "4 of 9 periods are in the recording"
    (told,) = [finding for finding in measurement.signals.findings if finding.startswith("M2: the set point repeats")]
    assert "in 4 of 9 periods alone" in told
    found = _fitted(measurement)
    true = as_measured(truth, measurement.signals)
    assert max(abs(one.value - true[one.name]) / one.std for one in found.parameters) < 3.5
    assert found.p_value > 0.01


@pytest.mark.parametrize(
    "changed", [{"proportional_gain": 1.1 * 5.7, "integral_gain_per_s": 1.1 * 4.27}, {"governor_delay_s": 1.1 * 0.0703}]
)
def test_a_governor_that_is_another_at_the_other_speed_is_refused(trial, voyage, tmp_path, changed):
    path, _ = voyage
    other = tmp_path / "other.nc"
    sail(trial.vessel, trial.campaign, other, tug=Tug(**changed), seed=13)
    first, second = measure(path, trial), measure(other, trial)
    # the upper leg of one ship and the lower leg of the other: gains or delay 10 % larger there
    mixed = replace(first, legs=(first.legs[0], second.legs[1]))
    settings = {GAUGE.name: Settings(priors=priors_of(GAUGE, trial.vessel, first.signals))}
    (found,) = fit([GAUGE], mixed, settings=settings, rng=np.random.default_rng(1))
    assert found.p_value < 1e-3
    alone = legs_alone(found, mixed, settings=settings, rng=np.random.default_rng(1))
    assert all(one.fit.p_value > 0.01 for one in alone)
    (reason,) = apart_reasons(found, alone)
    sentence = reason.sentence
    assert sentence.startswith("One model does not explain all legs: p = ")
    if "governor_delay_s" in changed:
        assert "What differs most: " in sentence
        assert "t_d" in sentence
    assert sentence.endswith("The result of one speed is had with --leg M1 or --leg M2.")


@pytest.mark.long
def test_the_verdict_on_scheduled_gains_begins_with_the_speeds_and_offers_one(trial, tmp_path):
    """Gains that go with the square root of the speed, 28 % between 1.15 and 0.70 of the working speed."""
    path = tmp_path / "scheduled.nc"
    truth = sail(trial.vessel, trial.campaign, path, tug=Tug(governor_gain_exponent=0.5), seed=22)
    survey = run(path, trial.vessel, trial.campaign, judge=False)
    verdict = survey.fingerprint.verdict
    assert not verdict.trustworthy
    # what the joint fit makes of the inertia comes after it
    assert verdict.reasons[0].kind == "legs apart"
    assert verdict.reason.startswith("One model does not explain all legs: p = ")
    assert "The result of one speed is had with --leg M1" in verdict.reason
    upper = run(path, trial.vessel, trial.campaign, judge=False, legs=("M1",))
    assert upper.fingerprint.verdict.trustworthy
    assert [reason.kind for reason in upper.fingerprint.verdict.reasons] == []
    # the gain of the governor is that of the speed of this leg
    (gain,) = (one for one in upper.identification.parameters if one.name == "K_p")
    share = upper.signals.working_point.engine_speed_rev_s * 60.0 / 1183.8
    true = as_measured(truth, upper.signals)["K_p"] * share**0.5
    assert abs(gain.value - true) < 3.5 * gain.std


def test_structures_are_compared_on_all_legs(trial, voyage):
    """A governor without the delay that the tug has is told apart, by criterion, nesting and lines left out."""
    measurement = measure(voyage[0], trial)
    without = replace(GAUGE.held_at(t_d=0.0), name="WITHOUT-DELAY")
    settings = {one.name: Settings(starts=20) for one in (GAUGE, without)}
    fits = fit([GAUGE, without], measurement, settings=settings, rng=np.random.default_rng(1))
    (comparison,) = comparisons_of(fits, rng=np.random.default_rng(1))
    assert comparison.best.name == GAUGE.name
    assert comparison.best.criteria.data == sum(
        2 * 2 * int(leg.spectra.response.used.sum()) for leg in measurement.legs
    )
    (ratio,) = comparison.ratios
    assert ratio.small == "WITHOUT-DELAY"
    assert ratio.p_value < 1e-3
    first, second = comparison.candidates
    assert first.hold_out.square == pytest.approx(first.hold_out.expected, rel=0.25)
    assert second.criteria.bic - first.criteria.bic > 10.0


def test_a_leg_that_meets_a_limit_is_named(trial, voyage, tmp_path):
    """The same ship, and one whose engine gives 800 N m at most: it meets that limit in the upper leg."""
    measurement = measure(voyage[0], trial)
    (hint,) = hints_of(measurement, trial, None)
    assert hint.startswith("No leg reaches a limit that the vessel file states; nearest comes M")
    engine = trial.vessel.engine
    weak = trial.vessel.model_copy(
        update={"engine": engine.model_copy(update={"full_load_torque_nm": (800.0,) * len(engine.full_load_torque_nm)})}
    )
    path = tmp_path / "weak.nc"
    truth = sail(weak, trial.campaign, path, seed=12)
    assert truth.limited["M1"] > 0.001
    weak_trial = replace(trial, vessel=weak)
    (hint,) = hints_of(measure(path, weak_trial), weak_trial, None)
    assert hint.startswith("Legs reach limits of the vessel file: M1 to full load at ")


def test_a_zero_of_the_gauge_is_found_and_spoils_nothing(trial, tmp_path):
    """75 N m, three deviations of what the vessel file states: 3.3 % of the torque of one leg, 8.9 % of the other."""
    path = tmp_path / "zero.nc"
    truth = sail(trial.vessel, trial.campaign, path, tug=Tug(torque_zero_offset_nm=75.0), seed=14)
    measurement = measure(path, trial)
    found = _fitted(measurement)
    point = measurement.signals.working_point
    true = as_measured(truth, measurement.signals) | {"k_q": 2.0 * (1.0 - 75.0 / point.shaft_torque_nm)}
    assert max(abs(one.value - true[one.name]) / one.std for one in found.parameters) < 3.5
    assert found.p_value > 0.01


def test_a_test_that_broke_off_behind_its_first_leg_gives_a_result(trial, tmp_path):
    """The slope of the set point's line is then told by slow lines, at which the speed lags already."""
    planned = load_campaign("12min")
    alone = planned.model_copy(update={"multisines": planned.multisines[:1], "staircases": ()})
    # a governor that is slower than that of the plan
    tug = Tug(proportional_gain=3.0, integral_gain_per_s=2.2)
    truth = sail(trial.vessel, alone, tmp_path / "one.nc", tug=tug, seed=22)
    survey = run(tmp_path / "one.nc", trial.vessel, alone, rng=np.random.default_rng(1))
    assert 0.01 < survey.signals.dc_scale_std < 0.03
    assert survey.fingerprint.verdict.trustworthy
    true = as_measured(truth, survey.signals)
    assert max(abs(one.value - true[one.name]) / one.std for one in survey.identification.parameters) < 3.5


def test_one_leg_can_be_chosen(trial, voyage):
    path, truth = voyage
    both = measure(path, trial)
    lower = of_legs(both, ["M2"])
    assert [leg.name for leg in lower.legs] == ["M2"]
    assert lower.signals.working_point == both.legs[1].working_point
    settings = {GAUGE.name: Settings(priors=priors_of(GAUGE, trial.vessel, lower.signals))}
    (found,) = fit([GAUGE], lower, settings=settings, rng=np.random.default_rng(1))
    true = as_measured(truth, lower.signals)
    assert found.value("tau_dn") == pytest.approx(true["tau_dn"], rel=3e-3)
    with pytest.raises(StructureError, match="leg M3: expected one of M1, M2"):
        of_legs(both, ["M3"])


def test_what_the_square_of_the_speed_does_to_the_loop_is_the_load_of_each_line(tmp_path):
    trial = load_trial("stan-tug-1205", "5min")
    silent = Tug(noise=Noise().without(process=True, measurement=True, faults=True))
    truth = sail(trial.vessel, trial.campaign, tmp_path / "silent.nc", seed=1, tug=silent)
    measurement = measure(tmp_path / "silent.nc", trial)
    response = measurement.legs[0].spectra.response
    true = as_measured(truth, measurement.signals)
    values = GAUGE.vector({name: value for name, value in true.items() if name in GAUGE.names})
    near = (response.frequency_hz > 0.9) & (response.frequency_hz < 1.5)
    linear = GAUGE.response(values, 1j * response.omega_rad_s)
    loaded = GAUGE.response(values, 1j * response.omega_rad_s, factors={"k_q": response.load})
    off, left = (np.abs(response.response[:, 0] / model - 1.0)[0, near] for model in (linear, loaded))
    assert off.max() > 0.01
    assert left.max() < 1e-3
