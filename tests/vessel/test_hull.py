"""The ship around the shaft lines."""

import pytest

from shaftprint.errors import SettingsError
from shaftprint.settings import write_template
from shaftprint.vessel import load_vessel


@pytest.mark.parametrize("name", ["stan-tug-1205", "stan-tug-1205-ecu", "stan-tug-1205-underway"])
def test_the_tug_has_the_mass_and_resistance_of_its_trial(name):
    """54 t and 6 % of water; two propellers of 25.3 kN, of which 15 % are lost, at 9.9 kn."""
    hull = load_vessel(name).hull
    assert hull.surging_mass_kg == pytest.approx(57240.0)
    assert hull.resistance_at_n(9.9 * 1852.0 / 3600.0) == pytest.approx(2 * 0.85 * 25.3e3, rel=2e-3)
    assert hull.resistance_at_n(0.5 * hull.resistance_speed_m_s) == pytest.approx(hull.resistance_n / 16.0)
    assert hull.shafts == 2


def test_hull_of_the_template_can_be_switched_on(tmp_path):
    path = tmp_path / "vessel.toml"
    write_template("vessel", path)
    text = path.read_text(encoding="utf-8")
    assert load_vessel(path).hull is None
    start = text.index("# [hull]")
    stop = text.index("\n\n", start)
    path.write_text(text[:start] + text[start:stop].replace("\n# ", "\n")[2:] + text[stop:], encoding="utf-8")
    assert load_vessel(path).hull.displacement_kg == 54000.0


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("added_mass_fraction = 0.06", "added_mass_fraction = 1.5", "hull.added_mass_fraction: expected .*, found 1.5"),
        ("shafts = 2", "shafts = 0", "hull.shafts: expected a number greater than 0, found 0"),
        ("resistance_n = 43000.0", "", "hull.resistance_n: expected a value, found none"),
    ],
)
def test_what_cannot_be_is_refused(tmp_path, old, new, words):
    write_template("vessel", tmp_path / "vessel.toml")
    text = (tmp_path / "vessel.toml").read_text(encoding="utf-8")
    start = text.index("# [hull]")
    stop = text.index("\n\n", start)
    table = text[start:stop].replace("\n# ", "\n")[2:].replace(old, new)
    (tmp_path / "vessel.toml").write_text(text[:start] + table + text[stop:], encoding="utf-8")
    with pytest.raises(SettingsError, match=words):
        load_vessel(tmp_path / "vessel.toml")


def test_a_speed_of_the_ship_needs_a_hull(tmp_path):
    write_template("vessel", tmp_path / "vessel.toml")
    text = (tmp_path / "vessel.toml").read_text(encoding="utf-8")
    text = text.replace("[working_point]\n", "[working_point]\nship_speed_m_s = 4.75\n")
    (tmp_path / "vessel.toml").write_text(text, encoding="utf-8")
    with pytest.raises(SettingsError, match=r"expected \[hull\] beside ship_speed_m_s of the working point"):
        load_vessel(tmp_path / "vessel.toml")


def test_what_a_file_does_not_state_is_usual():
    hull = load_vessel("stan-tug-1205").hull
    assert hull.surging_mass_std_kg == pytest.approx(1600.0 * 1.06)
    silent = hull.model_copy(update={"displacement_std_kg": None})
    assert silent.surging_mass_std_kg == pytest.approx(0.03 * 57240.0)
