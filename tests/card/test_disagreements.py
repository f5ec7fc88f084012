"""A vessel file that contradicts itself, one field wrong at a time; the numbers are worked out by hand."""

import math
from dataclasses import replace

import pytest

from shaftprint.card import disagreements
from shaftprint.card._card import Card
from shaftprint.card._write import write_vessel
from shaftprint.errors import SettingsError
from shaftprint.settings import write_template
from shaftprint.vessel import load_vessel


@pytest.fixture
def changed(tmp_path):
    """The template with one line changed."""

    def make(old, new):
        path = tmp_path / "ship.toml"
        path.unlink(missing_ok=True)
        write_template("vessel", path)
        text = path.read_text(encoding="utf-8")
        assert text.count(old) == 1
        path.write_text(text.replace(old, new), encoding="utf-8")
        return load_vessel(path)

    return make


@pytest.mark.parametrize(
    "name",
    [
        "stan-tug-1205",
        "stan-tug-1205-astern",
        "stan-tug-1205-ecu",
        "stan-tug-1205-underway",
        "pt-may",
        "pt-may-underway",
    ],
)
def test_shipped_vessels_agree_with_themselves(name):
    assert disagreements(load_vessel(name)) == ()


def test_template_agrees_with_itself(changed):
    assert disagreements(changed("blades = 4", "blades = 4")) == ()


def only(vessel, field):
    (found,) = [one for one in disagreements(vessel) if one.field == field]
    return found


def test_ratio_beside_the_speed_of_the_propeller(changed):
    """1800 rpm over 471 rpm is 3.8217; over 450 rpm it is 4."""
    old = "# propeller_rated_rpm = 471.2 "
    assert disagreements(changed(old, "propeller_rated_rpm = 471.0 ")) == ()
    wrong = only(changed(old, "propeller_rated_rpm = 450.0 "), "gearbox.ratio")
    assert wrong.is_contradiction
    assert wrong.sentence("ship.toml") == (
        "ship.toml, gearbox.ratio: expected 4, as the engine's 1800 rpm turn the propeller at 450 rpm, found 3.82; "
        "correct the ratio, engine.rated_speed_rpm or gearbox.propeller_rated_rpm."
    )
    # 1800 / 466 = 3.8627, 1.1 % above
    assert not only(changed(old, "propeller_rated_rpm = 466.0 "), "gearbox.ratio").is_contradiction


def test_clutch_that_slips_at_full_load(changed):
    highest = max(changed("blades = 4", "blades = 4").engine.full_load_torque_nm)
    efficiency = "efficiency = 0.97 "
    assert disagreements(changed(efficiency, f"clutch_torque_nm = {highest}\n{efficiency}")) == ()
    found = only(changed(efficiency, f"clutch_torque_nm = {highest - 1.0}\n{efficiency}"), "gearbox.clutch_torque_nm")
    assert found.is_contradiction
    assert f"at least the highest torque of the engine, {highest:g} N m" in found.sentence("ship.toml")


def test_ratio_astern_that_is_another_gearbox(changed):
    line = "# astern_ratio = 3.9 "
    assert disagreements(changed(line, "astern_ratio = 3.9 ")) == ()
    found = only(changed(line, "astern_ratio = 39.0 "), "gearbox.astern_ratio")
    assert found.is_contradiction
    assert "expected a ratio within a factor of 2 of that ahead, 3.82, found 39" in found.sentence("ship.toml")


def test_ratio_upside_down(changed):
    """1800 rpm over 1 / 3.82 are 114.6 rev/s: tips of 1.05 m at 378 m/s."""
    found = disagreements(changed("ratio = 3.82 ", "ratio = 0.2618 "))
    assert "378 m/s" in next(one.found for one in found if one.field == "gearbox.ratio")
    assert all(one.is_contradiction for one in found)


def test_torque_above_full_load(changed):
    """5500 / (3.82 * 0.97) = 1484.3 N m at the engine; at 1184 rpm the curve has 700 + 620 * 584 / 600 = 1303.5."""
    found = disagreements(changed("shaft_torque_nm = 1725.0", "shaft_torque_nm = 5500.0"))
    engine = next(one for one in found if "full load" in one.expected)
    assert engine.is_contradiction
    assert "at most 1303 N m" in engine.expected
    assert "1484 N m there" in engine.found
    # 1025 * (1184 / 60 / 3.82)^2 * 1.05^5 * 0.0560555 = 1956.9 N m
    series = next(one for one in found if "Ka4-70" in one.expected)
    assert series.is_contradiction
    assert "about 1957 N m" in series.expected
    assert series.found == "5500 N m, a factor of 2.81"


def test_torque_in_kilonewton_metres(changed):
    found = disagreements(changed("shaft_torque_nm = 1725.0", "shaft_torque_nm = 1.725"))
    assert {one.field for one in found} == {"working_point.shaft_torque_nm", "propeller.torque_coefficient"}
    assert all(one.is_contradiction for one in found)


def test_more_than_the_rated_power_below_full_load(changed):
    """1725 N m are 465.54 N m at the engine: 57.7 kW at 1184 rpm, more than an engine of 50 kW has."""
    vessel = changed("rated_power_kw = 221.0", "rated_power_kw = 50.0")
    power = next(one for one in disagreements(vessel) if one.field == "working_point.shaft_torque_nm")
    assert power.is_contradiction
    assert "rated power of 50 kW" in power.expected
    assert "57.72 kW" in power.found


@pytest.mark.parametrize(
    ("power_kw", "times", "is_contradiction"),
    [
        # Ka4-70 takes 0.0560555 * 1025 * 7.8534^2 * 1.05^5 = 4522.8 N m at 1800 rpm: 230.1 kW behind 3.82 and 0.97
        (110.5, "2.08", False),
        (73.0, None, True),
        (663.0, "0.347", False),
        (1326.0, "0.174", True),
    ],
)
def test_propeller_that_is_not_of_this_engine(tmp_path, power_kw, times, is_contradiction):
    found = [one for one in disagreements(of_card(tmp_path, rated_power_kw=power_kw)) if one.is_contradiction or times]
    if times is None:
        # 1.39 times the full load at two thirds of rated speed: the working point says it, once
        assert [one.field for one in found] == ["working_point.shaft_torque_nm"]
        return
    (propeller,) = found
    assert (propeller.field, propeller.is_contradiction) == ("propeller", is_contradiction)
    assert propeller.expected == f"one that asks for about the {power_kw:g} kW of the engine at the rated 1800 rpm"
    assert propeller.found.startswith(f"one that asks there for {times} times as much, 230.1 kW,")
    assert "at bollard pull" in propeller.found
    assert "gearbox.ratio, propeller.diameter_m" in propeller.advice
    assert ("ship_speed_m_s" in propeller.advice) == (power_kw < 221.0)


def test_heavy_propeller_says_the_speed_that_it_lets_the_engine_reach(tmp_path):
    """542.5 N m (n / 1200)^2 meet 586.2 * 1.13 N m, the flat of the usual curve, at 1200 * sqrt(1.2211)."""
    (found,) = disagreements(of_card(tmp_path, rated_power_kw=110.5))
    assert "is turned at no more than 1326 rpm of the engine" in found.found


def test_propellers_of_built_ships_are_of_their_engines(tmp_path):
    """A propeller for free sailing takes about 1.5 times the rated power at bollard pull; a pitch may be small."""
    tug = {"rated_power_kw": 1325.0, "rated_speed_rpm": 1600.0, "diameter_m": 2.1, "gear_ratio": 5.2}
    assert disagreements(of_card(tmp_path, **tug, blades=4, pitch_ratio=0.95, in_nozzle=False)) == ()
    fine = load_vessel("nifs-research-vessel")
    point = fine.working_point.model_copy(update={"shaft_torque_nm": 0.2 * fine.working_point.shaft_torque_nm})
    found = disagreements(fine.model_copy(update={"working_point": point}))
    assert "propeller" not in {one.field for one in found}


def of_card(folder, **changed):
    """The vessel of a card, the Stan Tug's but for what is stated."""
    card = {"rated_power_kw": 221.0, "rated_speed_rpm": 1800.0, "cylinders": 6, "diameter_m": 1.05, "blades": 3}
    card |= {"pitch_ratio": 1.11, "gear_ratio": 3.82, "in_nozzle": True}
    return write_vessel(Card(**card | changed), folder / "card.toml")


def test_horse_power_in_the_place_of_kilowatts(changed):
    """300 hp for 221 kW: the curve is 0.737 of what 300 kW give, 1591.5 N m."""
    curve = only(changed("rated_power_kw = 221.0", "rated_power_kw = 300.0"), "engine.full_load_torque_nm")
    assert curve.is_contradiction
    assert "1592 N m at 1800 rpm" in curve.expected
    assert not only(
        changed("rated_power_kw = 221.0", "rated_power_kw = 250.0"), "engine.full_load_torque_nm"
    ).is_contradiction


def test_torque_that_the_series_finds_strange(changed):
    """1450 N m are 0.741 of 1956.9: more than a quarter and less than a factor of two off."""
    found = only(changed("shaft_torque_nm = 1725.0", "shaft_torque_nm = 1450.0"), "working_point.shaft_torque_nm")
    assert not found.is_contradiction
    assert found.found == "1450 N m, a factor of 1.35"


def test_diameter_in_feet(changed):
    """3.445 ft: (3.445 / 1.05)^5 = 380 times the torque; tips of 85 m/s alone would pass."""
    found = disagreements(changed("diameter_m = 1.05", "diameter_m = 3.445"))
    assert {one.field for one in found} == {"working_point.shaft_torque_nm", "propeller.torque_coefficient"}


def test_torque_coefficient_ten_times_too_large(changed):
    """1725 / (1025 * 5.1658^2 * 1.27628) = 0.0494."""
    found = only(changed("torque_coefficient = 0.0494", "torque_coefficient = 0.494"), "propeller.torque_coefficient")
    assert found.is_contradiction
    assert found.expected.startswith("0.04941")


@pytest.mark.parametrize(
    ("old", "new", "field"),
    [
        ("engine_speed_rpm = 1184.0", "engine_speed_rpm = 590.0", "engine.idle_speed_rpm"),
        ("engine_speed_rpm = 1184.0", "engine_speed_rpm = 1900.0", "engine.rated_speed_rpm"),
        ("# [limits]", "[limits]\nlowest_speed_rpm = 1200.0", "limits.lowest_speed_rpm"),
        ("# [limits]", "[limits]\nhighest_speed_rpm = 1100.0", "limits.highest_speed_rpm"),
        ("full_scale_nm = 5000.0", "full_scale_nm = 1500.0", "sensors.shaft_torque.full_scale_nm"),
    ],
)
def test_working_point_outside_of_what_is_allowed(changed, old, new, field):
    assert only(changed(old, new), field).is_contradiction


def test_a_propeller_of_no_series_is_held_against_none(changed):
    """Wageningen B ends at P/D 1.4, and nobody tested a single blade."""
    vessel = changed('series = "Ka4-70 in nozzle 19A"', 'series = "B-series"')
    propeller = vessel.propeller.model_copy(update={"blades": 1})
    point = vessel.working_point.model_copy(update={"shaft_torque_nm": 1450.0})
    assert disagreements(vessel.model_copy(update={"propeller": propeller, "working_point": point})) == ()


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("ratio = 3.82 ", "ratio = 1e-200 "),
        ("ratio = 3.82 ", "ratio = 1e30 "),
        ("diameter_m = 1.05", "diameter_m = 1e-100"),
        ("diameter_m = 1.05", "diameter_m = 1e30"),
        ("torque_coefficient = 0.0494", "torque_coefficient = 1e-320"),
        ("# propeller_rated_rpm = 471.2 ", "propeller_rated_rpm = 1e-300 "),
        ("shaft_torque_nm = 1725.0", "shaft_torque_nm = 1e-320"),
    ],
)
def test_numbers_beyond_all_ships_are_contradictions_too(changed, old, new):
    assert any(one.is_contradiction for one in disagreements(changed(old, new)))


def underway(**values):
    vessel = load_vessel("stan-tug-1205-underway")
    return vessel.model_copy(update={"working_point": vessel.working_point.model_copy(update=values)})


def test_speed_of_the_ship_in_knots():
    """9.23 kn are 4.75 m/s; 9.23 m/s are an advance of 1.01, beyond the thrust of Ka4-70 at P/D 1.11."""
    wrong = only(underway(ship_speed_m_s=9.23), "working_point.ship_speed_m_s")
    assert wrong.is_contradiction
    assert "a speed at which the propellers pull, below" in wrong.expected
    assert "m/s, not knots" in wrong.advice


def test_speed_at_which_pull_and_resistance_differ():
    """At 3 m/s the resistance is (3 / 5.093)^4 of 43 kN, 5.2 kN, and both propellers pull some 43 kN."""
    wrong = only(underway(ship_speed_m_s=3.0), "working_point.ship_speed_m_s")
    assert wrong.is_contradiction
    assert "5177 N at 3 m/s" in wrong.found


def test_a_coupling_so_soft_that_no_governor_could_hold_the_speed(changed):
    """The template's shaft of 172 kN m/rad, written in kN m/rad: its mode falls by a factor of sqrt(1000)."""
    with_links = """[[links]]
between = ["Engine, flywheel and coupling", "Output gear and flanges"]
source = "assumed"

[[links]]
between = ["Output gear and flanges", "Propeller, dry"]
stiffness_nm_rad = {stiffness}
source = "assumed"

[[links]]
between = ["Propeller, dry", "Entrained water"]
source = "assumed"

"""
    mark = "# Speed pick-ups: one block each; the first is the one that is identified."
    right = changed(mark, with_links.format(stiffness=172000.0) + mark)
    assert disagreements(right) == ()
    up, down = right.inertia_upstream_kg_m2, right.inertia_downstream_kg_m2
    found = only(changed(mark, with_links.format(stiffness=172.0) + mark), "links[2].stiffness_nm_rad")
    by_hand_hz = math.sqrt(172.0 * (1.0 / up + 1.0 / down)) / (2.0 * math.pi)
    assert by_hand_hz < 1.0
    assert found.is_contradiction
    assert found.sentence("ship.toml").startswith(
        "ship.toml, links[2].stiffness_nm_rad: expected a stiffness with which the line swings at 1 Hz or above, as a "
        "rule 3 to 30 Hz, found 172 N m/rad between Output gear and flanges and Propeller, dry, with which its first "
    )
    assert f"mode is at {by_hand_hz:.2g} Hz" in found.found


def astern(**values):
    """An open propeller of four blades with P/D 1.0 that turns astern at 1183.8 rpm of the engine."""
    vessel = load_vessel("stan-tug-1205-astern")
    changes = {"blades": 4, "series": "Wageningen B4-70", "pitch_ratio": 1.0} | values
    return vessel.model_copy(update={"propeller": vessel.propeller.model_copy(update=changes)})


def test_torque_astern_is_held_against_the_series_astern():
    """0.0628 of 1025 * 5.16492^2 * 1.05^5 = 34898 N m are 2192 N m, 1.27 times the 1725 N m of the file."""
    wrong = only(astern(), "working_point.shaft_torque_nm")
    assert not wrong.is_contradiction
    assert wrong.expected.startswith("about -219")
    assert "as Wageningen B4-70 astern takes at zero advance" in wrong.expected
    assert wrong.found == "-1725 N m, a factor of 1.27"


@pytest.mark.parametrize("changes", [{"blades": 3}, {"area_ratio": 0.55}, {"series": "Ka4-70 in nozzle 19A"}])
def test_no_series_astern_is_taken_for_another_propeller(changes):
    assert disagreements(astern(**changes)) == ()


def test_torque_coefficient_astern_that_disagrees():
    wrong = only(astern(blades=3, astern_torque_coefficient=0.4943), "propeller.astern_torque_coefficient")
    assert wrong.is_contradiction
    assert wrong.expected.startswith("0.04943, as -1725 N m at 1183.8 rpm")


OF_ELBE = Card(
    rated_power_kw=880.0,
    rated_speed_rpm=1800.0,
    cylinders=8,
    diameter_m=1.38,
    blades=5,
    pitch_ratio=1.05,
    gear_ratio=3.6,
)


def with_lines(tmp_path, *changes, **fields):
    """The vessel file of a card with some of its lines changed."""
    path = tmp_path / "card.toml"
    path.unlink(missing_ok=True)
    write_vessel(replace(OF_ELBE, **fields), path)
    text = path.read_text(encoding="utf-8")
    for old, new in changes:
        assert text.count(old) == 1
        text = text.replace(old, new)
    path.write_text(text, encoding="utf-8")
    return load_vessel(path)


def test_a_pitch_in_metres_is_told_with_the_series_that_does_not_hold_it(tmp_path):
    """1.449 m are 1.05 of 1.38 m; Wageningen B5 was tested from 0.5 to 1.4."""
    found = only(with_lines(tmp_path, pitch_ratio=1.449), "propeller.pitch_ratio")
    assert not found.is_contradiction
    assert "from 0.5 to 1.4, where Wageningen B5-55 was tested" in found.expected
    assert found.found == "1.449, so that no torque is taken from the series; 1.449 m would be 1.05 of the diameter"
    assert not [one for one in disagreements(with_lines(tmp_path)) if one.field.startswith("propeller")]


def test_blades_that_the_series_was_not_tested_with_are_told(tmp_path):
    found = only(with_lines(tmp_path, blades=8), "propeller.series")
    assert "from 2 to 7 blades, found 8" in found.found


def test_an_inertia_of_the_other_shaft_is_told_by_the_square_of_the_ratio(tmp_path):
    """3.6 squared is 12.96: 14.86 kg m2 of the engine are 192.6 at the propeller, 32.012 of the propeller are 2.47."""
    told = only(with_lines(tmp_path, ("inertia_kg_m2 = 14.86 ", "inertia_kg_m2 = 192.6 ")), "inertia")
    assert (told.found, told.is_contradiction) == ("192.6, which is 14.86 · 3.6²", False)
    assert told.advice == ('is it referred to the propeller shaft? Then state 14.86, or 192.6 and shaft = "propeller"')
    # of all behind the gauge, and of all before it as a card states it at the propeller shaft
    told = only(with_lines(tmp_path, inertia_downstream_kg_m2=2.47), "inertia")
    assert (told.found, told.advice) == (
        "2.47, which is 32.01 / 3.6²",
        "is it referred to the engine shaft? Then state 32.01",
    )
    told = only(with_lines(tmp_path, inertia_upstream_kg_m2=14.86), "inertia")
    assert told.found == "14.86, which is 192.6 / 3.6²"
    assert not [
        one for one in disagreements(with_lines(tmp_path, inertia_upstream_kg_m2=192.6)) if one.field == "inertia"
    ]


def test_an_inertia_that_the_ratio_does_not_explain_is_not_held_against_it(tmp_path):
    for doubled in ("28.0 ", "7.0 ", "90.0 ", "400.0 "):
        vessel = with_lines(tmp_path, ("inertia_kg_m2 = 14.86 ", f"inertia_kg_m2 = {doubled}"))
        assert not [one for one in disagreements(vessel) if one.field == "inertia"]
    # of a ratio of 1.8 the square is within what the estimate may be off
    vessel = with_lines(tmp_path, ("inertia_kg_m2 = 14.86 ", "inertia_kg_m2 = 48.1 "), gear_ratio=1.8)
    assert not [one for one in disagreements(vessel) if one.field == "inertia"]


def test_a_full_scale_in_kilonewton_metres_is_told_as_such(tmp_path):
    vessel = with_lines(tmp_path, ("full_scale_nm = 24454.0", "full_scale_nm = 24.454"))
    assert only(vessel, "sensors.shaft_torque.full_scale_nm").found == (
        "24.454 N m, which in kN m would be right: 24454 N m"
    )


@pytest.mark.parametrize(
    ("old", "new", "found"),
    [
        (
            "water_density_kg_m3 = 1025.0",
            "water_density_kg_m3 = 1.025",
            r"water_density_kg_m3: expected the density of water, 900 to 1100 kg/m3, found 1\.025; 1\.025 t/m3 are 1",
        ),
        ("water_density_kg_m3 = 1025.0", "water_density_kg_m3 = 1200.0", r"900 to 1100 kg/m3, found 1200\."),
        (
            "latency_s = 0.005",
            "latency_s = 5.0",
            r"shaft_torque\.latency_s: expected a latency of at most 1 s, found 5 s; 5 ms are 0\.005 s",
        ),
    ],
)
def test_numbers_in_another_unit_are_refused_with_the_number_that_was_meant(tmp_path, old, new, found):
    with pytest.raises(SettingsError, match=found):
        with_lines(tmp_path, (old, new))
