"""``shaftprint identify`` with its options; without any it is run in ``tests/docs``, as the pages show it."""

import shutil

import pytest

from shaftprint.fingerprint import read_fingerprint
from shaftprint.recording import read_recording, write_csv

GIVEN = ("--vessel", "stan-tug-1205", "--campaign", "short", "--no-progress")


@pytest.mark.slow
def test_same_seed_same_fingerprint(run, recording, tmp_path):
    for name in ("a", "b"):
        run("identify", recording, *GIVEN, "--structure", "CL4", "--seed", 5, "-o", tmp_path / name)
    first, second = (read_fingerprint(tmp_path / name / "fingerprint.json") for name in ("a", "b"))
    assert first.model_copy(update={"created": second.created}) == second


@pytest.mark.slow
def test_structures_beside_each_other(run, recording, tmp_path):
    names = ("OL1", "CL4", "ol1")
    options = [word for name in names for word in ("--structure", name)]
    result = run("identify", recording, *GIVEN, *options, "--starts", 20, "-o", tmp_path / "out")
    assert result.exit_code == 0
    table = result.output[result.output.index("All structures") :]
    assert table.count("OL1") == 1
    assert "CL4" in table
    assert "20/20" in table
    assert read_fingerprint(tmp_path / "out" / "fingerprint.json").structure == "OL1"


@pytest.mark.slow
def test_hold_and_prior(run, recording, tmp_path):
    options = ("--hold", "tau_up=1.016", "--prior", "g=-0.1+-0.05", "--prior", "k_q=2+-0.01", "--free", "t_gauge")
    result = run("identify", recording, *GIVEN, *options, "-o", tmp_path / "out")
    assert result.exit_code == 0
    found = read_fingerprint(tmp_path / "out" / "fingerprint.json")
    assert found.held["tau_up"] == 1.016
    assert [source.name for source in found.sources] == ["recording.nc", "stan-tug-1205", "short"]
    assert {name: (prior.mean, prior.std) for name, prior in found.priors.items()} == {
        "g": (-0.1, 0.05),
        "k_q": (2.0, 0.01),
    }


@pytest.mark.slow
def test_the_way_of_the_thesis(run, recording, tmp_path):
    options = ("--mode", "thesis", "--unweighted", "--structure", "OL1")
    result = run("identify", recording, *GIVEN, *options, "-o", tmp_path / "out")
    # a single lag with the numbers of the thesis explains no speed: nothing may be used, and all is written
    assert result.exit_code == 3
    found = read_fingerprint(tmp_path / "out" / "fingerprint.json")
    assert found.conditions.mode == "thesis"
    assert found.quality.weighting == "Unweighted"
    assert found.priors == {}
    # one revolution of the engine, 50.7 ms, is taken for inertia: more than the true 0.317 s
    assert 0.37 < found.quantity("tau_n").value < 0.47


@pytest.mark.slow
def test_recording_of_another_format(run, recording, tmp_path):
    path = tmp_path / "short.csv"
    with read_recording(recording) as opened:
        write_csv(path, opened.channels.values())
    result = run("identify", path, *GIVEN, "--structure", "OL1", "-o", tmp_path / "out")
    assert result.exit_code == 0, result.stderr
    found = read_fingerprint(tmp_path / "out" / "fingerprint.json")
    assert found.quantity("tau_n").value == pytest.approx(0.3172, rel=0.02)


@pytest.mark.parametrize(
    ("options", "code", "message"),
    [
        (("--structure", "CL9"), 1, "there is no structure 'CL9'; the shipped ones are OL1"),
        (("--hold", "mass=1"), 1, "--hold mass: expected a parameter of GAUGE-CLOSED"),
        (("--free", "mass"), 1, "--free mass: expected a free parameter, one of K_i, K_p"),
        (("--prior", "mass=1+-1"), 1, "prior of mass: structure GAUGE-CLOSED has the free parameters K_p"),
        (("--hold", "k_q=2", "--prior", "k_q=2+-1"), 1, "prior of k_q"),
        (("--hold", "v"), 2, "expected a parameter and its value such as v=1, found 'v'"),
        (("--prior", "g=0"), 2, "its standard deviation such as g=0+-0.1, found 'g=0'"),
        (("--starts", "0"), 2, "0 is not in the range x>=1"),
        (("--mode", "guess"), 2, "'guess' is not one of 'shaftprint', 'thesis'"),
        (("--tested-at", "yesterday"), 2, "'yesterday' does not match the format"),
        (("--previous", "2025"), 1, "2025: expected a fingerprint in JSON"),
        (("--colour", "red"), 2, "No such option '--colour'"),
        (("--campaign", "thesis"), 1, "found a recording from 0.0 to 860.0 s"),
        (("--campaign", "trip.toml"), 1, "trip.toml: expected a settings file, found nothing there"),
        (
            ("--vessel", "tor"),
            1,
            "one of the shipped names e-ferry-ellen, foss-carolyn-dorothy, nifs-research-vessel, "
            "nifs-research-vessel-combinator, pt-may, "
            "pt-may-underway, stan-tug-1205",
        ),
    ],
)
def test_wrong_input_leaves_nothing_behind(run, recording, tmp_path, options, code, message):
    result = run("identify", recording, *GIVEN, *options, "-o", tmp_path / "out")
    assert result.exit_code == code
    assert message in result.stderr
    assert "Traceback" not in result.output
    assert list(tmp_path.iterdir()) == []


def test_a_mistake_in_a_settings_file_makes_no_folder_on_the_way(run, recording, tmp_path):
    result = run("identify", recording, *GIVEN, "--vessel", "tor", "-o", tmp_path / "tests" / "out")
    assert result.exit_code == 1
    assert list(tmp_path.iterdir()) == []


def test_missing_recording(run, tmp_path):
    result = run("identify", tmp_path / "test.nc", *GIVEN, "-o", tmp_path / "out")
    assert result.exit_code == 1
    assert result.stderr == f"Error: {tmp_path / 'test.nc'}: expected a logger file, found none there.\n"


def test_missing_options_are_usage_errors(run, recording):
    result = run("identify", recording, "--vessel", "stan-tug-1205", "-o", "out")
    assert result.exit_code == 2
    assert "Missing option '--campaign'" in result.stderr


def test_folder_of_others_is_refused_before_any_work(run, recording, tmp_path):
    (tmp_path / "mine.txt").write_text("mine")
    result = run("identify", recording, *GIVEN, "-o", tmp_path)
    assert result.exit_code == 1
    assert "expected an empty folder or one with results of shaftprint identify, found mine.txt" in result.stderr


def test_place_below_a_file(run, recording, tmp_path):
    (tmp_path / "mine.txt").write_text("mine")
    result = run("identify", recording, *GIVEN, "-o", tmp_path / "mine.txt" / "out")
    assert result.exit_code == 1
    assert "check the path, the permissions and the free space" in result.stderr


@pytest.fixture(scope="module")
def whole(invoke, recording, tmp_path_factory):
    """The output and the folder of a command with all that it makes where nothing is said."""
    folder = tmp_path_factory.mktemp("whole") / "out"
    result = invoke("identify", recording, *GIVEN, "-v", "-o", folder)
    assert result.exit_code == 0
    return result.output, folder


@pytest.mark.slow
def test_the_answer_is_printed_before_the_model_is_judged_and_the_report_is_drawn(whole):
    output, _ = whole
    judging, drawing = "Holding the model against records that it has not seen ...", "Writing the report ..."
    order = [output.index(words) for words in ("Verdict", "GAUGE-CLOSED", judging, drawing, "Report:  ")]
    assert order == sorted(order)


@pytest.mark.slow
def test_a_fingerprint_alone_is_written_without_page_and_takes_the_place_of_one_with(run, recording, whole, tmp_path):
    shutil.copytree(whole[1], tmp_path / "out")
    assert (tmp_path / "out" / "index.html").exists()
    whole = read_fingerprint(tmp_path / "out" / "fingerprint.json")
    alone = run("identify", recording, *GIVEN, "--no-report", "-o", tmp_path / "out")
    assert alone.exit_code == 0, alone.stderr
    assert "Report:" not in alone.output
    # the answer alone: tables are printed by -v and show
    assert len(alone.output.splitlines()) <= 45
    assert "What was found" in alone.output
    assert "Uncertainty budget" not in alone.output
    assert "Uncertainty budget" in run("show", tmp_path / "out").output
    shown = [path.name for path in (tmp_path / "out").iterdir() if not path.name.startswith(".")]
    assert shown == ["fingerprint.json"]
    fingerprint = read_fingerprint(tmp_path / "out" / "fingerprint.json")
    assert fingerprint.validation is None
    assert fingerprint.parameters == whole.parameters
    assert run("show", tmp_path / "out").exit_code == 0


def test_a_fingerprint_alone_has_no_pictures(run, recording, tmp_path):
    result = run(
        "identify",
        recording,
        "--vessel",
        "stan-tug-1205",
        "--campaign",
        "short",
        "--no-report",
        "--figures",
        "-o",
        tmp_path / "o",
    )
    assert result.exit_code == 2
    assert "--no-report goes with neither --figures nor --pdf" in " ".join(result.stderr.split())
