"""An exported FMU in programs that others wrote: step and sine of shaftprint's own simulation, with parameters set."""

import shutil
from dataclasses import replace

import numpy as np
import pytest
from benchmarks.host_runs import is_installed, run_host
from benchmarks.hosts import exported_line, largest_differences, stimulus_of

pytestmark = pytest.mark.slow
LINES = {2: ("fmpy", "fmuloader", "libcosimpy"), 3: ("fmpy", "fmuloader")}


@pytest.fixture(scope="module")
def line(tmp_path_factory):
    """A closed loop and its FMU for both versions, each once."""
    if shutil.which("cc") is None:
        pytest.skip("there is no C compiler called cc")
    known = {}

    def of(version):
        if version not in known:
            known[version] = exported_line(tmp_path_factory.mktemp("hosts"), version)
        return known[version]

    return of


@pytest.mark.parametrize("kind", ["step", "sine"])
@pytest.mark.parametrize(("version", "host"), [(version, host) for version, hosts in LINES.items() for host in hosts])
def test_step_and_sine_are_those_of_the_simulation(line, tmp_path, version, host, kind):
    """In rpm and N m, with two parameters and a value of the working point set in the host."""
    if not is_installed(host):
        pytest.skip(f"{host} is not installed")
    model, path = line(version)
    stimulus = stimulus_of(kind, last_s=3.0)
    rows = run_host(host, path, stimulus, tmp_path)
    assert max(largest_differences(model, stimulus, rows)) < 1e-6


def test_groups_are_connected_by_name(line, tmp_path):
    """The speed of one line is the set point of another, found through the description of the groups."""
    if not is_installed("libcosimpy"):
        pytest.skip("libcosimpy is not installed")
    model, path = line(2)
    stimulus = stimulus_of("step", last_s=3.0)
    rows = np.array(run_host("libcosimpy", path, stimulus, tmp_path))
    set_point = rows[1:, 2]
    assert np.ptp(set_point) > 5.0
    # what arrives is the speed at the end of the step before
    np.testing.assert_allclose(set_point[1:], rows[1:-1, 0], rtol=1e-12)
    moved = np.column_stack([rows[:, 3], rows[:, 4]])
    # held over the step that has just ended: the first is that of the start
    follower = replace(stimulus, set_point=[*set_point, set_point[-1]], parameters={})
    assert max(largest_differences(model, follower, moved)) < 1e-6
