"""``shaftprint validate`` on the short recording of the demo: its staircase is new to a fit of its sines.

A saved fingerprint is validated in ``tests/docs``, as the page shows it.
"""

import re
import shutil
from dataclasses import replace

import pytest

from shaftprint.campaign import load_campaign
from shaftprint.catalogue import structure
from shaftprint.errors import FingerprintError
from shaftprint.fingerprint import read_fingerprint
from shaftprint.recording import read_recording
from shaftprint.signals import prepare_signals
from shaftprint.survey._validate import fingerprint_model
from shaftprint.vessel import load_vessel

GIVEN = ("--vessel", "stan-tug-1205", "--campaign", "short", "--no-progress")


@pytest.fixture(scope="module")
def signals(recording):
    with read_recording(recording) as opened:
        return prepare_signals(opened, load_vessel("stan-tug-1205"), load_campaign("short"))


@pytest.fixture(scope="module")
def fingerprint(demo):
    return read_fingerprint(demo[0] / "fingerprint.json")


@pytest.mark.slow
def test_identified_in_one_go_with_the_sets_of_the_thesis(run, recording):
    result = run("validate", recording, *GIVEN, "--starts", 20, "--thesis-sets", "--linear-torque")
    assert result.exit_code == 0, result.stderr
    heading = next(line for line in result.output.splitlines() if "right model" in line and "benchmark" in line)
    assert [name for name in ("GAUGE-CLOSED", "CL4", "OL1+OL5", "CL3", "OL1+OL4", "benchmark") if name in heading] == [
        "GAUGE-CLOSED",
        "CL4",
        "OL1+OL5",
        "CL3",
        "OL1+OL4",
        "benchmark",
    ]
    assert "linear in its speed" in result.output


@pytest.mark.slow
def test_a_failed_validation_is_said_in_words_and_exits_with_0(run, recording):
    # a governor that is three times too weak
    result = run("validate", recording, *GIVEN, "--starts", 20, "--hold", "K_i=1.0", "--hold", "K_p=1.0")
    assert result.exit_code == 0
    assert result.output.startswith("Validation: the linear model ")
    words = r"The linear validation fails: GAUGE-CLOSED misses more than 15 % of the motion in \d+ of 8 excerpts"
    assert re.search(words, result.output)


def test_a_record_that_is_not_there_ends_in_a_sentence(run, recording, demo):
    result = run("validate", recording, *GIVEN, "--fingerprint", demo[0], "--record", "C11")
    assert result.exit_code == 1
    assert "record C11: expected a chirp or staircase of campaign" in result.stderr


@pytest.mark.slow
def test_a_record_of_the_identification_is_refused(run, recording, demo):
    refused = run("validate", recording, *GIVEN, "--fingerprint", demo[0], "--record", "St1", "--used", "St1")
    assert refused.exit_code == 1
    assert "the model was identified from it, so that it proves nothing" in refused.stderr
    marked = run(
        "validate", recording, *GIVEN, "--fingerprint", demo[0], "--record", "St1", "--used", "St1", "--allow-in-sample"
    )
    assert marked.exit_code == 0
    assert "(identified from it)" in marked.output
    assert "Nothing is proved" in marked.output


def test_the_model_of_a_fingerprint(fingerprint, signals):
    model = fingerprint_model(fingerprint, structure("GAUGE-CLOSED"), signals)
    named = dict(zip(model.structure.names, model.values, strict=True))
    for quantity in fingerprint.parameters:
        assert named[quantity.name] == quantity.value
    stds = model.covariance.diagonal() ** 0.5
    assert stds == pytest.approx([fingerprint.quantity(p.name).std for p in model.structure.free])
    assert model.used == fingerprint.conditions.lines_used


def test_a_fingerprint_of_another_recording_has_seen_nothing_of_this_one(fingerprint, signals):
    other = replace(signals, recording_sha256="0" * 64)
    assert fingerprint_model(fingerprint, structure("GAUGE-CLOSED"), other).used == ()


def test_a_fingerprint_of_another_structure(fingerprint, signals):
    with pytest.raises(FingerprintError, match=r"expected the parameters of structure CL4, found a difference in"):
        fingerprint_model(fingerprint, structure("CL4"), signals)


def test_a_fingerprint_of_another_working_point(fingerprint, signals):
    point = replace(signals.working_point, engine_speed_rev_s=1.1 * signals.working_point.engine_speed_rev_s)
    with pytest.raises(FingerprintError, match=r"expected a recording around its working point of 118\d\.\d rpm"):
        fingerprint_model(fingerprint, structure("GAUGE-CLOSED"), replace(signals, working_point=point))


@pytest.mark.slow
def test_the_fmu_of_a_fingerprint_is_judged_as_the_fingerprint_is(run, recording, demo, tmp_path):
    """Without the square of the speed, which the linear FMU has not either."""
    pytest.importorskip("fmpy")
    if shutil.which("cc") is None:
        pytest.skip("there is no C compiler called cc")
    path = tmp_path / "yard.fmu"
    assert run("export", "fmu", demo[0], "--linear", "-o", path, "--no-progress").exit_code == 0
    by_fmu = run("validate", recording, *GIVEN, "--model", path)
    assert by_fmu.exit_code == 0, by_fmu.stderr
    own = run("validate", recording, *GIVEN, "--fingerprint", demo[0], "--linear", "--linear-torque")
    fit = re.compile(r"\b\d\d\.\d\b")
    assert "yard.fmu" in by_fmu.output
    assert len(fit.findall(own.output)) > 4
    assert fit.findall(by_fmu.output)[:4] == fit.findall(own.output)[:4]


def test_a_model_is_named_alone(run, recording, demo):
    for words, said in (
        (("--model-variable", "speed=w"), "name it too"),
        (("--model", "a.fmu", "--fingerprint", demo[0]), "leave those out"),
    ):
        result = run("validate", recording, *GIVEN, *words)
        assert result.exit_code == 2
        assert said in " ".join(result.stderr.split())
