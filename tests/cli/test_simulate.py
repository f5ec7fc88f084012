"""``shaftprint simulate``: its numbers against closed forms, ``simulate_exactly``, and those of the fingerprint."""

import csv
import json
import math

import numpy as np
import pytest

from shaftprint.campaign import load_campaign, setpoint
from shaftprint.catalogue import limited, structure
from shaftprint.simulation import simulate, simulate_exactly

OWN = """
from shaftprint.models import FirstOrderLag, Gain, Parameter, Structure

K = Parameter("K", "-", 0.0, 10.0, 1.0, "gain")
T = Parameter("T", "s", 0.01, 10.0, 1.0, "time constant")
lag = Structure(name="LAG", title="a lag", input="u", outputs={"y": Gain(K) * FirstOrderLag(T)})
"""
SPEED_RPM, TORQUE_NM = 1183.8, 1725.0
PLAIN = ("--set", "k_q=2", "--set", "g=0", "--no-progress")


def columns(path):
    """Return the columns of a CSV file by their titles."""
    with path.open(encoding="utf-8") as file:
        titles, *rows = csv.reader(file)
    return dict(zip(titles, np.array(rows, dtype=float).T, strict=True))


def table(path, titles, *values):
    """Write columns as CSV."""
    np.savetxt(path, np.column_stack(values), delimiter=",", header=",".join(titles), comments="", fmt="%.12g")
    return path


@pytest.fixture
def here(tmp_path, monkeypatch):
    """A working folder with a structure of one's own in it."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "own.py").write_text(OWN)
    return tmp_path


def fingerprint(demo):
    """The fingerprint of the demo, as plain data."""
    return json.loads((demo[0] / "fingerprint.json").read_text(encoding="utf-8"))


def quantity(found, kind, name):
    return next(entry for entry in found[kind] if entry["name"] == name)


@pytest.mark.slow
def test_a_step_of_a_lag_by_hand(run, here):
    time = np.arange(0.0, 4.0, 0.01)
    table(here / "u.csv", ("time [s]", "u [V]"), time, np.where(time >= 0.995, 3.0, 1.0))
    result = run(
        "simulate", "--structure", "own.py:lag", "--set", "K=2", "--set", "T=0.5", "--input", "u.csv", "--hold",
        "-o", "y.csv",
    )  # fmt: skip
    assert result.exit_code == 0, result.stderr
    found = columns(here / "y.csv")
    assert list(found) == ["time [s]", "u [V]", "y []"]
    # steady at 2 times 1, then 4 more with the time constant of 0.5 s
    since = np.maximum(time - 1.0, 0.0)
    np.testing.assert_allclose(found["y []"], 2.0 + 4.0 * (1.0 - np.exp(-since / 0.5)), atol=1e-6)
    assert "LAG: a lag" in result.output
    assert result.output.endswith("y.csv\n")


LATE = """
from shaftprint.models import Delay, Gain, Integrator, Parameter, Sensitivity, Structure

k = Parameter("k", "1/s", 0.0, 5.0, 1.0, "gain")
inside = Parameter("d_in", "s", 0.0, 3.0, 0.3, "delay inside the loop")
outside = Parameter("d_out", "s", 0.0, 3.0, 0.1, "delay before the loop")
loop = Integrator() * Gain(k) * Delay(inside)
late = Structure(
    name="LATE", title="delayed feedback", input="u", outputs={"x": Delay(outside) * (Integrator() * Sensitivity(loop))}
)
"""


@pytest.mark.slow
@pytest.mark.parametrize("rows_a_second", [1000, 200, 100, 20])
def test_held_values_are_exact_however_far_apart_the_rows(run, here, rows_a_second):
    """Delays that are no multiple of rows or steps, in a loop and before it, by the method of steps."""
    (here / "late.py").write_text(LATE)
    k, inside, outside = 1.5, 0.1234567, 0.0712345
    time = np.arange(0.0, 3.0, 1.0 / rows_a_second)
    table(here / "u.csv", ("time [s]", "u [V]"), time, np.where(time > 0.999, 1.0, 0.0))
    result = run(
        "simulate", "--structure", "late.py:late", "--set", f"k={k}", "--set", f"d_in={inside}",
        "--set", f"d_out={outside}", "--input", "u.csv", "--hold", "-o", "x.csv", "--no-progress",
    )  # fmt: skip
    assert result.exit_code == 0, result.stderr
    found = columns(here / "x.csv")
    since = found["time [s]"] - 1.0 - outside
    # dx/dt = u(t - d_out) - k x(t - d_in)
    terms = [
        (-k) ** j * np.maximum(since - j * inside, 0.0) ** (j + 1) / math.factorial(j + 1)
        for j in range(int(2.0 / inside) + 1)
    ]
    np.testing.assert_allclose(found["x []"], np.sum(terms, axis=0), atol=1e-6)
    assert "early or late" not in result.output


def test_the_step_of_the_governed_line_does_not_hang_on_the_rows(run, here):
    """A step of 50 rpm at 10 ms rows was 0.3 rpm off what it was at 1 ms rows."""
    found = {}
    for rows in (100, 1000):
        time = np.arange(0.0, 8.0, 1.0 / rows)
        table(here / "set.csv", ("time [s]", "set point [rpm]"), time, SPEED_RPM + 50.0 * (time > 0.999))
        result = run(
            "simulate", "--structure", "GAUGE-CLOSED", *PLAIN, "--vessel", "stan-tug-1205", "--input", "set.csv",
            "--hold", "-o", f"out{rows}.csv",
        )  # fmt: skip
        assert result.exit_code == 0, result.stderr
        found[rows] = columns(here / f"out{rows}.csv")
    fine = {name: values[::10] for name, values in found[1000].items()}
    np.testing.assert_allclose(found[100]["engine speed [rpm]"], fine["engine speed [rpm]"], atol=50.0 * 1e-6)
    np.testing.assert_allclose(found[100]["shaft torque [N m]"], fine["shaft torque [N m]"], atol=TORQUE_NM * 1e-6)


def test_held_values_that_cannot_be_followed_are_said_to_be_near(run, here, monkeypatch):
    monkeypatch.setattr("shaftprint.simulation._exact_grid.MOST_JUMPS", 3)
    time = np.arange(0.0, 2.0, 0.01)
    table(here / "u.csv", ("time [s]", "u [V]"), time, time)
    result = run("simulate", "--structure", "own.py:lag", "--input", "u.csv", "--hold", "-o", "y.csv", "--no-progress")
    assert result.exit_code == 0, result.stderr
    said = " ".join(result.output.split())
    assert "Outputs may be up to 2.5 ms early or late where a held value jumps: exact steps: expected inputs" in said


def test_straight_inputs_between_samples(run, here):
    time = np.arange(0.0, 10.0, 0.1)
    table(here / "u.csv", ("time [s]", "u [V]"), time, time)
    result = run(
        "simulate", "--structure", "own.py:lag", "--set", "T=0.5", "--input", "u.csv", "--between", 2.0, 8.0,
        "-o", "y.csv",
    )  # fmt: skip
    assert result.exit_code == 0, result.stderr
    found = columns(here / "y.csv")
    assert found["time [s]"][[0, -1]].tolist() == [2.0, 8.0]
    # a ramp from steady running stays behind by T once it has settled
    since = found["time [s]"] - 2.0
    np.testing.assert_allclose(found["y []"], 2.0 + since - 0.5 * (1.0 - np.exp(-since / 0.5)), atol=1e-6)


def test_a_ship_at_its_torque_limit_turns_as_fast_as_the_limit_allows(run, here):
    time = np.arange(0.0, 60.0, 0.05)
    table(here / "set.csv", ("time [s]", "set point [rpm]"), time, np.where(time < 5.0, 1.0, 1.5) * SPEED_RPM)
    result = run(
        "simulate", "--structure", "gauge-torque", "--set", "m_max=1.44", *PLAIN, "--vessel", "stan-tug-1205",
        "--input", "set.csv", "-o", "out.csv",
    )  # fmt: skip
    assert result.exit_code == 0, result.stderr
    found = columns(here / "out.csv")
    # 1.44 times the torque turns the propeller 1.2 times as fast
    assert found["engine speed [rpm]"][[0, -1]] == pytest.approx([SPEED_RPM, 1.2 * SPEED_RPM], rel=1e-6)
    assert found["shaft torque [N m]"][[0, -1]] == pytest.approx([TORQUE_NM, 1.44 * TORQUE_NM], rel=1e-6)
    assert "GAUGE-TORQUE: gauge-aware closed loop" in result.output


def test_limited_structures_have_names_in_other_commands_too(run):
    result = run("structures", "gauge-torque-rate", "GAUGE-QUADRATIC")
    assert result.exit_code == 0, result.stderr
    assert "GAUGE-TORQUE-RATE: gauge-aware closed loop, quadratic propeller, torque, rate" in result.output
    assert "r_x" in result.output
    assert "GAUGE-QUADRATIC: gauge-aware closed loop, quadratic propeller," in result.output


def test_without_limits_the_torque_goes_with_the_square_of_the_speed(run, here):
    result = run(
        "simulate", "--structure", "GAUGE-QUADRATIC", *PLAIN, "--vessel", "stan-tug-1205", "--rpm-per-volt", -200.0,
        "--campaign", "short", "--between", 0.0, 40.0, "-o", "out.csv",
    )  # fmt: skip
    assert result.exit_code == 0, result.stderr
    found = columns(here / "out.csv")
    # the first level is 2 V above the offset, at 200 rpm a volt
    expected = SPEED_RPM - 400.0
    assert found["set point [rpm]"][-10] == pytest.approx(expected)
    assert found["engine speed [rpm]"][-10] == pytest.approx(expected, rel=1e-4)
    assert found["shaft torque [N m]"][-10] == pytest.approx(TORQUE_NM * (expected / SPEED_RPM) ** 2, rel=1e-3)
    assert "-5 V of the campaign is taken as the working point, 1183.8 rpm" in result.output


def test_a_campaign_through_a_fingerprint(run, demo, here):
    arguments = ("--fingerprint", demo[0], "--campaign", "short", "--between", 5.0, 40.0, "--rate", 100)
    result = run("simulate", *arguments, "-o", "out.csv", "--no-progress")
    assert result.exit_code == 0, result.stderr
    found, kept = columns(here / "out.csv"), fingerprint(demo)
    n_0, m_0 = kept["conditions"]["engine_speed"]["value"], kept["conditions"]["shaft_torque"]["value"]
    asked = quantity(kept, "calibration", "set-point slope")["value"] * 2.0
    asked *= quantity(kept, "calibration", "set-point scale")["value"] / n_0
    c_set = quantity(kept, "parameters", "c_set")
    # long after the step the speed is what is asked for, but for the scale error of the set point
    assert found["engine speed [rpm]"][0] == pytest.approx(n_0)
    assert found["engine speed [rpm]"][-10] == pytest.approx(n_0 * (1.0 + c_set["value"] * asked), rel=1e-4)
    assert found["engine speed std [rpm]"][0] == pytest.approx(0.0, abs=1e-9)
    assert found["engine speed std [rpm]"][-10] == pytest.approx(n_0 * abs(asked) * c_set["std"], rel=0.02)
    # and on the way there what the exact simulation of the jump says
    closed = structure("GAUGE-CLOSED")
    values = closed.vector({q["name"]: q["value"] for q in kept["parameters"]} | kept["held"])
    time = found["time [s]"]
    trace = simulate_exactly(closed, values, time, {"n_set": np.where(time >= 10.0, asked, 0.0)}, hold=True)
    step = abs(asked)
    np.testing.assert_allclose(found["engine speed [rpm]"] / n_0 - 1.0, trace.outputs["n"], atol=1e-5 * step)
    np.testing.assert_allclose(found["shaft torque [N m]"] / m_0 - 1.0, trace.outputs["M_s"], atol=2e-4 * step)
    assert "GAUGE-QUADRATIC has the square" in " ".join(result.output.split())


@pytest.mark.long
def test_band_of_a_limited_model_is_that_of_differences(run, demo, here):
    kept = fingerprint(demo)
    given = {"m_max": 2.2, "m_min": -0.3, "T_aw": 0.4, "K_p": 5.0, "t_d": 0.07, "t_sp": 0.05}
    stated = [part for name, value in given.items() for part in ("--set", f"{name}={value}")]
    arguments = ("--fingerprint", demo[0], "--structure", "GAUGE-TORQUE", *stated, "--campaign", "short")
    result = run("simulate", *arguments, "--between", 5.0, 20.0, "-o", "out.csv", "--no-progress")
    assert result.exit_code == 0, result.stderr
    ship, found = limited("torque"), columns(here / "out.csv")
    named = {q["name"]: q["value"] for q in kept["parameters"]} | kept["held"] | given
    names = [q["name"] for q in kept["parameters"]]
    free = [name for name in names if name not in given]
    places = [names.index(name) for name in free]
    covariance = np.array(kept["covariance"])[np.ix_(places, places)]
    n_0 = kept["conditions"]["engine_speed"]["value"]
    fine = 5.0 + 0.001 * np.arange(15001)
    slope = quantity(kept, "calibration", "set-point slope")["value"]
    slope *= quantity(kept, "calibration", "set-point scale")["value"] / n_0
    u = slope * (setpoint(load_campaign("short"), fine + 1e-6) + 5.0)
    u[np.isclose(fine, 10.0)] /= 2.0

    def speed(**changed):
        values = ship.vector(named | changed)
        return simulate(ship, values, fine, {"n_set": u}).outputs["n"][::20]

    rows = np.stack([(speed(**{n: named[n] + 1e-6}) - speed(**{n: named[n] - 1e-6})) / 2e-6 for n in free])
    expected = n_0 * np.sqrt(np.einsum("is,ij,js->s", rows, covariance, rows))
    assert expected.max() > 1.0
    np.testing.assert_allclose(found["engine speed std [rpm]"], expected, atol=2e-3 * expected.max())


def test_what_was_written_can_be_read_again(run, demo, here):
    first = ("--fingerprint", demo[0], "--campaign", "short", "--between", 225.0, 240.0, "--rate", 200, "--no-progress")
    assert run("simulate", *first, "-o", "one.csv").exit_code == 0
    again = run("simulate", "--fingerprint", demo[0], "--input", "one.csv", "-o", "two.csv", "--no-progress")
    assert again.exit_code == 0, again.stderr
    one, two = columns(here / "one.csv"), columns(here / "two.csv")
    assert np.abs(one["engine speed [rpm]"] - two["engine speed [rpm]"]).max() < 0.2


def test_volts_of_a_file_go_through_the_line_of_the_fingerprint(run, demo, here):
    table(here / "u.csv", ("time [s]", "set point [V]"), np.arange(3.0), np.full(3, -4.0))
    result = run("simulate", "--fingerprint", demo[0], "--input", "u.csv", "-o", "out.csv", "--no-progress")
    assert result.exit_code == 0, result.stderr
    kept = fingerprint(demo)
    line = [quantity(kept, "calibration", f"set-point {name}")["value"] for name in ("slope", "intercept")]
    assert columns(here / "out.csv")["set point [rpm]"] == pytest.approx(-4.0 * line[0] + line[1], abs=0.5)


def test_another_working_point_is_said(run, demo, here):
    away = (demo[0] / "campaign.toml").read_text(encoding="utf-8").replace("offset_v = -5.0", "offset_v = -4.0")
    (here / "away.toml").write_text(away)
    result = run(
        "simulate", "--fingerprint", demo[0], "--campaign", "away.toml", "--between", 0, 5, "-o", "out.csv"
    )  # fmt: skip
    assert result.exit_code == 0, result.stderr
    assert "another working point than 1183" in " ".join(result.output.split())


@pytest.mark.parametrize(("name", "start"), [("f.svg", b"<?xml"), ("f.png", b"\x89PNG"), ("f.pdf", b"%PDF")])
def test_picture(run, demo, here, name, start):
    arguments = ("--fingerprint", demo[0], "--campaign", "short", "--between", 5, 20, "-o", "out.csv")
    result = run("simulate", *arguments, "--figure", name)
    assert result.exit_code == 0, result.stderr
    assert (here / name).read_bytes().startswith(start)
    assert {path.name for path in here.iterdir()} == {"own.py", "out.csv", name}
    refused = run("simulate", *arguments, "--figure", name)
    assert refused.exit_code == 1
    assert "out.csv exists already" in refused.stderr
    assert run("simulate", *arguments, "--figure", name, "--force").exit_code == 0


def test_a_parameter_of_which_the_test_said_nothing(run, demo, here):
    kept = fingerprint(demo)
    place = [q["name"] for q in kept["parameters"]].index("g")
    kept["parameters"][place]["std"] = "Infinity"
    for row in range(len(kept["covariance"])):
        kept["covariance"][row][place] = kept["covariance"][place][row] = "NaN"
    (here / "lost.json").write_text(json.dumps(kept))
    result = run("simulate", "--fingerprint", "lost.json", "--campaign", "short", "--between", 5, 20, "-o", "out.csv")
    assert result.exit_code == 0, result.stderr
    assert "The test said nothing of g: the band leaves it out." in result.output
    assert np.isfinite(columns(here / "out.csv")["engine speed std [rpm]"]).all()


SHIP = ("--structure", "GAUGE-CLOSED")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--campaign", "short"), "give --fingerprint, or --structure"),
        (SHIP, "either --campaign or --input"),
        ((*SHIP, "--campaign", "short"), "--campaign is in volt"),
        ((*SHIP, "--campaign", "short", "--vessel", "stan-tug-1205"), "needs --fingerprint, or a campaign"),
        ((*SHIP, "--campaign", "short", "--rpm-per-volt", "-200"), "--rpm-per-volt needs --vessel"),
        ((*SHIP, "--set", "K=2", "--campaign", "short"), "--set K: expected a parameter of GAUGE-CLOSED"),
        ((*SHIP, "--set", "K_p=many", "--campaign", "short"), "expected a parameter and its value"),
        (("--structure", "OL1", "--campaign", "short"), "structure OL1 goes from M_s"),
        ((*SHIP, "--input", "nowhere.csv"), "expected a logger file, found none there"),
        ((*SHIP, "--input", "other.csv"), 'expected a column "n_set" (deviation) or "set point [rpm]"'),
        ((*SHIP, "--input", "rpm.csv"), "a set point in rpm needs a working point"),
        ((*SHIP, "--input", "rpm.csv", "--vessel", "stan-tug-1205", "--between", "1", "9"), "within the file"),
        ((*SHIP, "--input", "rpm.csv", "--between", "2", "1"), "begin and end in this order"),
        ((*SHIP, "--input", "volt.csv", "--vessel", "stan-tug-1205"), "needs --fingerprint, or a campaign"),
        ((*SHIP, "--input", "knots.csv", "--vessel", "stan-tug-1205"), 'expected a set point in "rpm" or "V"'),
        ((*SHIP, "--input", "gap.csv"), "expected numbers, found none at 1 s"),
        (("--structure", "nothing.py:lag", "--input", "gap.csv"), "expected a Python file, found nothing there"),
        (("--structure", "GAUGE-TORQE", "--input", "gap.csv"), "there is no structure 'GAUGE-TORQE'"),
        (("--fingerprint", "none", "--campaign", "short"), "found nothing there; name the file, or the folder"),
    ],
)
def test_wrong_arguments(run, here, arguments, message):
    time = np.arange(3.0)
    table(here / "other.csv", ("time [s]", "u [V]"), time, time)
    table(here / "rpm.csv", ("time [s]", "set point [rpm]"), time, 1183.8 + time)
    table(here / "volt.csv", ("time [s]", "set point [V]"), time, time)
    table(here / "knots.csv", ("time [s]", "set point [kn]"), time, time)
    table(here / "gap.csv", ("time [s]", "n_set [-]"), time, [0.0, np.nan, 0.0])
    result = run("simulate", *arguments, "-o", "out.csv", "--no-progress")
    assert result.exit_code in (1, 2)
    assert message in " ".join(result.stderr.split())
    assert not (here / "out.csv").exists()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--campaign", "short", "--vessel", "stan-tug-1205"), "for a simulation without --fingerprint"),
        (("--campaign", "short", "--structure", "CL4"), "expected the parameters of structure CL4, found"),
        (("--campaign", "short", "--structure", "GAUGE-RATE"), "usual ones are --set r_x=10"),
        (("--campaign", "short", "--between", "800", "900"), "ends at 860 s, not 900 s"),
        (("--campaign", "short", "--between", "1", "1.001"), "a stretch of two samples or more"),
        (("--campaign", "short", "-o", "."), "found a folder; add a file name"),
        (("--campaign", "short", "-o", "new/out.csv"), "expected an existing folder"),
        (("--campaign", "short", "--figure", "out.bmp"), "ends in .svg, .png, .pdf"),
    ],
)
def test_wrong_arguments_beside_a_fingerprint(run, demo, here, arguments, message):
    output = () if "-o" in arguments else ("-o", "out.csv")
    result = run("simulate", "--fingerprint", demo[0], *arguments, *output, "--no-progress")
    assert result.exit_code in (1, 2)
    assert message in " ".join(result.stderr.split())
    assert {path.name for path in here.iterdir()} == {"own.py"}


@pytest.mark.slow
def test_several_inputs(run, here):
    own = OWN.replace('input="u", outputs={"y": Gain', 'inputs=("u", "w"), outputs={"y": {"u": Gain')
    own = own.replace("FirstOrderLag(T)})", 'FirstOrderLag(T), "w": Gain(K)}})')
    (here / "own.py").write_text(own)
    table(here / "u.csv", ("time [s]", "u [V]"), np.arange(3.0), np.arange(3.0))
    result = run("simulate", "--structure", "own.py:lag", "--input", "u.csv", "-o", "out.csv")
    assert result.exit_code == 1
    assert 'expected a column "w", found u' in result.stderr
    table(here / "u.csv", ("time [s]", "u [V]", "w [V]"), np.arange(9.0), np.ones(9), np.full(9, 2.0))
    result = run("simulate", "--structure", "own.py:lag", "--input", "u.csv", "-o", "out.csv")
    assert result.exit_code == 0, result.stderr
    # one of u and two of w
    np.testing.assert_allclose(columns(here / "out.csv")["y []"], 3.0)
