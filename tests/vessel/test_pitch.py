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

    def read(old, new):
        text = SHIPPED.read_text(encoding="utf-8")
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
