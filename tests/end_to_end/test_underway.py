"""A dither test underway, from the raw recording on: what shaft and log show of the ship.

Truth and names are those of a Stan Tug at 1600 rpm and 9.2 knots; the noise is that of the quay, recirculating water
included, and the dither 2 % of the speed.
"""

import numpy as np
import pytest
from tests.measured_outputs import measured

from shaftprint.campaign import load_campaign
from shaftprint.catalogue import KnownPropeller, structure, with_known_propeller
from shaftprint.identify import identifiability, identify
from shaftprint.propeller import ka4_70_in_19a
from shaftprint.recording import read_recording
from shaftprint.signals import prepare_signals
from shaftprint.spectra import estimate_spectra, plant_from_closed_loop
from shaftprint.tug import Sailing, Tug, sail
from shaftprint.vessel import Vessel, load_vessel

LOG = {"channel": "v_s", "unit": "m/s", "cycle_s": 0.2, "resolution": 0.005, "latency_s": 0.3}
# the line of the set point at the offset of the campaign
RPM = -250.97 * (-6.66 - 0.04947603299199) - 83.467


def logged(vessel, **changes):
    content = vessel.model_dump()
    content["sensors"]["ship_speed"] = LOG | changes
    return Vessel.model_validate(content)


@pytest.fixture(scope="module")
def trip(tmp_path_factory):
    """Spectra and working point of one test underway, with its truth."""
    vessel, campaign = logged(load_vessel("stan-tug-1205")), load_campaign("transit")
    path = tmp_path_factory.mktemp("underway") / "underway.nc"
    truth = sail(vessel, campaign, path, tug=Tug(engine_speed_rpm=RPM, sailing=Sailing()), seed=1)
    with read_recording(path) as recording:
        signals = prepare_signals(recording, vessel, campaign)
    return signals, estimate_spectra(signals, campaign), truth.normalised


@pytest.fixture(scope="module")
def core(trip):
    return plant_from_closed_loop(trip[1].response, input="M_s", output=("n", "v_s"))


@pytest.fixture(scope="module")
def propeller(trip):
    signals, _, _ = trip
    return KnownPropeller(
        curve=ka4_70_in_19a(),
        pitch_ratio=1.11,
        diameter_m=1.05,
        propellers=2,
        water_density_kg_m3=1025.0,
        shaft_speed_rev_s=signals.working_point.engine_speed_rev_s / 3.82,
        ship_speed_m_s=signals.channels["v_s"].reference,
    )


def fitted(model, response):
    fit = identify(model.held_at(t_gauge=0.0), response, rng=np.random.default_rng(1))
    assert fit.fit_test.p_value > 0.01
    found = {c.name: (c.value, c.std) for c in fit.combinations}
    free = [p.name for p in fit.structure.parameters if not p.held]
    return found | {
        name: (fit.value(name), std) for name, std in zip(free, np.sqrt(np.diag(fit.covariance)), strict=True)
    }


def expect(found, truth, names, share):
    for name in names:
        value, std = found[name]
        assert value == pytest.approx(truth[name], rel=share), name
        assert abs(value - truth[name]) < 3.0 * std, name
        assert std < share * abs(truth[name]), name


def with_combinations(truth):
    a, b, e, tau_u = (truth[name] for name in ("a", "b", "e", "tau_u"))
    return truth | {
        "(e - a) / tau_u": (e - a) / tau_u,
        "b (2 - a) / tau_u": b * (2.0 - a) / tau_u,
        "(2 - a) / tau_u": (2.0 - a) / tau_u,
    }


@pytest.mark.slow
def test_working_point_is_that_of_the_ship(trip):
    signals, _, truth = trip
    assert signals.channels["v_s"].reference == pytest.approx(truth["v_0"], rel=2e-3)
    assert signals.channels["v_s"].reference_std < 0.01
    assert signals.working_point.engine_speed_rev_s == pytest.approx(RPM / 60.0, rel=1e-3)


@pytest.mark.slow
def test_shaft_and_log_give_the_combinations(trip, core):
    """Four numbers are all there is; each within 5 %."""
    names = ("tau_dn", "b", "(e - a) / tau_u", "b (2 - a) / tau_u", "(2 - a) / tau_u")
    expect(fitted(structure("FREE-SHIP"), core), with_combinations(trip[2]), names, 0.05)


@pytest.mark.slow
def test_propeller_and_mass_give_wake_resistance_and_thrust_deduction(trip, core, propeller):
    known = with_known_propeller(structure("FREE-SHIP"), propeller, mass_kg=57240.0)
    found = fitted(known, core)
    expect(found, with_combinations(trip[2]), ("tau_dn", "w", "e", "R", "a", "b", "tau_u"), 0.05)
    deduction, std = found["t"]
    assert abs(deduction - 0.15) < 3.0 * std
    # 2.4 % of the pull of the propellers, (1 - t) T
    assert std < 0.025


@pytest.mark.slow
def test_known_resistance_gives_the_thrust_deduction_sharply(trip, core, propeller):
    truth = trip[2]
    known = with_known_propeller(structure("FREE-SHIP"), propeller, mass_kg=57240.0, resistance_n=truth["R"])
    found = fitted(known, core)
    expect(found, truth, ("w", "e", "t"), 0.05)


@pytest.mark.slow
def test_shaft_alone_gives_the_wake_and_little_of_the_ship(trip, core, propeller):
    truth = with_combinations(trip[2])
    found = fitted(with_known_propeller(structure("FREE-CORE"), propeller, mass_kg=57240.0), core.of_outputs("n"))
    expect(found, truth, ("tau_dn", "w", "a", "b"), 0.05)
    for name in ("R", "e", "(e - a) / tau_u", "b (2 - a) / tau_u"):
        value, std = found[name]
        assert abs(value - truth[name]) < 3.0 * std
        assert std > 0.05 * abs(truth[name]), name


def test_what_can_be_found_at_all(propeller):
    rng = np.random.default_rng(1)
    plain = {name: structure(name).held_at(t_gauge=0.0) for name in ("FREE-CORE", "FREE-SHIP")}
    core = identifiability(plain["FREE-CORE"], rng=rng)
    assert core.identifiable == ("tau_dn", "b")
    assert {c.name for c in core.combinations} == {"(e - a) / tau_u", "b (2 - a) / tau_u"}
    # the log shows the same numbers better, not another one
    assert identifiability(plain["FREE-SHIP"], rng=rng).rank == core.rank == 4
    known = {name: with_known_propeller(model, propeller, mass_kg=57240.0) for name, model in plain.items()}
    assert identifiability(known["FREE-CORE"], rng=rng).identifiable == ("tau_dn", "e", "w", "R")
    weighed = identifiability(known["FREE-CORE"].free_between(m=(3e4, 9e4)), rng=rng)
    assert weighed.identifiable == ("tau_dn", "e", "w")
    assert "tau_u" in {c.name for c in weighed.combinations}
    # an unknown zero of the gauge hides the wake from the shaft, but not from shaft and log
    assert "w" not in identifiability(known["FREE-CORE"].free_between(k_q=(1.8, 2.2)), rng=rng).identifiable
    assert "w" in identifiability(known["FREE-SHIP"].free_between(k_q=(1.8, 2.2)), rng=rng).identifiable


@pytest.mark.slow
def test_slow_log_leaves_fast_lines_out(trip, tmp_path):
    """A value a second shows nothing above 0.45 Hz; shaft and torque stay what they were."""
    campaign = load_campaign("short").model_copy(update={"offset_v": -6.66, "staircases": (), "duration_s": 700.0})
    campaign = campaign.model_copy(
        update={"sines": tuple(s.model_copy(update={"amplitude_v": 0.13}) for s in campaign.sines if s.stop_s < 700.0)}
    )
    levels = load_campaign("transit").staircases[0].model_copy(update={"start_s": 10.0})
    campaign = campaign.model_copy(update={"staircases": (levels,)})
    vessel = logged(load_vessel("stan-tug-1205"), unit="kn", cycle_s=1.0, resolution=0.01)
    path = tmp_path / "slow.nc"
    sail(vessel, campaign, path, tug=Tug(engine_speed_rpm=RPM, sailing=Sailing()), seed=2)
    found = {}
    for name, ship in (("with", vessel), ("without", load_vessel("stan-tug-1205"))):
        with read_recording(path) as recording:
            found[name] = estimate_spectra(prepare_signals(recording, ship, campaign), campaign)
    response = found["with"].response
    assert response.outputs == ("n", "M_s", "v_s")
    assert measured(response)[2].tolist() == (response.frequency_hz < 0.45).tolist()
    assert all(
        ("v_s is not measured" in found["with"].remarks.get(line, "")) == (f > 0.45)
        for line, f in zip(response.lines, response.frequency_hz, strict=True)
    )
    assert response.response[:2] == pytest.approx(found["without"].response.response, rel=1e-9)


@pytest.mark.slow
def test_log_at_the_quay_is_left_out(tmp_path):
    campaign = load_campaign("short")
    vessel = logged(load_vessel("stan-tug-1205"))
    sail(vessel, campaign, tmp_path / "quay.nc", seed=3)
    with read_recording(tmp_path / "quay.nc") as recording:
        signals = prepare_signals(recording, vessel, campaign)
    assert "v_s" not in signals.channels
    assert any("the ship had no way on" in finding for finding in signals.findings)
