"""What joins the masses of the inertia table, and what cannot."""

import pytest

from shaftprint.errors import SettingsError
from shaftprint.settings import write_template
from shaftprint.vessel import load_vessel

ENGINE, GEAR, PROPELLER, WATER = (
    "Engine, flywheel and coupling",
    "Output gear and flanges",
    "Propeller, dry",
    "Entrained water",
)


def link(first, second, *lines):
    return "\n".join(["[[links]]", f'between = ["{first}", "{second}"]', *lines, 'source = "assumed"', ""])


MESH, SHAFT = link(ENGINE, GEAR), link(GEAR, PROPELLER, "stiffness_nm_rad = 172000.0")
BLADES = link(PROPELLER, WATER)


@pytest.fixture
def ship(tmp_path):
    """The template with some links."""

    def make(*links):
        path = tmp_path / "ship.toml"
        write_template("vessel", path)
        head, sensors = path.read_text(encoding="utf-8").split("[[sensors.speed]]", 1)
        path.write_text("\n".join([head, *links, "[[sensors.speed]]"]) + sensors, encoding="utf-8")
        return path

    return make


def test_links_of_the_template_can_be_switched_on(tmp_path):
    path = tmp_path / "ship.toml"
    write_template("vessel", path)
    assert load_vessel(path).links == ()
    text = path.read_text(encoding="utf-8")
    block = text[text.index("# [[links]]") : text.index("# Speed pick-ups")]
    path.write_text(text.replace(block, block.replace("\n# ", "\n").removeprefix("# ")), encoding="utf-8")
    found = load_vessel(path).links
    assert [item.between for item in found] == [(ENGINE, GEAR), (GEAR, PROPELLER), (PROPELLER, WATER)]
    assert [item.is_rigid for item in found] == [True, False, True]
    assert found[1].stiffness_nm_rad == 172000.0


@pytest.mark.parametrize(
    ("links", "message"),
    [
        ((MESH, SHAFT), r"links that join all inertia rows, found no way from Engine.* to Entrained water"),
        ((MESH, SHAFT, BLADES, link(GEAR, WATER)), "found a second one by Output gear and flanges - Entrained water"),
        ((MESH, SHAFT, link(PROPELLER, "Rope")), "expected the names of inertia rows in links, found Rope"),
        ((link(ENGINE, ENGINE), MESH, SHAFT, BLADES), "two different masses in between, found Engine"),
        (
            (link(ENGINE, GEAR, "stiffness_nm_rad = 1e6"), SHAFT, BLADES),
            "no stiffness and damping between engine and propeller shaft, where a gear mesh is, found them in Engine",
        ),
        (
            (MESH, link(GEAR, PROPELLER), BLADES),
            "expected stiffness_nm_rad in one of the links at least, found none",
        ),
        (
            (MESH, link(GEAR, PROPELLER, "damping_nm_s_rad = 3.0"), BLADES),
            "one link from upstream to downstream of the torque gauge, elastic or rigid, found Output gear",
        ),
        (
            (MESH, SHAFT, link(GEAR, WATER)),
            "elastic or rigid, found Output gear and flanges - Propeller, dry, Output gear and flanges - Entrained",
        ),
        (
            (MESH, link(GEAR, PROPELLER, "stiffness_nm_rad = 1e5", "relative_damping_std = 0.1"), BLADES),
            "relative_damping beside relative_damping_std",
        ),
        (
            (MESH, link(GEAR, PROPELLER, "stiffness_nm_rad = 1e5", "damping_std_nm_s_rad = 0.1"), BLADES),
            "damping_nm_s_rad beside damping_std_nm_s_rad",
        ),
        ((MESH, link(GEAR, PROPELLER, "relative_damping = 1.0"), BLADES), "stiffness_nm_rad beside relative_damping"),
        (
            (MESH, link(GEAR, PROPELLER, "stiffness_std_nm_rad = 1.0"), BLADES),
            "beside stiffness_std_nm_rad",
        ),
        ((MESH, link(GEAR, PROPELLER, "stiffness_nm_rad = 0.0"), BLADES), r"links\[2\]\.stiffness_nm_rad: .* than 0"),
    ],
)
def test_what_makes_no_line_is_refused(ship, links, message):
    with pytest.raises(SettingsError, match=message):
        load_vessel(ship(*links))


def test_a_spring_anywhere_makes_a_line(ship):
    """Propeller and water on a spring, and the shaft across the gauge rigid."""
    links = load_vessel(ship(MESH, link(GEAR, PROPELLER), link(PROPELLER, WATER, "stiffness_nm_rad = 1e6"))).links
    assert [item.is_rigid for item in links] == [True, True, False]


def test_shipped_line_is_whole():
    """Nineteen rows of the table, shaft and water: twenty links; four of them rigid; all of them assumed."""
    links = load_vessel("stan-tug-1205").links
    assert len(links) == 20
    assert sum(item.is_rigid for item in links) == 4
    assert {item.source for item in links} == {"assumed"}
    # steel shaft of 90 mm and 3 m: G pi d^4 / (32 L), in two halves
    halves = [item.stiffness_nm_rad for item in links if "Propeller shaft" in item.between]
    assert 1.0 / sum(1.0 / half for half in halves) == pytest.approx(80e9 * 3.14159 * 0.09**4 / 32.0 / 3.0, rel=2e-3)
