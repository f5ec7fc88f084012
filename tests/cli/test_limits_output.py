"""The line with its limits from one command to export: the short demo, whose torque limits are known."""

import json

import numpy as np
import pytest
from tests.cli.readable_tables import expect_all_readable, printed_tables

from shaftprint.errors import ShaftprintError
from shaftprint.export import exported_model
from shaftprint.fingerprint import read_fingerprint
from shaftprint.survey._line_with_limits import expect_limitable
from shaftprint.vessel import load_vessel

# what is asked of one recording takes some minutes of a processor
pytestmark = pytest.mark.long
TRIAL = ("--vessel", "stan-tug-1205", "--campaign", "short", "--no-progress")
ANTI_WINDUP_S, MOTORING_NM = 0.5, -300.0
GOVERNOR = {"K_p": 5.7, "K_i": 4.27, "t_d": 0.0703, "t_sp": 0.0518}


@pytest.fixture(scope="module")
def result(invoke, recording, tmp_path_factory):
    """The folder, the output and the tables of ``limits``, which takes a minute."""
    folder = tmp_path_factory.mktemp("limits") / "result"
    with printed_tables() as printed:
        found = invoke("limits", recording, *TRIAL, "-o", folder)
    assert found.exit_code == 0, found.output
    return folder, found.output, printed(found.stdout)


@pytest.fixture(scope="module")
def fingerprint(result):
    return read_fingerprint(result[0] / "fingerprint.json")


def test_the_levels_of_the_model_are_the_true_ones(fingerprint):
    vessel = load_vessel("stan-tug-1205")
    point = fingerprint.conditions
    brake_nm = point.shaft_torque.value / (vessel.gearbox.ratio * vessel.gearbox.efficiency)
    full_nm = np.interp(point.engine_speed.value, vessel.engine.full_load_speed_rpm, vessel.engine.full_load_torque_nm)
    expected = {"m_max": full_nm / brake_nm, "m_min": MOTORING_NM / brake_nm, "T_aw": ANTI_WINDUP_S}
    line = fingerprint.with_limits
    assert line.limits == ("torque",)
    found = {quantity.name: quantity for quantity in line.parameters}
    for name, value in expected.items():
        assert abs(found[name].value - value) < 3.0 * found[name].std
    assert found["m_max"].std < 0.06 * expected["m_max"]
    for name, value in GOVERNOR.items():
        assert abs(found[name].value - value) < 3.0 * found[name].std, name


def test_it_says_what_was_found_and_what_was_not(result):
    output = result[1]
    assert (
        output.index("Limits\n") < output.index("Numbers of the limits") < output.index("Governor that goes with them")
    )
    assert "rate limit of the fuel rack: not seen" in output
    assert "deadband: not seen" in output


def test_each_stretch_was_judged_by_limits_that_had_not_seen_it(result, fingerprint):
    page = (result[0] / "index.html").read_text(encoding="utf-8")
    record = fingerprint.validation
    assert record.model == "GAUGE-TORQUE"
    assert record.outcome != "fails"
    # of the one step of 2 V nothing else tells the limit
    assert "not judged, because the rest does not show the" in page
    assert not any("-5 to -3 V" in one.title for one in record.stretches)
    assert any("-4 to -5 V" in one.title for one in record.stretches)


def test_exports_take_the_line_with_its_limits(invoke, result, tmp_path):
    folder = tmp_path / "result"
    folder.mkdir()
    content = json.loads((result[0] / "fingerprint.json").read_text(encoding="utf-8"))
    # with its limit the line does what the test showed
    assert content["validation"]["outcome"] == "passes"
    content["validation"]["outcome"] = "undecided"
    (folder / "fingerprint.json").write_text(json.dumps(content), encoding="utf-8")
    for options, has_limits in (((), True), (("--linear",), False)):
        for suffix, name in (("mo", "modelica"), ("ssv", "ssp")):
            path = tmp_path / f"tug{has_limits}.{suffix}"
            written = invoke("export", name, folder, "-o", path, *options)
            assert written.exit_code == 0, written.output
            assert ("m_max" in path.read_text(encoding="utf-8")) is has_limits
            # what noise hides is said beside the model that was validated, not beside another
            assert ("noise is too large to tell" in path.read_text(encoding="utf-8")) is has_limits
    path = tmp_path / "tug.json"
    assert invoke("export", "json", folder, "-o", path).exit_code == 0
    content = json.loads(path.read_text(encoding="utf-8"))
    assert content["validation"]["outcome"] == "undecided"
    assert content["with_limits"]["limits"] == ["torque"]
    assert {"M_max", "share"} <= {row["name"] for row in content["numbers"] if row["kind"] == "limit"}


def test_the_model_of_the_library_is_the_same(result, fingerprint):
    model = exported_model(fingerprint)
    assert model.structure.name == "GAUGE-TORQUE"
    assert {"K_p", "m_max", "T_aw"} <= set(model.uncertain)
    assert np.linalg.eigvalsh(model.covariance).min() > 0.0
    assert exported_model(fingerprint, linear=True).structure.name == "GAUGE-CLOSED"


def test_its_tables_are_readable(result):
    expect_all_readable(result[2])


@pytest.mark.long
def test_validate_and_simulate_take_it_too(invoke, result, recording, tmp_path):
    folder = result[0]
    validated = invoke("validate", recording, *TRIAL, "--fingerprint", folder)
    assert validated.exit_code == 0, validated.output
    assert "GAUGE-TORQUE" in validated.output
    linear = invoke("validate", recording, *TRIAL, "--fingerprint", folder, "--linear")
    assert "The linear validation fails: GAUGE-CLOSED" in linear.output
    drive = ("--campaign", "short", "--between", "0", "30", "-o")
    for option, name in (((), "GAUGE-TORQUE"), (("--linear",), "GAUGE-CLOSED")):
        path = tmp_path / f"{name}.csv"
        simulated = invoke("simulate", "--fingerprint", folder, *drive, path, *option, "--no-progress")
        assert simulated.exit_code == 0, simulated.output
        assert name in simulated.output


def test_limits_of_another_structure_end_in_a_sentence(fingerprint):
    other = fingerprint.model_copy(update={"held": fingerprint.held | {"kappa": 0.0}})
    with pytest.raises(ShaftprintError, match="expected the parameters of GAUGE-CLOSED"):
        expect_limitable(other)
