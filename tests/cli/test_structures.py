"""``shaftprint structures`` lists what can be fitted."""

from shaftprint.catalogue import STRUCTURES


def test_every_structure_is_listed(run):
    result = run("structures")
    assert result.exit_code == 0
    for name in STRUCTURES:
        assert f"{name}: " in result.output


def test_one_structure_with_bounds_of_table_5_1(run):
    result = run("structures", "cl4")
    assert result.exit_code == 0
    rows = {
        line.split()[0]: line.split() for line in result.output.splitlines() if line.startswith(" ") and line.strip()
    }
    assert result.output.startswith("CL4: closed loop, PI governor, delay, second-order lag, n_set -> n, M_s\n")
    assert rows["tau_n"][1:4] == ["s", "0", "5"]
    assert rows["omega_n"][1:4] == ["rad/s", "7", "13"]
    assert rows["t_d"][1:4] == ["s", "0", "0.5"]
    assert rows["zeta"][1:4] == ["-", "0.3", "4"]
    assert rows["k_q"][4:6] == ["2,", "held"]


def test_combinations_are_named(run):
    assert "t_d + t_sp [s]: total delay" in run("structures", "GAUGE-CLOSED").output


def test_unknown_structure(run):
    result = run("structures", "CL9")
    assert result.exit_code == 1
    assert "there is no structure 'CL9'; the shipped ones are OL1" in result.stderr
