"""A controllable pitch in a vessel file: what it says, and what it may not."""

from importlib.resources import files

import pytest

from shaftprint.card import disagreements
from shaftprint.errors import SettingsError
from shaftprint.propeller import wageningen_b
from shaftprint.vessel import load_vessel

SHIPPED = files("shaftprint.vessel") / "shipped" / "nifs_research_vessel.toml"


@pytest.fixture
def changed(tmp_path):
    """Return the research vessel's file with something else in it, read."""

    def read(old, new, *, file=SHIPPED):
        text = file.read_text(encoding="utf-8")
        assert old in text
        path = tmp_path / "ship.toml"
        path.write_text(text.replace(old, new), encoding="utf-8")
        return load_vessel(path)

    return read


def test_shipped_research_vessel_is_an_equilibrium_that_agrees_with_itself():
    ship = load_vessel("nifs-research-vessel")
    propeller, speed = ship.propeller, 600.0 / 60.0 / 3.91
    load = propeller.torque_coefficient * ship.water_density_kg_m3 * speed**2 * propeller.diameter_m**5
    assert ship.working_point.shaft_torque_nm == pytest.approx(load, rel=1e-3)
    assert propeller.torque_coefficient == pytest.approx(
        wageningen_b(blades=4, area_ratio=0.6).at(0.0, 0.8).torque, rel=1e-3
    )
    assert disagreements(ship) == ()
    assert ship.shows_pitch
    assert not load_vessel("stan-tug-1205").shows_pitch


SET_POINT = """[sensors.pitch_set_point]
channel = "U_pitch"
unit = "V"
pitch_ratio_per_v = 0.14
pitch_ratio_at_zero_v = 0.24
"""
TABLE = """[pitch]
lowest_ratio = 0.50
highest_ratio = 1.20
lag_s = 0.6
delay_s = 0.15
rate_per_s = 0.08
"""


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("rate_per_s = 0.08", "rate_per_s = 0.0", r"pitch\.rate_per_s"),
        ("lag_s = 0.6", "lag_s = -0.6", r"pitch\.lag_s"),
        (
            "pitch_ratio = 0.80",
            "pitch_ratio = 1.30",
            r"lowest_ratio = 0\.5 and pitch\.highest_ratio = 1\.2, found 1\.3",
        ),
        ("lowest_ratio = 0.50", "lowest_ratio = 1.50", r"expected lowest_ratio below highest_ratio = 1\.2, found 1\.5"),
        ("lag_s = 0.6", "lag_s = 0.6\ntorque_slope_std = 0.2", r"expected torque_slope beside torque_slope_std"),
        (SET_POINT, "", r"expected sensors\.pitch_set_point beside sensors\.pitch"),
        ("pitch_ratio_per_v = 0.12", "pitch_ratio_per_v = 0.0", r"expected pitch_ratio_per_v other than 0"),
        (TABLE, "", r"expected \[pitch\] beside sensors\.pitch"),
    ],
)
def test_a_pitch_that_contradicts_itself_is_refused_in_a_sentence(changed, old, new, message):
    with pytest.raises(SettingsError, match=message):
        changed(old, new)


def test_a_pitch_outside_the_curve_of_its_series_is_a_contradiction():
    ship = load_vessel("nifs-research-vessel")
    propeller = ship.propeller.model_copy(update={"pitch_ratio": 0.45})
    low = ship.pitch.model_copy(update={"lowest_ratio": 0.3})
    ship = ship.model_copy(update={"propeller": propeller, "pitch": low})
    found = [one for one in disagreements(ship) if "pitch" in one.field]
    assert [(one.field, one.is_contradiction) for one in found] == [
        ("propeller.pitch_ratio", True),
        ("pitch.lowest_ratio", False),
    ]
    assert "a pitch from 0.5 to 1.4, where Wageningen B4-60 was tested, found 0.45" in found[0].sentence("ship.toml")
    stated = ship.model_copy(update={"pitch": low.model_copy(update={"torque_slope": 1.8})})
    assert not [one for one in disagreements(stated) if "pitch" in one.field]


def test_without_a_series_the_slope_must_be_stated(changed):
    found = disagreements(changed('series = "Wageningen B4-60"\n', ""))
    assert [one.field for one in found if one.is_contradiction] == ["pitch.torque_slope"]


COMBINED = files("shaftprint.vessel") / "shipped" / "nifs_research_vessel_combinator.toml"
CURVE = """combinator_speed_rpm = [350.0, 500.0, 700.0, 900.0]
combinator_ratio = [0.58, 0.70, 0.90, 1.02]
"""
PITCH_SENSOR = """[sensors.pitch]
channel = "P_feedback"
unit = "V"
pitch_ratio_per_v = 0.12
pitch_ratio_at_zero_v = 0.0
latency_s = 0.005
scale_std_fraction = 0.02
"""


def test_a_combinator_asks_for_a_pitch_with_each_speed():
    pitch = load_vessel("nifs-research-vessel-combinator").combinator
    assert pitch.combined_ratio([350.0, 600.0, 800.0]) == pytest.approx([0.58, 0.80, 0.96])
    # 0.001 of P/D a revolution per minute, at 600 rpm and P/D 0.80
    assert pitch.combinator_slope(600.0) == pytest.approx(0.75)
    assert load_vessel("nifs-research-vessel").combinator is None


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("0.90, 1.02]", "0.90]", r"of equal length, at least 2, found 4 and 3"),
        ("350.0, 500.0", "500.0, 350.0", r"expected ascending speeds in combinator_speed_rpm"),
        ("0.58, 0.70", "0.40, 0.70", r"from lowest_ratio = 0\.5 to highest_ratio = 1\.2, found 0\.4 to 1\.02"),
        ("0.70, 0.90", "0.60, 0.90", r"pitch_ratio = 0\.8 at the 600 rpm of the working point, found 0\.75"),
        ("[350.0, 500.0, 700.0", "[350.0, 595.0, 605.0", r"within 2% of the working point.* found 595 rpm"),
        (PITCH_SENSOR, "", r"expected sensors\.pitch beside pitch\.combinator_speed_rpm, found none"),
        (PITCH_SENSOR, PITCH_SENSOR + SET_POINT, r"expected no sensors\.pitch_set_point beside pitch\.combinator"),
    ],
)
def test_a_combinator_that_contradicts_itself_is_refused_in_a_sentence(changed, old, new, message):
    with pytest.raises(SettingsError, match=message):
        changed(old, new, file=COMBINED)


def test_a_combinator_of_a_ship_underway_is_refused_in_a_sentence(tmp_path):
    text = COMBINED.read_text(encoding="utf-8")
    path = tmp_path / "ship.toml"
    hull = """[hull]
displacement_kg = 700000.0
added_mass_fraction = 0.06
shafts = 2
resistance_n = 60000.0
resistance_speed_m_s = 5.0
resistance_exponent = 2.0
"""
    underway = text.replace("shaft_torque_nm = 32990.0\n", f"shaft_torque_nm = 32990.0\nship_speed_m_s = 5.0\n{hull}")
    path.write_text(underway, encoding="utf-8")
    with pytest.raises(SettingsError, match=r"expected an engine at the quay beside pitch\.combinator_speed_rpm"):
        load_vessel(path)
