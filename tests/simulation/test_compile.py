"""Kernels on disk: made once, by whoever comes first, wherever there is room."""

import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from shaftprint.models import Delay, FirstOrderLag, Parameter, Structure
from shaftprint.simulation import simulate

TIME = np.arange(0.0, 2.0, 0.01)
SCRIPT = """
import numpy as np
from shaftprint.models import FirstOrderLag, Parameter, Structure
from shaftprint.simulation import simulate
lag = FirstOrderLag(Parameter("T", "s", 0.1, 1.0, 0.4, "lag"))
model = Structure(name="lag", title="lag", input="u", outputs={"y": lag})
time = np.arange(0.0, 1.0, 0.01)
print(simulate(model, [0.4], time, {"u": time}).outputs["y"][-1])
"""


def a_lag(name):
    """Return a structure whose equations no other test has."""
    expression = FirstOrderLag(Parameter("T", "s", 0.1, 5.0, 0.8, "lag")) * Delay(
        Parameter("d", "s", 0, 1, 0.1, "late")
    )
    return Structure(name=name, title="lag", input="u", outputs={"y": expression * float(1 + len(name))})


@pytest.mark.slow
def test_two_processes_may_begin_at_once_in_an_empty_folder(tmp_path):
    environment = {**os.environ, "SHAFTPRINT_CACHE": str(tmp_path / "new")}
    both = [
        subprocess.Popen([sys.executable, "-c", SCRIPT], env=environment, stdout=subprocess.PIPE, text=True)
        for _ in range(2)
    ]
    answers = [process.communicate()[0] for process in both]
    # a ramp behind a lag: t - T (1 - exp(-t / T)) at 0.99 s
    for process, answer in zip(both, answers, strict=True):
        assert process.returncode == 0
        assert float(answer) == pytest.approx(0.99 - 0.4 * (1.0 - np.exp(-0.99 / 0.4)), abs=1e-8)
    assert not list((tmp_path / "new").rglob("*.part"))
    assert list((tmp_path / "new").rglob("*.nbi"))


def test_threads_may_begin_at_once():
    model = a_lag("threads")
    with ThreadPoolExecutor(4) as pool:
        traces = list(pool.map(lambda _: simulate(model, [0.8, 0.1], TIME, {"u": TIME}, wanted=("T",)), range(4)))
    for trace in traces[1:]:
        np.testing.assert_array_equal(trace.outputs["y"], traces[0].outputs["y"])
        np.testing.assert_array_equal(trace.derivatives["y"], traces[0].derivatives["y"])


@pytest.mark.slow
def test_what_all_structures_share_is_compiled_once(tmp_path):
    another = SCRIPT.replace('outputs={"y": lag}', 'outputs={"y": lag * lag}')
    for script in (SCRIPT, another):
        environment = {**os.environ, "SHAFTPRINT_CACHE": str(tmp_path)}
        subprocess.run([sys.executable, "-c", script], env=environment, check=True)
    compiled = [path.name for path in tmp_path.rglob("*.nbc")]
    assert len([name for name in compiled if ".advance-" in name]) == 2
    assert len([name for name in compiled if ".begin-" in name]) == 1
