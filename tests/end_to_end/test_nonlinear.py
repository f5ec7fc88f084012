"""The simulated tug with limits: what a linear model cannot do, and the levels and rates that a limited one finds."""

from dataclasses import dataclass

import numpy as np
import pytest

from shaftprint.campaign import Campaign
from shaftprint.catalogue import structure
from shaftprint.identify import Settings, identify, priors_from_vessel
from shaftprint.recording import read_recording
from shaftprint.signals import Signals, prepare_signals
from shaftprint.spectra import estimate_response
from shaftprint.time_domain import NonlinearSettings, identify_nonlinear, structure_for
from shaftprint.time_domain._record_fit import RecordFit
from shaftprint.time_domain.nonlinear._fit import NonlinearFit
from shaftprint.tug import Noise, Truth, Tug, sail
from shaftprint.validation import validate
from shaftprint.vessel import Vessel

pytestmark = pytest.mark.slow


# frequency [Hz], amplitude [V], periods: large where the limits allow it, long where they do not
LINES = (
    (0.03, 0.6, 2),
    (0.06, 0.6, 4),
    (0.15, 0.6, 8),
    (0.3, 0.6, 16),
    (0.5, 0.6, 30),
    (0.8, 0.3, 60),
    (1.25, 0.08, 100),
    (2.0, 0.14, 150),
    (3.3, 0.11, 250),
)
LEVELS_V = (-5.0, -3.0, -5.0, -7.0, -5.0, -4.0, -6.0, -4.0)
# what a test can afford: one fine round of few steps from the best of a handful of starts
QUICK = NonlinearSettings(starts=6, first_iterations=3, better=2, kept=1, rounds=1, max_iterations=8, drive_hz=200.0)


def limits_campaign(dwell_s=16.0, staircases=4):
    time_s, stairs, sines = 15.0, [], []
    for number in range(1, staircases + 1):
        stairs.append({"name": f"St{number}", "levels_v": LEVELS_V, "dwell_s": dwell_s, "start_s": time_s})
        time_s += dwell_s * len(LEVELS_V) + 20.0
    for number, (frequency, amplitude, periods) in enumerate(LINES, start=1):
        stop_s = round(time_s + 10.0 + periods / frequency + 0.05, 2)
        times = {"start_s": time_s, "settled_s": time_s + 10.0, "stop_s": stop_s}
        sines.append({"name": f"S{number}", "frequency_hz": frequency, "amplitude_v": amplitude, **times})
        time_s = float(np.ceil(stop_s)) + 3.0
    return Campaign.model_validate(
        {"name": "limits", "duration_s": time_s + 5.0, "offset_v": -5.0, "sample_rate_hz": 2000.0,
         "sines": sines, "staircases": stairs}
    )  # fmt: skip


def with_wide_gauge(vessel):
    """At the torque limit the orders of the engine reach the end of the telemetry's range."""
    gauge = vessel.sensors.shaft_torque
    wide = {"full_scale_nm": 2.0 * gauge.full_scale_nm, "scale_nm_per_unit": 2.0 * gauge.scale_nm_per_unit}
    sensors = vessel.sensors.model_copy(update={"shaft_torque": gauge.model_copy(update=wide)})
    return vessel.model_copy(update={"sensors": sensors})


@dataclass(frozen=True, kw_only=True)
class Sailed:
    vessel: Vessel
    campaign: Campaign
    signals: Signals
    truth: Truth

    def fit(self, *limits: str) -> NonlinearFit:
        model = structure_for(limits, self.vessel, self.signals.working_point)
        rng = np.random.default_rng(1)
        return identify_nonlinear(self.signals, self.campaign, self.vessel, model, rng=rng, settings=QUICK)


@pytest.fixture(scope="module")
def sailed(vessel, tmp_path_factory):
    def go(name, seed, campaign, **truth):
        ship = with_wide_gauge(vessel)
        path = tmp_path_factory.mktemp(name) / "limits.nc"
        true = sail(ship, campaign, path, tug=Tug(**truth), seed=seed)
        with read_recording(path) as recording:
            signals = prepare_signals(recording, ship, campaign)
        return Sailed(vessel=ship, campaign=campaign, signals=signals, truth=true)

    return go


@pytest.fixture(scope="module")
def limited_trip(sailed):
    return sailed("rate", 1, limits_campaign(), rack_rate_limit_per_s=1.5)


@pytest.fixture(scope="module")
def limited_fit(limited_trip):
    return limited_trip.fit("torque", "rate")


def number(fit, name):
    return next(one for one in fit.limits if one.name == name)


def test_the_linear_model_fails_on_steps_of_2_v_and_says_so(limited_trip):
    gauge = structure("GAUGE-CLOSED")
    trip = limited_trip
    settings = Settings(priors=priors_from_vessel(gauge, trip.vessel, trip.signals.working_point))
    response = estimate_response(trip.signals, trip.campaign)
    linear = identify(gauge, response, rng=np.random.default_rng(1), settings=settings)
    found = validate(linear, trip.signals, trip.campaign, rng=np.random.default_rng(1))
    assert found.outcome == "fails"
    assert any("linear validation fails" in sentence for sentence in found.sentences)


@pytest.mark.long
def test_level_within_3_percent_and_rate_within_5(limited_trip, limited_fit):
    level = number(limited_fit, "share")
    # the engine has the full-load curve of its vessel file, the rack 1.5 of its travel a second
    assert level.value == pytest.approx(1.0, rel=0.03)
    rate = number(limited_fit, "r_x")
    assert rate.value == pytest.approx(1.5 / limited_trip.truth.normalised["X_0"], rel=0.05)


def test_intervals_hold_the_truth(limited_trip, limited_fit):
    true = limited_trip.truth.normalised
    limits = {"share": 1.0, "r_x": 1.5 / true["X_0"], "T_aw": 0.5, "M_min": -300.0}
    for name, value in limits.items():
        found = number(limited_fit, name)
        assert abs(found.value - value) < 3.0 * found.std, name
        assert 0.0 < found.std < 0.15 * abs(value), name
    for estimate in limited_fit.identification.parameters:
        if estimate.name in ("K_p", "K_i", "t_d", "omega_n", "zeta", "tau_up", "g", "t_sp"):
            assert abs(estimate.value - true[estimate.name]) < 3.0 * estimate.std, estimate.name


def test_speed_on_the_staircase_is_explained_as_well_as_noise_allows(limited_fit):
    parts = [part for part in limited_fit.identification.parts if isinstance(part, RecordFit)]
    assert [part.record.name for part in parts] == ["St1", "St2", "St3", "St4"]
    for part in parts:
        assert part.fit_percent["n"] > 0.97 * part.fit_ceiling["n"]
        assert part.fit_ceiling["n"] > 90.0


def test_what_was_fitted_and_how_is_said(limited_fit):
    assert limited_fit.lines == tuple(f"S{number}" for number in range(1, 10))
    assert limited_fit.records == ("St1", "St2", "St3", "St4")
    assert limited_fit.starts == 6
    assert 1 <= limited_fit.reached[0] <= limited_fit.reached[1] <= 2


@pytest.mark.long
def test_a_deadband_is_found_and_its_sines_are_records(sailed):
    """Noisy sensors, but calm water: disturbances carry the error out of the band, see docs/nonlinear.md."""
    calm = Noise().without(process=True)
    trip = sailed("deadband", 2, limits_campaign(40.0, 1), governor_deadband_rpm=8.0, noise=calm)
    fit = trip.fit("torque", "deadband")
    band = number(fit, "d_e_rpm")
    assert band.value == pytest.approx(8.0, rel=0.05)
    # no sine is small beside a deadband
    assert fit.lines == ()
    assert {"S1", "S9", "St1"} <= set(fit.records)
