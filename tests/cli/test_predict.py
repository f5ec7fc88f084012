"""``shaftprint predict``: what a test would find."""

import re

import pytest

from shaftprint.campaign import load_campaign

GIVEN = ("--campaign", "thesis", "--no-progress")
# The simulated tug.
GOVERNOR = {"K_p": 5.7, "K_i": 4.27, "t_d": 0.0703, "omega_n": 10.3, "zeta": 0.47, "t_sp": 0.0518}


def table(result):
    """The cells of the table by the name of the quantity."""
    lines = result.output[
        result.output.index("Predicted accuracy with these lines") : result.output.index("What these outputs")
    ]
    rows = [re.split(r"\s{2,}", line.strip()) for line in lines.splitlines() if "+/-" in line or "(not known)" in line]
    return {row[0]: row for row in rows}


@pytest.mark.slow
def test_the_thesis_campaign_on_the_stan_tug(run):
    result = run("predict", *GIVEN, "--vessel", "stan-tug-1205")
    assert result.exit_code == 0
    assert result.output.startswith("What the test will find\n")
    assert "\nBackward bollard push, November 2019; GAUGE-CLOSED: gauge-aware closed loop\n" in result.output
    assert "noise of the Stan Tug 1205 assumed for Stan Tug 1205, port" in result.output
    assert "lines used: S1, S2, S3, S4, S5, S6, S7, S8, S9, S10, S11, S12, S13, S14\n" in result.output
    assert "S16 not used: above 7.19 Hz, beyond which nothing is known of the noise" in result.output
    assert "priors: g = 0.00 +/- 0.10, tau_up = 1.016 +/- " in result.output
    assert "From n and M_s a test finds 11 numbers for the 12 free parameters of GAUGE-CLOSED" in result.output
    rows = table(result)
    assert rows["tau_dn"][4] == "s"
    assert float(rows["tau_dn"][2]) < 0.2
    # 17 kg m2 of the vessel file
    assert rows["tau_dn"][3].startswith("0.319")
    assert float(rows["t_d"][2]) > 10.0
    assert "t_d + t_sp is known to 0." in result.output
    assert "tau_up stays at its prior" in result.output


def test_with_g_alone_the_delay_in_the_loop_is_not_known(run):
    """At the values of the simulated tug, which is nearer to hunting than the default values."""
    truth = {"K_p": 5.7, "K_i": 4.27, "t_d": 0.07, "omega_n": 10.3, "zeta": 0.47, "tau_dn": 0.32, "tau_up": 1.016}
    given = (*GIVEN, *(f"--value={name}={value}" for name, value in truth.items()), "--prior", "g=0+-0.1")
    alone = run("predict", *given)
    rows, with_tvc = table(alone), table(run("predict", *given, "--prior", "tau_up=1.016+-0.02"))
    assert "g stays at its prior, 0.00 +/- 0.10" in alone.output
    assert rows["t_d"][3].startswith("0.000* to ")
    assert float(rows["t_d"][2]) > 2.0 * float(with_tvc["t_d"][2])
    assert float(rows["K_p / K_i"][2]) == pytest.approx(float(with_tvc["K_p / K_i"][2]), rel=0.1)


@pytest.mark.slow
def test_without_anything_known_the_gains_are_not(run):
    result = run("predict", *GIVEN, "--vessel", "stan-tug-1205", "--free", "g", "--free", "tau_up")
    assert "priors: t_gauge = 0.0 +/- 2.0 ms" in result.output
    assert table(result)["K_p"][1].endswith("(not known)")
    assert "Not known: K_p, K_i, tau_up" in result.output


def test_hold_and_value(run):
    result = run("predict", *GIVEN, "--structure", "cl4", "--hold", "t_d=0.2", "--value", "tau_n=0.5")
    rows = table(result)
    assert "held: k_q = 2, t_d = 0.2" in result.output.replace("t_d = 0.2, k_q = 2", "k_q = 2, t_d = 0.2")
    assert "t_d" not in rows
    assert rows["tau_n"][1].startswith("0.5")


def test_open_loop_structures(run):
    governor = run("predict", *GIVEN, "--structure", "OL5")
    core = run("predict", *GIVEN, "--structure", "OL1")
    assert (governor.exit_code, core.exit_code) == (0, 0)
    assert "From M_s a test finds all 5 free parameters of OL5" in governor.output
    assert "From n a test finds the free parameter of OL1: tau_n." in core.output


@pytest.mark.slow
def test_half_the_volts_twice_the_uncertainty(run):
    options = ("predict", *GIVEN, "--vessel", "stan-tug-1205", "--structure", "CL4", "--rpm-per-volt")
    whole, half = (table(run(*options, rpm)) for rpm in ("250", "125"))
    assert float(half["tau_n"][2]) == pytest.approx(2.0 * float(whole["tau_n"][2]), rel=0.05)


@pytest.mark.slow
def test_the_sign_of_the_slope_is_that_of_simulate(run):
    """Of every shipped ship less voltage asks for more speed; for what a test finds it is all the same."""
    options = ("predict", *GIVEN, "--vessel", "stan-tug-1205", "--structure", "CL4", "--rpm-per-volt")
    falling, rising = (run(*options, rpm) for rpm in ("-250.9", "250.9"))
    assert falling.exit_code == 0, falling.stderr
    # the limits know which way is up
    told, limits = zip(*(one.output.split("The test would leave", 1) for one in (falling, rising)), strict=True)
    assert told[0] == told[1]
    assert limits[0] != limits[1]


def test_where_the_test_would_leave_the_limits(run):
    """The steps of the short campaign meet the limits of the engine, its sines do not; the simulated tug shows both."""
    governor = [f"--value={name}={value}" for name, value in GOVERNOR.items()]
    result = run("predict", "--campaign", "short", "--no-progress", "--vessel", "stan-tug-1205", *governor)
    told = result.output.split("The test would leave limits of ship and engine", 1)[1]
    assert "St1 leaves the limit zero fuel at 10.2 s" in told
    assert not re.search(r"\* S\d+ leaves", told)
    designed = run("predict", "--campaign", "12min", "--vessel", "stan-tug-1205", *governor)
    assert "leaves the limit" not in designed.output
    assert re.search(r"lowest speed +6\d\d +600 +rpm +M2", designed.output)


@pytest.mark.slow
def test_noise_of_a_recording(run, recording):
    """The recording was made with the short campaign, so a prediction for the same campaign is what it gives."""
    given = ("--campaign", "short", "--vessel", "stan-tug-1205", "--no-progress")
    result = run("predict", *given, "--from", recording)
    assert result.exit_code == 0
    assert f"noise of {recording.name}\n" in result.output
    rows = table(result)
    assert float(rows["tau_dn"][2]) < 2.0
    longer = table(run("predict", "--campaign", "thesis", *given[2:], "--from", recording, "--from-campaign", "short"))
    assert float(longer["tau_dn"][2]) < float(rows["tau_dn"][2])
    assert len(load_campaign("short").sines) < len(load_campaign("thesis").sines)


def test_structure_of_ones_own(run, tmp_path):
    path = tmp_path / "my_ship.py"
    path.write_text(
        "from dataclasses import replace\n"
        "from shaftprint.catalogue import structure\n"
        "my_loop = replace(structure('CL1'), name='MINE')\n"
    )
    result = run("predict", *GIVEN, "--structure", f"{path}:my_loop")
    assert result.exit_code == 0
    assert "From n and M_s a test finds all 3 free parameters of MINE" in result.output


@pytest.mark.parametrize(
    ("options", "code", "message"),
    [
        (("--structure", "CL9"), 1, "there is no structure 'CL9'"),
        (("--hold", "mass=1"), 1, "structure GAUGE-CLOSED has no parameter mass"),
        (("--free", "mass"), 1, "--free mass: expected a free parameter, one of K_p"),
        (("--value", "mass=1"), 1, "mass"),
        (("--prior", "mass=1+-1"), 1, "prior of mass: structure GAUGE-CLOSED has the free parameters K_p"),
        (
            ("--structure", "GAUGE-ECU"),
            1,
            "found that of n, M_s alone. Give a recording of the other channels with --from",
        ),
        (("--from", "log.nc"), 2, "--from needs --vessel"),
        (("--rpm-per-volt", "250"), 2, "--rpm-per-volt needs --vessel"),
        (("--rpm-per-volt", "0"), 2, "expected a number other than 0, such as -250, found 0"),
        (("--rpm-per-volt", "nan"), 2, "expected a number other than 0, such as -250, found nan"),
        (("--campaign", "trip.toml"), 1, "trip.toml: expected a settings file, found nothing there"),
    ],
)
def test_wrong_input(run, options, code, message):
    result = run("predict", *GIVEN, *options)
    assert result.exit_code == code
    assert message in result.stderr
    assert "Traceback" not in result.output
