"""What is known before a test: inertia from the vessel file, engine slope, latency of the telemetry."""

import math
from types import SimpleNamespace

import pytest

from shaftprint.catalogue import structure
from shaftprint.identify import Prior, priors_from_vessel
from shaftprint.identify.likelihood._known import PRIOR_OF_G, expected_from_vessel
from shaftprint.torsion._coupling import line_coupling
from shaftprint.vessel import load_vessel


def vessel(inertia_std=2.7, scale_std=0.02, latency_std=0.002):
    return SimpleNamespace(
        inertia_upstream_kg_m2=54.006,
        inertia_upstream_std_kg_m2=inertia_std,
        inertia_downstream_kg_m2=17.0,
        inertia_downstream_std_kg_m2=2.0 * inertia_std,
        gearbox=SimpleNamespace(ratio=3.82),
        is_underway=False,
        sensors=SimpleNamespace(
            shaft_torque=SimpleNamespace(scale_std=scale_std, latency_s=0.005, latency_std=latency_std),
            set_point=SimpleNamespace(latency_s=None, latency_std_s=None),
            rack=None,
        ),
    )


@pytest.fixture
def tug():
    return load_vessel("stan-tug-1205")


WORKING_POINT = SimpleNamespace(engine_speed_rev_s=19.73, shaft_torque_nm=1725.0, shaft_torque_std_nm=17.25)


def test_inertia_time_is_the_thesis_number_with_the_deviations_of_calculation_and_gauge():
    """Eq. 5.1: 54.006 kg m2 at 1183.8 rpm and 1725 N m is 1.016 s; 5 % and 2 % make 5.38 %."""
    known = priors_from_vessel(structure("GAUGE-CLOSED"), vessel(), WORKING_POINT)
    assert known["tau_up"].mean == pytest.approx(1.0160, abs=0.00005)
    assert known["tau_up"].std / known["tau_up"].mean == pytest.approx((0.04999**2 + 0.02**2) ** 0.5, rel=1e-4)
    # more torque shown for the same torque: a smaller inertia time
    assert known["tau_up"].sources == pytest.approx({"TVC": 0.050790, "gauge scale": -0.020320}, rel=1e-3)
    assert known["g"] == PRIOR_OF_G == Prior(mean=0.0, std=0.1)
    assert known["t_gauge"] == Prior(mean=0.0, std=0.002, sources={"telemetry latency": 0.002})


def test_the_inertia_that_a_test_checks_is_expected_by_a_plan_and_no_prior_of_a_fit():
    """17 kg m2 at 1183.8 rpm over 3.82, 1725 N m: 2 pi 17 5.165 / 1725 = 0.31983 s; 5.4 of 17 and 2 % make 31.8 %."""
    gauge_aware = structure("GAUGE-CLOSED")
    known = priors_from_vessel(gauge_aware, vessel(), WORKING_POINT)
    expected = expected_from_vessel(gauge_aware, vessel(), WORKING_POINT)
    assert "tau_dn" not in known
    assert expected["tau_dn"].mean == pytest.approx(0.31983, abs=0.00005)
    assert expected["tau_dn"].std / expected["tau_dn"].mean == pytest.approx(0.31828, abs=0.00005)
    assert {name: one for name, one in expected.items() if name != "tau_dn"} == known


def test_thesis_mode_leaves_the_latency_of_the_telemetry_in_the_torque():
    known = priors_from_vessel(structure("GAUGE-CLOSED"), vessel(), WORKING_POINT, mode="thesis")
    assert known["t_gauge"] == Prior(mean=0.005, std=0.002, sources={"telemetry latency": 0.002})


def test_what_the_vessel_file_takes_for_exact_is_no_prior():
    known = priors_from_vessel(structure("GAUGE-CLOSED"), vessel(inertia_std=0.0, latency_std=0.0), WORKING_POINT)
    assert set(known) == {"g"}
    certain = priors_from_vessel(structure("GAUGE-CLOSED"), vessel(scale_std=0.0), WORKING_POINT)
    assert certain["tau_up"].std / certain["tau_up"].mean == pytest.approx(0.04999, rel=1e-4)


def test_what_the_vessel_file_does_not_state_is_that_of_the_trade():
    """1 % of the scale and 2 ms of latency, as docs of the vessel file say."""
    shipped = load_vessel("stan-tug-1205")
    gauge = shipped.sensors.shaft_torque.model_copy(update={"scale_std_fraction": None, "latency_std_s": None})
    silent = shipped.model_copy(update={"sensors": shipped.sensors.model_copy(update={"shaft_torque": gauge})})
    known = priors_from_vessel(structure("GAUGE-CLOSED"), silent, WORKING_POINT)
    assert known["tau_up"].sources["gauge scale"] == pytest.approx(-0.01 * known["tau_up"].mean)
    assert known["t_gauge"].std == 0.002


def test_only_free_parameters_of_gauge_aware_structures_have_priors():
    assert priors_from_vessel(structure("CL4"), vessel(), WORKING_POINT) == {}
    assert priors_from_vessel(structure("BENCHMARK"), vessel(), WORKING_POINT) == {}
    held = structure("GAUGE-CLOSED").held_at(tau_up=1.016, t_gauge=0.0)
    assert priors_from_vessel(held, vessel(), WORKING_POINT) == {}
    assert set(priors_from_vessel(structure("GAUGE-CORE"), vessel(), WORKING_POINT)) == {"t_gauge"}


def test_latency_of_the_rack_is_known_as_the_vessel_file_says():
    ecu = load_vessel("stan-tug-1205-ecu")
    late, std = ecu.sensors.rack.latency_s, ecu.sensors.rack.latency_std_s
    known = priors_from_vessel(structure("GAUGE-ECU"), ecu, WORKING_POINT)
    assert known["t_rack"] == Prior(mean=0.0, std=std, sources={"rack latency": std})
    in_thesis_mode = priors_from_vessel(structure("ENGINE"), ecu, WORKING_POINT, mode="thesis")
    assert in_thesis_mode["t_rack"].mean == late
    assert "t_rack" not in priors_from_vessel(structure("GAUGE-ECU"), load_vessel("stan-tug-1205"), WORKING_POINT)


def test_a_measured_latency_of_the_set_point_is_known():
    measured = vessel()
    measured.sensors.set_point = SimpleNamespace(latency_s=0.05, latency_std_s=0.005)
    known = priors_from_vessel(structure("GAUGE-CLOSED"), measured, WORKING_POINT)
    assert known["t_sp"] == Prior(mean=0.05, std=0.005, sources={"set-point latency": 0.005})
    measured.sensors.set_point = SimpleNamespace(latency_s=0.05, latency_std_s=None)
    assert "t_sp" not in priors_from_vessel(structure("GAUGE-CLOSED"), measured, WORKING_POINT)


def test_inertia_downstream_is_known_beforehand_where_no_torque_shows_it():
    """17 kg m2 +/- 3 % of the vessel file, 2 pi 17 n_s0 / M_s0; with the torque it is what the test measures."""
    ship, both = load_vessel("stan-tug-1205"), structure("GAUGE-CLOSED")
    speed_only = both.of_outputs("n")
    assert "tau_dn" not in priors_from_vessel(both, ship, WORKING_POINT)
    known = priors_from_vessel(speed_only, ship, WORKING_POINT)["tau_dn"]
    factor = ship.inertia_downstream_kg_m2 / ship.inertia_upstream_kg_m2
    assert known.mean == pytest.approx(factor * priors_from_vessel(both, ship, WORKING_POINT)["tau_up"].mean)
    assert set(known.sources) == {"TVC", "gauge scale"}


def test_links_give_stiffness_damping_and_what_the_coupling_drives(tug):
    """2 pi n_s0 / M_s0 is 0.018813 s for 1 kg m2; the scale of the gauge, 2 %, counts in all of them."""
    elastic = structure("GAUGE-ELASTIC").free_between(tau_m=(0.0, 1.0))
    known, coupling = priors_from_vessel(elastic, tug, WORKING_POINT), line_coupling(tug)
    for name, value, std in (
        ("k_c", coupling.stiffness_nm_rad, coupling.stiffness_std_nm_rad),
        ("d_c", coupling.damping_nm_s_rad, coupling.damping_std_nm_s_rad),
        ("tau_m", coupling.driven_kg_m2, coupling.driven_std_kg_m2),
    ):
        assert known[name].mean == pytest.approx(0.018813 * value, rel=1e-4)
        assert known[name].std / known[name].mean == pytest.approx(math.hypot(std / value, 0.02), rel=1e-4)
    assert known["k_c"].sources.keys() == {"coupling", "gauge scale"}


def test_a_vessel_file_without_links_knows_no_coupling(tug):
    rigid = tug.model_copy(update={"links": ()})
    known = priors_from_vessel(structure("GAUGE-ELASTIC"), rigid, WORKING_POINT)
    assert known.keys().isdisjoint({"k_c", "d_c", "tau_m"})
