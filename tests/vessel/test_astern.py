"""A test astern in a vessel file: which way the shaft turns, and the sign of its torque."""

import pytest

from shaftprint.errors import SettingsError
from shaftprint.settings import write_template
from shaftprint.vessel import load_vessel

ASTERN = """direction = "astern"
shaft_torque_nm = -1600.0"""


@pytest.fixture
def changed(tmp_path):
    """Return a loader of the template with its working torque replaced by other lines, and further changes."""

    def make(lines, *changes):
        path = tmp_path / "vessel.toml"
        write_template("vessel", path)
        text = path.read_text(encoding="utf-8")
        for old, new in (("shaft_torque_nm = 1725.0", lines), *changes):
            assert old in text
            text = text.replace(old, new, 1)
        path.write_text(text, encoding="utf-8")
        return load_vessel(path)

    return make


COEFFICIENT = ("# astern_torque_coefficient = 0.044", "astern_torque_coefficient = 0.0458")


def test_shipped_ship_astern_is_the_same_ship():
    ahead, astern = (load_vessel(name).model_dump() for name in ("stan-tug-1205", "stan-tug-1205-astern"))
    assert astern.pop("working_point") == {
        "engine_speed_rpm": 1183.8,
        "shaft_torque_nm": -1725.0,
        "ship_speed_m_s": None,
        "direction": "astern",
    }
    ahead.pop("working_point")
    assert ahead.pop("hull") is not None
    assert astern.pop("hull") is None
    # 1725 N m at 5.16492 rev/s, and what Ka4-70 in nozzle 19A takes ahead
    stated = astern["propeller"]
    assert stated.pop("astern_torque_coefficient") == ahead["propeller"].pop("torque_coefficient") == 0.04943
    assert stated.pop("torque_coefficient") == 0.05606
    assert ahead["propeller"].pop("astern_torque_coefficient") is None
    assert stated.pop("astern_torque_coefficient_std") == 0.001
    assert ahead["propeller"].pop("astern_torque_coefficient_std") is None
    assert astern.pop("name") == ahead.pop("name") + ", astern"
    assert astern == ahead


def test_torque_that_drives_is_positive_both_ways(changed):
    astern = changed(ASTERN, COEFFICIENT)
    assert astern.working_point.driving_torque_nm == 1600.0
    assert astern.torque_coefficient == 0.0458
    # 500 N m a volt, counted ahead
    assert astern.driving_torque_nm([-3.2, 1.0]).tolist() == [1600.0, -500.0]
    ahead = load_vessel("stan-tug-1205")
    assert (ahead.working_point.is_astern, ahead.working_point.turning) == (False, 1.0)
    assert ahead.driving_torque_nm([3.45]).tolist() == [1725.0]
    assert ahead.torque_coefficient == ahead.propeller.torque_coefficient


def test_summary_says_astern(changed):
    assert changed(ASTERN, COEFFICIENT).summary().facts["working point"] == "1184 rpm, -1600 N m, astern"


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        (
            "shaft_torque_nm = -1725.0",
            r"expected shaft_torque_nm above 0 for a shaft that turns ahead, found -1725; set direction = .astern.",
        ),
        ("shaft_torque_nm = 0.0", r"expected shaft_torque_nm above 0 for a shaft that turns ahead, found 0"),
        (
            'shaft_torque_nm = 1725.0\ndirection = "astern"',
            r"expected shaft_torque_nm below 0 beside direction = .astern., .*, found 1725; turn its sign",
        ),
        ('shaft_torque_nm = 1725.0\ndirection = "back"', "working_point.direction"),
    ],
)
def test_torque_and_direction_that_disagree_are_refused(changed, lines, words):
    with pytest.raises(SettingsError, match=words):
        changed(lines, COEFFICIENT)


def test_a_file_may_say_ahead(changed):
    assert not changed('shaft_torque_nm = 1725.0\ndirection = "ahead"').working_point.is_astern


def test_astern_needs_its_torque_coefficient(changed):
    with pytest.raises(SettingsError, match=r"expected propeller\.astern_torque_coefficient beside direction"):
        changed(ASTERN)


def test_astern_underway_is_refused(changed):
    hull = (
        "[hull]\ndisplacement_kg = 54000.0\nadded_mass_fraction = 0.06\nshafts = 2\nresistance_n = 43000.0\n"
        "resistance_speed_m_s = 5.093\nresistance_exponent = 4.0\n\n[propeller]"
    )
    with pytest.raises(SettingsError, match="expected a test at the quay beside direction"):
        changed(f"{ASTERN}\nship_speed_m_s = 4.0", COEFFICIENT, ("[propeller]", hull))
