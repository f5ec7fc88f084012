"""A diesel with an electric machine on its gearbox: what its file says, and what it may not."""

from importlib.resources import files

import pytest

from shaftprint.card import disagreements
from shaftprint.errors import SettingsError
from shaftprint.vessel import load_vessel

SHIPPED = files("shaftprint.vessel") / "shipped" / "foss_carolyn_dorothy.toml"


@pytest.fixture(scope="module")
def hybrid():
    return load_vessel("foss-carolyn-dorothy")


@pytest.fixture
def changed(tmp_path):
    """Return the tug's file with something else in it, read."""

    def read(old, new):
        text = SHIPPED.read_text(encoding="utf-8")
        assert text.count(old) == 1
        path = tmp_path / "hybrid.toml"
        path.write_text(text.replace(old, new), encoding="utf-8")
        return load_vessel(path)

    return read


def test_shipped_tug_is_an_equilibrium_that_agrees_with_itself(hybrid):
    propeller, speed = hybrid.propeller, 1200.0 / 60.0 / 6.8
    load = propeller.torque_coefficient * hybrid.water_density_kg_m3 * speed**2 * propeller.diameter_m**5
    assert hybrid.working_point.shaft_torque_nm == pytest.approx(load, rel=1e-3)
    assert disagreements(hybrid) == ()
    assert hybrid.drive == "hybrid"
    assert "gives 35 % of the torque" in hybrid.summary().facts["electric machine"]


def test_rotor_turns_upstream_with_its_own_ratio(hybrid, changed):
    # 9 kg m2 at 6.8 times the speed of the propeller; 2.5 times with another gear
    slower = changed("ratio = 6.8\nefficiency = 0.95\ninertia", "ratio = 9.0\nefficiency = 0.95\ninertia")
    assert slower.inertia_upstream_kg_m2 - hybrid.inertia_upstream_kg_m2 == pytest.approx(9.0 * (9.0**2 - 6.8**2))
    assert slower.inertia_downstream_kg_m2 == hybrid.inertia_downstream_kg_m2


def test_losses_go_the_way_of_the_power(hybrid, changed):
    assert hybrid.shaft_machine.shaft_nm(100.0) == pytest.approx(100.0 * 6.8 * 0.95)
    generator = changed("share = 0.35", "share = -0.2")
    # a generator gets less than is taken off the line
    assert generator.shaft_machine.shaft_nm(-100.0) == pytest.approx(-100.0 * 6.8 / 0.95)


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ("share = 0.35", "share = 1.2", "shaft_machine.share: expected less than 1, found 1.2"),
        ("share = 0.35", "share = -1.3", "shaft_machine.share: expected"),
        # 1.9 of 31236 N m through 6.8 and 0.95, where the curve has 8050 N m between 7800 and 8300
        (
            "share = 0.35",
            "share = -0.9",
            "expected at most 8050 N m of the engine at 1200 rpm, its full-load curve, found 9187 N m, what the "
            "generator takes out and the propeller needs at shaft_machine.share = -0.9",
        ),
        (
            "rated_power_kw = 895.0",
            "rated_power_kw = 250.0",
            "expected shaft_machine.share within the machine's highest torque of 1326 N m, found 0.35, 1692 N m",
        ),
        ("torque_nm_per_v = 1000.0", "torque_nm_per_v = 0.0", "expected torque_nm_per_v other than 0"),
    ],
)
def test_a_file_that_contradicts_itself_is_refused(changed, old, new, sentence):
    with pytest.raises(SettingsError) as refused:
        changed(old, new)
    assert sentence in " ".join(str(refused.value).split())


def test_a_channel_of_a_machine_that_is_not_there_is_refused(changed):
    text = SHIPPED.read_text(encoding="utf-8")
    start = text.index("[shaft_machine]")
    table = text[start : text.index("\n\n", start)]
    with pytest.raises(SettingsError, match=r"expected \[shaft_machine\] beside sensors.machine_torque, found none"):
        changed(table, "")
