"""Files of every schema are read: what an earlier one lacks is empty, what a later one adds is left out and said."""

import json

import numpy as np
import pytest

from shaftprint.errors import FingerprintError
from shaftprint.fingerprint import read_fingerprint, write_fingerprint
from shaftprint.fingerprint._leg_records import LegRecord, NoiseSpectrum, noise_spectra
from shaftprint.identify import NoiseLevels

LEGS = (
    LegRecord(
        name="M1", engine_speed_rpm=1361.4, shaft_torque_nm=2281.4, set_point_v=-5.7, load=1.0, periods=10,
        period_s=33.77, p_value=0.42,
    ),
    LegRecord(
        name="M2", engine_speed_rpm=923.4, shaft_torque_nm=1049.5, set_point_v=-3.96, load=1.003, periods=10,
        period_s=33.77,
    ),
)  # fmt: skip
# Hermitian, positive definite: eigenvalues 2 +/- |1 + 0.5 j| and 3 +/- 1
LEVELS = NoiseLevels(
    frequency_hz=np.array([0.1, 1.0 / 3.0]),
    density=1e-6 * np.array([[[2.0, 1.0 + 0.5j], [1.0 - 0.5j, 2.0]], [[3.0, 1.0j], [-1.0j, 3.0]]]),
    outputs=("n", "M_s"),
    set_point_per_v=0.184,
    orders_hz=(5.94, 17.8),
)


@pytest.fixture
def path(tmp_path):
    return tmp_path / "fingerprint.json"


@pytest.fixture(scope="module")
def of_legs(fingerprint):
    return fingerprint.model_copy(
        update={"legs": LEGS, "noise": noise_spectra({1361.4: LEVELS}), "torque_ripple": 0.51}
    )


WATER = ("draught_m", "trim_m", "water_temperature_c", "water_density_kg_m3", "depth_m", "wind_m_s")


def before_2_2(content):
    """Take out what schema 2.2 has added."""
    del content["joint"]
    for name in ("ship", *WATER):
        del content["conditions"][name]


def without_joint(fingerprint):
    return fingerprint.model_copy(update={"joint": None})


def write_changed(fingerprint, path, change):
    content = json.loads(fingerprint.model_dump_json())
    change(content)
    path.write_text(json.dumps(content), encoding="utf-8")


def test_file_without_ripple_is_read(of_legs, path):
    write_changed(of_legs, path, lambda content: content.pop("torque_ripple"))
    assert read_fingerprint(path).torque_ripple is None


def test_legs_and_noise_come_back_as_they_were(of_legs, path):
    write_fingerprint(of_legs, path)
    kept = read_fingerprint(path)
    assert kept == of_legs
    assert [(leg.name, leg.p_value) for leg in kept.legs] == [("M1", 0.42), ("M2", None)]
    ((speed, levels),) = kept.noise_at_speeds.items()
    assert speed == 1361.4
    assert (levels.outputs, levels.orders_hz) == (("n", "M_s"), (5.94, 17.8))
    assert np.array_equal(levels.density, LEVELS.density)
    assert np.array_equal(levels.at([0.2]), LEVELS.at([0.2]))
    content = json.loads(path.read_text(encoding="utf-8"))
    assert content["schema_version"] == "2.2"
    assert content["torque_ripple"] == 0.51
    assert content["noise"][0]["density_imaginary"][0] == [[0.0, 5e-7], [-5e-7, 0.0]]


def test_a_file_of_schema_1_is_read(fingerprint, path):
    def as_schema_1(content):
        del content["legs"], content["noise"], content["with_limits"], content["validation"]
        before_2_2(content)
        content["schema_version"] = 1

    write_changed(fingerprint, path, as_schema_1)
    kept = read_fingerprint(path)
    assert kept == without_joint(fingerprint)
    assert (kept.legs, kept.noise) == ((), ())


def test_a_file_of_schema_2_0_is_read(of_legs, path):
    def as_schema_2_0(content):
        del content["with_limits"], content["validation"]
        before_2_2(content)
        content["schema_version"] = "2.0"

    write_changed(of_legs, path, as_schema_2_0)
    assert read_fingerprint(path) == without_joint(of_legs)


def test_a_file_of_schema_2_0_with_limits_is_refused(of_legs, path):
    def as_schema_2_0(content):
        before_2_2(content)
        content["schema_version"] = "2.0"

    write_changed(of_legs, path, as_schema_2_0)
    with pytest.raises(FingerprintError, match=r"with_limits: expected no such field in schema 2\.0"):
        read_fingerprint(path)


def test_a_file_of_schema_2_1_is_read(of_legs, path):
    def as_schema_2_1(content):
        before_2_2(content)
        content["schema_version"] = "2.1"

    write_changed(of_legs, path, as_schema_2_1)
    assert read_fingerprint(path) == without_joint(of_legs)


@pytest.mark.parametrize("name", ["ship", "depth_m"])
def test_a_file_of_schema_2_1_with_conditions_of_2_2_is_refused(of_legs, path, name):
    def spoil(content):
        before_2_2(content)
        content["conditions"][name] = None
        content["schema_version"] = "2.1"

    write_changed(of_legs, path, spoil)
    with pytest.raises(FingerprintError, match=rf"conditions\.{name}: expected no such field in schema 2\.1"):
        read_fingerprint(path)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"depth_m": "NaN"}, r"conditions\.depth_m: Input should be a finite number"),
        ({"ship": {"name": "A", "line": "port", "imo_number": 9074728}}, "expected an IMO number, seven digits"),
        ({"ship": {"name": "A" * 101, "line": "port"}}, r"conditions\.ship\.name: String should have at most 100"),
        ({"ship": {"name": "A"}}, r"conditions\.ship\.line: Field required"),
    ],
)
def test_conditions_that_cannot_be_are_refused(of_legs, path, change, message):
    write_changed(of_legs, path, lambda content: content["conditions"].update(change))
    with pytest.raises(FingerprintError, match=message):
        read_fingerprint(path)


def test_a_file_of_schema_1_with_an_unknown_field_is_refused(fingerprint, path):
    write_changed(fingerprint, path, lambda content: content.update(schema_version=1, colour="red"))
    with pytest.raises(FingerprintError, match=r"colour: Extra inputs"):
        read_fingerprint(path)


def test_every_later_2_is_read_and_says_what_it_left_out(of_legs, path):
    def as_later(content):
        content.update(schema_version="2.7", hull={"fouling": 0.1})
        content["legs"][1]["orders"] = [1, 2]
        content["noise"][0]["shaft_orders"] = {"1": 0.01}
        content["parameters"][0]["drift"] = None

    write_changed(of_legs, path, as_later)
    kept = read_fingerprint(path)
    assert kept.model_copy(update={"findings": of_legs.findings}) == of_legs
    (finding,) = kept.findings[len(of_legs.findings) :]
    assert finding.startswith("The file is of schema 2.7; what is not known in 2.2 was left out: ")
    for name in ("hull", "legs.1.orders", "noise.0.shaft_orders", "parameters.0.drift"):
        assert name in finding
    # nothing new: nothing to say
    write_changed(of_legs, path, lambda content: content.update(schema_version="2.3"))
    assert read_fingerprint(path) == of_legs


def test_a_later_2_with_wrong_fields_is_refused(of_legs, path):
    def spoil(content):
        content.update(schema_version="2.7", hull={})
        content["legs"][0]["periods"] = -1

    write_changed(of_legs, path, spoil)
    with pytest.raises(FingerprintError, match=r"legs\.0\.periods: Input should be greater than 0"):
        read_fingerprint(path)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda noise: noise["density_real"].pop(), r"noise\.0: expected densities of shape \(2, 2, 2\)"),
        (lambda noise: noise["density_real"][1][0].pop(), "expected densities of shape"),
        (lambda noise: noise["frequency_hz"].reverse(), "positive, ascending frequencies"),
        (lambda noise: noise["density_real"][0][0].__setitem__(0, -1.0), "Hermitian, positive definite density"),
        (lambda noise: noise["density_real"][0][0].__setitem__(0, "NaN"), "should be a finite number"),
        (lambda noise: noise.update(set_point_per_v=0.0), "set_point_per_v: Input should be greater than 0"),
        (lambda noise: noise.update(outputs=[]), "expected densities of shape"),
        (lambda noise: noise.update(orders_hz=[-1.0]), r"orders_hz\.0: Input should be greater than 0"),
    ],
)
def test_a_spectrum_that_is_none_is_refused(of_legs, path, change, message):
    write_changed(of_legs, path, lambda content: change(content["noise"][0]))
    with pytest.raises(FingerprintError, match=message):
        read_fingerprint(path)


def test_what_is_measured_of_noise_may_not_be_changed():
    spectrum = NoiseSpectrum.model_validate(noise_spectra({1000.0: LEVELS})[0].model_dump())
    with pytest.raises(ValueError, match="frozen"):
        spectrum.engine_speed_rpm = 2.0


def _first_row(joint, value):
    joint["own_covariance"][0][0] = value


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        (lambda joint: joint["names"].__setitem__(0, "\x1b[31mred"), r"joint: expected names of its numbers, found"),
        (lambda joint: joint["names"].__setitem__(0, joint["names"][1]), r"expected each name once"),
        (lambda joint: joint["own_covariance"].pop(), r"own_covariance: expected 9 rows of 9"),
        (lambda joint: _first_row(joint, "NaN"), r"own_covariance: expected finite numbers"),
        (lambda joint: _first_row(joint, "Infinity"), r"own_covariance: expected finite numbers"),
        (lambda joint: _first_row(joint, -1.0), r"own_covariance: expected"),
        (lambda joint: joint["loadings"].update(TVC=[1.0]), r"loadings of 'TVC': expected 9 finite numbers"),
        (lambda joint: joint["loadings"].update({"prior of g": ["NaN"] * 9}), r"loadings of 'prior of g': expected 9"),
    ],
)
def test_a_joint_covariance_that_cannot_be_is_refused(of_legs, path, spoil, message):
    write_changed(of_legs, path, lambda content: spoil(content["joint"]))
    with pytest.raises(FingerprintError, match=message):
        read_fingerprint(path)


def test_the_joint_covariance_adds_up_to_what_each_number_is_known_to(fingerprint):
    """The test's own part and the squares of what was stated beforehand are the variance of the budget."""
    joint = fingerprint.joint
    own = np.diag(np.array(joint.own_covariance))
    stated = sum(np.array(change) ** 2 for change in joint.loadings.values())
    for name, variance in zip(joint.names, own + stated, strict=True):
        assert variance == pytest.approx(fingerprint.quantity(name).std ** 2, rel=1e-9), name


def test_the_scale_of_the_gauge_moves_torques_in_newton_metres_alike(fingerprint, vessel):
    """I_dn and K_Q are made of the torque that the gauge shows: two per cent of scale are two per cent of each."""
    scale = vessel.sensors.shaft_torque.scale_std_fraction
    moved = dict(zip(fingerprint.joint.names, fingerprint.joint.loadings["gauge scale"], strict=True))
    for name in ("I_dn", "K_Q"):
        assert moved[name] == pytest.approx(scale * fingerprint.quantity(name).value, rel=1e-6)
    assert moved["t_d"] == pytest.approx(0.0, abs=1e-3)
