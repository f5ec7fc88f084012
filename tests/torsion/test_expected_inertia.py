"""Inertia by calculation: sums of the table, entrained water, inertia times with what their uncertainty is made of."""

import itertools
import math

import pytest

from shaftprint.catalogue import structure
from shaftprint.identify import priors_from_vessel
from shaftprint.signals import WorkingPoint
from shaftprint.torsion import expected_inertia, schwanecke_kg_m2, strip_theory_kg_m2
from shaftprint.torsion._entrained_water import Blades, water_estimates
from shaftprint.torsion._expected_inertia import compare_inertia

# 2 pi n_s0 / M_s0 with n_s0 = 1183.8 / 60 / 3.82
SLOPE = 2.0 * math.pi * 5.16492 / 1725.0


def blades(number, area, pitch=1.11):
    return Blades(blades=number, pitch_ratio=pitch, area_ratio=area, diameter_m=1.05, water_density_kg_m3=1025.0)


@pytest.fixture(scope="module")
def expected(tug):
    return expected_inertia(tug)


# ---- water ----


@pytest.mark.parametrize(
    ("number", "area", "schwanecke", "strips"), [(4, 0.70, 4.42, 4.26), (3, 0.65, 5.08, 4.90), (3, 0.70, 5.89, 5.68)]
)
def test_water_reckoned_by_hand(number, area, schwanecke, strips):
    assert schwanecke_kg_m2(blades(number, area)) == pytest.approx(schwanecke, abs=0.005)
    assert strip_theory_kg_m2(blades(number, area)) == pytest.approx(strips, abs=0.005)


def test_both_formulas_go_with_the_same_powers():
    """With D^5, the square of the area, 1 over the blades, and the square of the pitch while it is low."""
    for formula in (schwanecke_kg_m2, strip_theory_kg_m2):
        base = formula(blades(4, 0.5))
        large = Blades(blades=4, pitch_ratio=1.11, area_ratio=0.5, diameter_m=2.1, water_density_kg_m3=1000.0)
        assert formula(large) / base == pytest.approx(32.0 * 1000.0 / 1025.0, rel=1e-9)
        assert formula(blades(4, 1.0)) / base == pytest.approx(4.0, rel=1e-9)
        assert formula(blades(2, 0.5)) / base == pytest.approx(2.0, rel=1e-9)
        assert formula(blades(4, 0.5, pitch=0.02)) / formula(blades(4, 0.5, pitch=0.01)) == pytest.approx(4.0, rel=1e-3)


def test_strips_of_a_low_pitch_in_closed_form():
    """At low pitch sin(phi) r is P / (2 pi): Z (pi/4) rho (P / 2 pi)^2 times the integral of c^2.

    The chords are linear between the points of the table, so that the integral of their squares is known.
    """
    table = [0.6715, 0.7659, 0.8519, 0.9301, 1.0, 1.0586, 1.1008, 1.1266, 1.1288]
    squares = sum(0.1 * (a * a + a * b + b * b) / 3.0 for a, b in itertools.pairwise(table))
    chord = 1.969 * 1.05 * 0.7 / 4.0
    pitch = 0.001 * 1.05 / (2.0 * math.pi)
    by_hand = 4.0 * math.pi / 4.0 * 1025.0 * pitch**2 * chord**2 * squares * 0.525
    assert strip_theory_kg_m2(blades(4, 0.7, pitch=0.001)) == pytest.approx(by_hand, rel=1e-5)


def test_water_of_the_shipped_vessel(tug):
    """Three blades in the file, as in the calculation of the type ship; a quarter of 12.29 by the rule."""
    found = {item.method: item for item in water_estimates(tug)}
    assert found["Schwanecke"].water_kg_m2 == pytest.approx(5.89, abs=0.005)
    assert found["strip theory"].water_kg_m2 == pytest.approx(5.68, abs=0.005)
    assert found["1.25 times dry"].water_kg_m2 == pytest.approx(3.0725, rel=1e-12)
    # evenly between 1.1 and 1.5 of the dry inertia: 0.4 / sqrt(12)
    assert found["1.25 times dry"].std_kg_m2 == pytest.approx(12.29 * 0.115470, rel=1e-5)
    assert all(item.std_kg_m2 > 0.0 for item in found.values())


def test_what_a_vessel_does_not_say_is_not_estimated(tug):
    unknown = tug.model_copy(update={"propeller": tug.propeller.model_copy(update={"area_ratio": None})})
    assert [item.method for item in water_estimates(unknown)] == ["1.25 times dry"]
    plain = tuple(row.model_copy(update={"part": None}) for row in unknown.inertia)
    nothing = expected_inertia(unknown.model_copy(update={"inertia": plain}))
    assert nothing.wet == ()
    assert nothing.value("I_p") is None
    assert nothing.value("I_dn").value == pytest.approx(17.0, abs=1e-9)


# ---- sums and times ----


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("I_e", 3.646556),
        ("I_e i^2", 53.212),
        ("I_up", 54.006),
        ("I_p", 12.290),
        ("I_up + I_p", 66.296),
        ("I_dn", 17.0),
        ("I_up + I_dn", 71.006),
    ],
)
def test_reflected_sums(expected, name, value):
    assert expected.value(name).value == pytest.approx(value, abs=5e-6 if name == "I_e" else 5e-5)


def test_inertia_times_of_the_thesis(expected):
    """Thesis eq. 5.1 and the same downstream; deviations from the rows, and 2 % of gauge scale."""
    up, down = expected.value("tau_up"), expected.value("tau_dn")
    assert up.value == pytest.approx(1.016, abs=5e-4)
    assert down.value == pytest.approx(0.320, abs=5e-4)
    assert down.std == pytest.approx(math.hypot(SLOPE * math.hypot(0.61, 1.5, 0.1), 0.02 * 17.0 * SLOPE), rel=1e-5)
    assert down.changes["gauge scale"] == pytest.approx(-0.02 * 17.0 * SLOPE, rel=1e-5)
    assert next(iter(down.shares)) == "Entrained water"
    assert down.shares["Entrained water"] == pytest.approx(2.25 / (2.25 + 0.3721 + 0.01 + 0.1156), rel=1e-4)
    assert sum(down.shares.values()) == pytest.approx(1.0, rel=1e-12)


def test_the_prior_of_the_fit_is_the_same_number(tug, expected):
    point = WorkingPoint(
        engine_speed_rev_s=1183.8 / 60.0,
        shaft_torque_nm=1725.0,
        engine_speed_std_rev_s=0.0,
        shaft_torque_std_nm=0.0,
        set_point_v=0.0,
        load_std=0.0,
    )
    prior = priors_from_vessel(structure("GAUGE-CLOSED"), tug, point)["tau_up"]
    assert expected.value("tau_up").value == pytest.approx(prior.mean, rel=1e-12)
    assert expected.value("tau_up").std == pytest.approx(prior.std, rel=1e-12)


@pytest.mark.parametrize(
    ("method", "inertia", "tau"),
    [("Schwanecke", 18.48, 0.3477), ("strip theory", 18.27, 0.3437), ("1.25 times dry", 15.66, 0.2947)],
)
def test_downstream_side_by_each_estimate(expected, method, inertia, tau):
    """12.29 and 0.30 with the water of each, by hand; dry rows 0.61 and 0.10 beside the water's own deviation."""
    found = next(item for item in expected.wet if item.water.method == method)
    assert found.downstream_kg_m2 == pytest.approx(inertia, abs=0.005)
    assert found.tau_dn_s == pytest.approx(tau, abs=5e-4)
    std = math.hypot(0.61, 0.10, found.water.std_kg_m2)
    assert found.downstream_std_kg_m2 == pytest.approx(std, rel=1e-9)
    assert found.tau_dn_std_s == pytest.approx(SLOPE * math.hypot(std, 0.02 * found.downstream_kg_m2), rel=1e-5)


def test_measured_working_point_instead_of_that_of_the_file(tug):
    found = expected_inertia(tug, engine_speed_rev_s=2.0 * 1183.8 / 60.0, shaft_torque_nm=4.0 * 1725.0)
    # tau goes with 1 / n_0 in bollard pull
    assert found.value("tau_up").value == pytest.approx(1.016 / 2.0, abs=5e-4)


def test_a_gauge_whose_scale_is_not_stated_adds_that_of_the_trade(tug):
    gauge = tug.sensors.shaft_torque.model_copy(update={"scale_std_fraction": None})
    sensors = tug.sensors.model_copy(update={"shaft_torque": gauge})
    found = expected_inertia(tug.model_copy(update={"sensors": sensors})).value("tau_dn")
    assert found.changes["gauge scale"] == pytest.approx(-0.01 * found.value)
    assert found.std == pytest.approx(math.hypot(SLOPE * math.hypot(0.61, 1.5, 0.1), 0.01 * found.value), rel=1e-5)


def test_rows_that_nobody_judged(tug):
    exact = tuple(row.model_copy(update={"std_kg_m2": None}) for row in tug.inertia)
    found = expected_inertia(tug.model_copy(update={"inertia": exact})).value("I_up")
    # 5 % of each row upstream, referred to the propeller shaft
    upstream = [row for row in tug.inertia if row.gauge == "upstream"]
    expected = math.hypot(*(0.05 * row.referred_kg_m2(tug.gearbox.ratio) for row in upstream))
    assert found.std == pytest.approx(expected, rel=1e-9)


def test_beside_what_a_test_found(expected):
    """The thesis' 0.3897 s is 1.38 deviations above 0.320 s if it is known to 0.04 s; tau_up was told."""
    rows = compare_inertia(
        expected, {"tau_dn": (0.3897, 0.04), "tau_up": (1.02, 0.02), "K_p": (5.0, 1.0)}, assumed=frozenset({"tau_up"})
    )
    found = {row.expected.name: row for row in rows}
    assert set(found) == {"tau_dn", "tau_up"}
    std = math.hypot(expected.value("tau_dn").std, 0.04)
    assert found["tau_dn"].deviations == pytest.approx((0.3897 - 0.31982) / std, rel=1e-3)
    assert math.isnan(found["tau_up"].deviations)
