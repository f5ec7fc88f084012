#!/usr/bin/env bash
# About: harold 1.0.3 (discretize), python-control 0.10.2 (sample_system) and SciPy 1.17.1 (cont2discrete), each as it is called without a method
# Guess: a lag of 1 s at 2 Hz becomes the lag that a computer sees which holds its output: 0.3935 / (z - 0.6065).
# What happens: control and SciPy do so; harold takes the trapezoidal rule: 0.2 (z + 1) / (z - 0.6). It answers within the sample in which
#   the input moves, half a sample earlier, and nothing says which of them was taken.
. "$(dirname "$0")/_setup.sh"
packages harold==1.0.3 control==0.10.2 scipy==1.17.1
run <<'PY'
import control
import harold
import numpy as np
from find import seen
from scipy import signal

step = np.ones(4)
by_harold = np.ravel(harold.discretize(harold.Transfer([1], [1, 1]), 0.5).polynomials[0]), np.ravel(
    harold.discretize(harold.Transfer([1], [1, 1]), 0.5).polynomials[1]
)
by_scipy = signal.cont2discrete(([1], [1, 1]), 0.5)[:2]
sampled = control.sample_system(control.tf([1], [1, 1]), 0.5)
answers = {
    "harold": signal.lfilter(*by_harold, step),
    "SciPy": signal.lfilter(np.ravel(by_scipy[0]), by_scipy[1], step),
    "control": control.forced_response(sampled, inputs=step).outputs,
}
for name, answer in answers.items():
    print(f"{name:8} {np.round(answer, 4)}")
held = 1.0 - np.exp(-0.5 * np.arange(4))
seen("control and SciPy hold", all(np.allclose(answers[name], held, atol=1e-9) for name in ("SciPy", "control")))
seen("harold answers at once", abs(answers["harold"][0] - 0.2) < 1e-9)
PY
