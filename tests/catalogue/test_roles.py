"""Roles: what a parameter stands for is known in the catalogue, and nowhere by its name."""

import ast
from functools import cache
from pathlib import Path

import pytest

import shaftprint
from shaftprint.catalogue import STRUCTURES, ShipRole, limited, limited_governor, structure
from shaftprint.catalogue._limited_governor import GovernorSymbol
from shaftprint.catalogue._roles import ROLES
from shaftprint.catalogue._shipped import expect_roles
from shaftprint.errors import StructureError
from shaftprint.models import Gain, Parameter, Structure
from shaftprint.models._role import Role
from shaftprint.normalisation import Normalisation, inertia_time_s

SOURCE = Path(shaftprint.__file__).parent
LIMITS = ("torque", "rate", "deadband", "smoke", "ramp")
# Tables of printed values, whose rows are what the thesis and the demo print, and Greek letters.
PRINTED = {"report/thesis/_thesis_mode.py", "cli/_found.py"}
LETTERS = {"zeta", "kappa", "sigma"}
# The tug has names of its own truth, and shares nothing with what it tests.
HOMES = {"catalogue", "tug"}


@cache
def shipped_names():
    """Symbols of the catalogue's parameters; of one letter they cannot be told from a format or a unit."""
    structures = [*(build() for build in STRUCTURES.values()), limited(*LIMITS), limited_governor(*LIMITS)]
    return {p.name for one in structures for p in one.parameters if len(p.name) > 1} - LETTERS


@pytest.mark.parametrize(
    "path",
    [path for path in sorted(SOURCE.rglob("*.py")) if path.relative_to(SOURCE).parts[0] not in HOMES],
    ids=lambda path: path.relative_to(SOURCE).as_posix(),
)
def test_no_file_outside_the_catalogue_knows_a_parameter_by_its_name(path):
    if path.relative_to(SOURCE).as_posix() in PRINTED:
        pytest.skip("a table of printed values")
    strings = [
        (node.lineno, node.value)
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Constant) and isinstance(node.value, str)
    ]
    assert [place for place in strings if place[1] in shipped_names()] == []


def test_inertia_time_of_the_thesis():
    """Thesis eq. 5.1: 54 kg m2 on a shaft of 296 rpm with 1,650 N m are 1.015 s."""
    assert inertia_time_s(54.0, shaft_speed_rev_s=296.0 / 60.0, shaft_torque_nm=1650.0) == pytest.approx(
        1.0145, abs=1e-4
    )


@pytest.mark.parametrize(
    ("role", "unit", "value"),
    [
        # M_s0 / (2 pi n_s0) = 1600 / (2 pi 5) kg m2 for a second
        (ShipRole.INERTIA_DOWNSTREAM, "kg m2", 50.9296),
        (ShipRole.INERTIA_UPSTREAM, "kg m2", 50.9296),
        # M_s0 / n_e0 = 1600 N m / 1200 rpm
        (ShipRole.PROPORTIONAL_GAIN, "N m/rpm", 4.0 / 3.0),
        (ShipRole.INTEGRAL_GAIN, "N m/(rpm s)", 4.0 / 3.0),
    ],
)
def test_physical_form_of_one_normalised_unit(role, unit, value):
    point = Normalisation(engine_speed_rev_s=20.0, gear_ratio=4.0, shaft_torque_nm=1600.0)
    assert role.physical.unit == unit
    assert role.physical.scale(point) == pytest.approx(value, rel=1e-5)


def test_what_moves_with_the_working_point_is_not_of_the_line():
    moving = {name for name, role in ROLES.items() if not role.is_of_line and not role.of_sensor}
    assert moving == {
        "inertia", "inertia upstream", "inertia downstream", "proportional gain", "integral gain", "derivative gain",
        "engine slope with speed", "engine slope with rack", "load slope", "inflow slope",
        "inertia driven", "coupling stiffness", "coupling damping",
        "proportional gain of the engine's own torque", "integral gain of the engine's own torque",
    }  # fmt: skip


def test_every_parameter_of_the_gauge_aware_loop_but_a_filter_has_a_role():
    loop = structure("GAUGE-ECU")
    assert set(loop.names) - set(loop.roles) == {"T_filter"}
    assert loop.named_as(ShipRole.LOOP_DELAY) == "t_d"
    assert loop.named_as(ShipRole.INFLOW_SLOPE) is None


def test_a_tied_parameter_keeps_its_role():
    reset = Parameter("T_i", "s", 0.1, 10.0, 1.0, "reset time")
    tied = structure("CL4").tied("K_i", lambda K_p, T_i: K_p / T_i, reset)
    assert tied.roles["K_i"] == ShipRole.INTEGRAL_GAIN
    assert tied.combinations[0].role == ShipRole.INTEGRAL_GAIN


def test_a_role_has_its_unit():
    with pytest.raises(StructureError, match=r"J: expected the unit s of the role inertia upstream, found kg m2"):
        Parameter("J", "kg m2", 0.0, 5.0, 1.0, "inertia", role=ShipRole.INERTIA_UPSTREAM)
    with pytest.raises(StructureError, match=r"expected a role such as ShipRole\.LOOP_DELAY, found 'delay'"):
        Parameter("t", "s", 0.0, 5.0, 1.0, "delay", role="delay")


def test_two_parameters_of_one_role_are_refused():
    one, two = (Parameter(name, "-", 0.0, 5.0, 1.0, "gain", role=ShipRole.PROPORTIONAL_GAIN) for name in ("K", "L"))
    with pytest.raises(StructureError, match="one parameter of the role proportional gain, found K and L"):
        Structure(name="TWICE", title="two gains", input="e", outputs={"X": Gain(one) * Gain(two)})


def test_a_parameter_of_the_ship_without_a_role_is_named():
    """K_p without unit is the ship's governor gain; in V s/rad it is that of somebody's motor."""
    gain = Parameter("K_p", "-", 0.0, 5.0, 1.0, "gain")
    ship = Structure(name="MINE", title="a gain", input="e", outputs={"X": Gain(gain)})
    with pytest.raises(
        StructureError, match=r"MINE: parameter K_p .* role=ShipRole\.PROPORTIONAL_GAIN, or another name"
    ):
        expect_roles(ship)
    motor = Parameter("K_p", "V s/rad", 0.0, 5.0, 1.0, "gain")
    expect_roles(Structure(name="MOTOR", title="a gain", input="e", outputs={"u": Gain(motor)}))


def test_a_role_of_ones_own_is_a_role():
    hoist = Role(name="rope tension", unit="N")
    assert Parameter("F", "N", 0.0, 5.0, 1.0, "tension of the rope", role=hoist).role.is_of_line


def test_symbols_are_parameters_of_the_limited_governor():
    names = set(limited_governor(*LIMITS).names)
    assert {value for name, value in vars(GovernorSymbol).items() if name.isupper()} <= names
